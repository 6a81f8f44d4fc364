"""Solve one file with some constraint groups of the CP-SAT model: ``ablation.py FILE VARIANT S``.

Prints the seconds that the proof took, or the gap that was left. Neither a first division nor a
hint helps the search, so that only the groups make the difference.
"""

from __future__ import annotations

import sys
from pathlib import Path

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.bounds.domination import drop_dominated
from cellcolor.solvers.cpsat.model.constraints import DEFINING, REDUNDANT, Group
from cellcolor.solvers.cpsat.model.dart_graph import dart_graph, seams_of
from cellcolor.solvers.cpsat.model.full import full_model


def variants() -> dict[str, tuple[Group, ...]]:
    """The redundant groups of each variant."""
    found: dict[str, tuple[Group, ...]] = {"all": REDUNDANT}
    for gone in REDUNDANT:
        found[f"without {gone.__name__}"] = tuple(g for g in REDUNDANT if g is not gone)
    found["none"] = ()
    return found


def main(file: Path, variant: str, seconds: float) -> str:
    """What the table shows."""
    if file.name.endswith(".surface.json"):
        instance = decompose(LabelledSurface.read(file))
    else:
        instance = Instance.read(file)
    colors = drop_dominated(instance)
    strands = {edge.id: 1 for edge in instance.edges}
    graph = dart_graph(instance, colors, strands, seams_of(instance, colors, strands, None))
    groups = DEFINING + variants()[variant]
    built = full_model(graph, color_regions(instance, colors), groups)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 8
    solver.parameters.max_time_in_seconds = seconds
    status = solver.solve(built.model)
    if status == cp_model.OPTIMAL:
        return f"{solver.wall_time:.2f}"
    best = f"{solver.objective_value:.0f}" if status == cp_model.FEASIBLE else "?"
    return f"{solver.best_objective_bound:.0f} to {best}"


if __name__ == "__main__":
    print(main(Path(sys.argv[1]), sys.argv[2], float(sys.argv[3])))
