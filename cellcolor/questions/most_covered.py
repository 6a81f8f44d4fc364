"""The most that so many color regions cover: a maximum-coverage problem, solved with CP-SAT.

Every segment lies in one color region, so k segments cover at most what the best k color regions
cover together. That holds for any division of the surface.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.interruptible import make_cp_solver, solve_interruptibly


@dataclass(frozen=True, slots=True)
class MostCovered:
    """What the best color regions cover.

    Attributes:
        cells: what they cover, all of it.
        weight: of these cells.
        at_most: no choice of so many regions covers more.
    """

    cells: frozenset[int]
    weight: int
    at_most: int


def most_covered(
    regions: Sequence[Region],
    weights: Sequence[int],
    segments: int,
    required: Collection[int],
    deadline: Deadline,
) -> MostCovered | None:
    """The cells that a few color regions cover, of the greatest weight.

    Args:
        regions: the color regions.
        weights: of each cell, 0 or more.
        segments: how many regions may be chosen.
        required: cells that one of them has to cover.
        deadline: when to be content with the best found.

    Returns:
        None if so few regions do not cover what is required.

    Raises:
        OutOfTime: the deadline came before any choice was known.
    """
    model = cp_model.CpModel()
    chosen = [model.new_bool_var("") for _ in regions]
    covering: list[list[cp_model.IntVar]] = [[] for _ in weights]
    for literal, (_, cells) in zip(chosen, regions, strict=True):
        for cell in cells:
            covering[cell].append(literal)
    model.add(sum(chosen) <= segments)
    gains = []
    for cell, literals in enumerate(covering):
        if cell in required:
            model.add_bool_or(literals)
        covered = model.new_bool_var("")
        model.add_bool_or([~covered, *literals])
        gains.append(weights[cell] * covered)
    model.maximize(sum(gains))
    solver = make_cp_solver(deadline, 1, 0)
    # As with covers, the linear relaxation is what bounds it.
    solver.parameters.linearization_level = 2
    status, interrupt = solve_interruptibly(solver, model)
    if interrupt is not None:
        raise interrupt
    if status == cp_model.INFEASIBLE:
        return None
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        raise OutOfTime
    found = frozenset[int]().union(
        *(
            cells
            for literal, (_, cells) in zip(chosen, regions, strict=True)
            if solver.value(literal)
        )
    )
    weight = sum(weights[cell] for cell in found)
    return MostCovered(found, weight, max(weight, int(solver.best_objective_bound + 0.5)))
