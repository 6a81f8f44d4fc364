"""The complete model in which cells may be left out, for a given number of segments.

A cell that a segment enters can be covered whole without another segment: uncovered pieces of it
go, one by one, to a segment beside them in the same cell. So only whole cells are left out. In the
model such a cell has a color of its own, which is joinable nowhere, and its root is not counted.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import ceil

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.errors import TooLarge
from cellcolor.solvers.cpsat.complete_model import CompleteModel
from cellcolor.solvers.cpsat.runner import Runner
from cellcolor.solvers.interface import Options


def least_left_out(
    instance: Instance,
    weights: Sequence[int],
    segments: int,
    options: Options,
) -> tuple[frozenset[int], int] | None:
    """The cells left out when a number of segments covers the most, in the search space ``paper``.

    Args:
        weights: of each cell, 0 or more.
        segments: the most that there may be.
        options: deadline, workers and seed.

    Returns:
        The cells left out of the best division found, and the weight that no division covers more
        of. None if nothing was found in time, or the model is too large.

    Raises:
        OutOfTime: the deadline came while the model was built.
    """
    nothing = len(instance.colors)
    try:
        built = CompleteModel(_with_color(instance), deadline=options.deadline)
    except TooLarge:
        return None
    model, roots = built.model, built.variables.root
    left_out = {
        built.sectors.cell[sector]: literal
        for (sector, color), literal in roots.items()
        if color == nothing
    }
    model.add(built.segments - sum(left_out.values()) <= segments)
    model.minimize(sum(weights[cell] * literal for cell, literal in left_out.items()))
    runner = Runner(options)
    solver = runner.portfolio(options.deadline)
    status = runner.solve(solver, model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    found = [cell for cell, literal in left_out.items() if solver.boolean_value(literal)]
    return frozenset(found), sum(weights) - ceil(solver.best_objective_bound - 1e-6)


def _with_color(instance: Instance) -> Instance:
    """The instance with one more color, which all cells have, and no edge joins."""
    nothing = len(instance.colors)
    return replace(
        instance,
        colors=(*instance.colors, "-".join(("nothing", *instance.colors))),  # no other name
        cells=tuple(replace(cell, colors=(*cell.colors, nothing)) for cell in instance.cells),
        edges=tuple(replace(e, colors=instance.joinable(e.id)) for e in instance.edges),
    )
