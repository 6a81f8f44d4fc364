"""The complete model in which cells may be left out, for a given number of segments.

A cell that a segment enters can be covered whole without another segment: uncovered pieces of it
go, one by one, to a segment beside them in the same cell. So only whole cells are left out. In the
model such a cell is a segment of its own that is not counted.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
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
        of. None if nothing was found in time, or the model is too large.

    Raises:
        OutOfTime: the deadline came while the model was built.
    """
    try:
        built = CompleteModel(instance, deadline=options.deadline)
    except TooLarge:
        return None
    model, v, sectors = built.model, built.variables, built.sectors
    left_out = [model.new_bool_var(f"left out[{cell.id}]") for cell in instance.cells]
    for (here, there), literal in v.parent.items():
        own, other = sectors.cell[here], sectors.cell[there]
        if own != other:
            model.add_implication(literal, ~left_out[own])
            model.add_implication(literal, ~left_out[other])
    for cell, literal in enumerate(left_out):
        # Its root is its center, as nothing outside is a parent.
        roots = [v.root[sectors.center(cell), c] for c in instance.cells[cell].colors]
        model.add_bool_or([~literal, *roots])
        if cell in required:
            model.add(literal == 0)
    model.add(built.segments - sum(left_out) <= segments)
    model.minimize(sum(w * literal for w, literal in zip(weights, left_out, strict=True)))
    runner = Runner(options)
    solver = runner.portfolio(options.deadline)
    status = runner.solve(solver, model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    found = [cell for cell, literal in enumerate(left_out) if solver.boolean_value(literal)]
    return frozenset(found), sum(weights) - ceil(solver.best_objective_bound - 1e-6)
