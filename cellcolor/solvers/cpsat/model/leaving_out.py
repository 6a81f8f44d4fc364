"""The CP-SAT model in which cells may be left out, for a given number of segments.

A cell that a segment enters can be covered whole without another segment: uncovered pieces of it
go, one by one, to a segment beside them in the same cell. So only whole cells are left out,
and a cell that is left out has no joined dart and counts for no segment.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from math import ceil

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.dart_graph import dart_graph
from cellcolor.solvers.cpsat.model.full import (
    LARGEST_MODEL,
    SECONDS_A_TERM,
    full_model,
    model_size,
)
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.interface import Options


def least_left_out(
    instance: Instance,
    weights: Sequence[int],
    segments: int,
    required: Collection[int],
    options: Options,
) -> tuple[frozenset[int], int] | None:
    """The cells left out when a number of segments covers the most, in the search space ``paper``.

    Args:
        weights: of each cell, 0 or more.
        segments: the most that there may be.
        required: cells that must not be left out.
        options: deadline, workers and seed.

    Returns:
        The cells left out of the best division found, and the weight that no division covers more
        of. None if nothing was found in time, the model is too large, or a cell has several live
        loops, which this model does not divide.

    Raises:
        OutOfTime: the deadline came while the model was built.
    """
    if instance.most_live_loops > 1:
        return None
    colors = [frozenset(cell.colors) for cell in instance.cells]
    graph = dart_graph(instance, colors, dict.fromkeys(instance.live_edges, 1), ())
    size = model_size(graph)
    if size > min(LARGEST_MODEL, options.deadline.left / SECONDS_A_TERM):
        return None
    built = full_model(graph, color_regions(instance), deadline=options.deadline)
    model, v = built.model, built.variables
    left_out = [model.new_bool_var("") for _ in instance.cells]
    for cell, literal in enumerate(left_out):
        model.add_implication(literal, v.alone[cell])
        if cell in required:
            model.add(literal == 0)
    model.add(sum(v.root) + sum(v.alone) - sum(left_out) <= segments)
    model.minimize(sum(w * literal for w, literal in zip(weights, left_out, strict=True)))
    runner = Runner(options)
    solver = runner.portfolio()
    status = runner.solve(solver, model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    found = [cell for cell, literal in enumerate(left_out) if solver.boolean_value(literal)]
    return frozenset(found), sum(weights) - ceil(solver.best_objective_bound - 1e-6)
