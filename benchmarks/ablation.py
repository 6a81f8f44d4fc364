"""The CP-SAT model less one redundant constraint group at a time: ``benchmarks/ablation.py``.

Prints the seconds that each proof took, or the gap that was left. Neither a first division nor a
hint helps the search, so that only the groups make the difference. Each solve is a process of its
own.
"""

from __future__ import annotations

import sys
from pathlib import Path

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families import hub_grid
from cellcolor.processes import Limits, run_alone
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.bounds.reductions import drop_dominated, left_out
from cellcolor.solvers.cpsat.dart_graph import dart_graph, seams_of
from cellcolor.solvers.cpsat.model.constraints import DEFINING, REDUNDANT, Group
from cellcolor.solvers.cpsat.model.full import full_model

SHIPPED = Path(__file__).resolve().parents[1] / "instances"
SUBJECTS = (
    Instance.read(SHIPPED / "random" / "hub_24.json"),
    LabelledSurface.read(SHIPPED / "random" / "blobs_0.surface.json"),
    LabelledSurface.read(SHIPPED / "random" / "blobs_2.surface.json"),
    LabelledSurface.read(SHIPPED / "scenes" / "feasibility" / "wok_obstacle_2000.surface.json"),
    hub_grid(0, 2, 2, 4, 3),
)


def variants() -> dict[str, tuple[Group, ...]]:
    """The redundant groups of each variant."""
    found: dict[str, tuple[Group, ...]] = {"all": REDUNDANT}
    for gone in REDUNDANT:
        found[f"without {gone.__name__}"] = tuple(g for g in REDUNDANT if g is not gone)
    found["none"] = ()
    return found


def proof(instance: Instance, variant: str, seconds: float) -> str:
    """What the table shows."""
    colors = drop_dominated(instance, left_out(instance))
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


def main(seconds: float) -> None:
    """Print the table."""
    names = list(variants())
    print(f"| instance | {' | '.join(names)} |\n|{'---|' * (len(names) + 1)}")
    for subject in SUBJECTS:
        instance = decompose(subject) if isinstance(subject, LabelledSurface) else subject
        cells = []
        for name in names:
            ended = run_alone(proof, (instance, name, seconds), Limits(seconds + 60))
            cells.append(ended.value or ended.error)
        print(f"| {instance.name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    from ablation import proof  # by the name that other processes can import

    main(float(sys.argv[1]) if sys.argv[1:] else 10.0)
