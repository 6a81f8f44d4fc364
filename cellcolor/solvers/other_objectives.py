"""Other objectives of the complete model (docs/formulation.md).

They are the division that costs least among those with as few segments, and the most that a number
of segments covers.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import ceil

import numpy as np
from ortools.sat.python import cp_model

from cellcolor.arrays import Array
from cellcolor.data.cells_and_edges import strand_of
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Solution, count_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import TooLarge
from cellcolor.solvers.checked import passed
from cellcolor.solvers.cpsat.complete_model import CompleteModel
from cellcolor.solvers.cpsat.painting import joined
from cellcolor.solvers.interface import Options, Start
from cellcolor.solvers.interruptible import Runner

_GRAIN = 1e-6  # the model counts costs in whole multiples of it
_TIME = "the time ended first"


def cost_of(division: Division, costs: Array) -> float:
    """What a division costs: each cell as much as in the costliest of its colors.

    Args:
        costs: (cells, colors) of each cell painted in each color.
    """
    return sum(max(float(costs[cell.id, sub.color]) for sub in cell.subcells) for cell in division)


def preferred(
    instance: Instance, solution: Solution, costs: Array, options: Options
) -> tuple[Solution, str | None]:
    """The solution with the division that costs least, of those with as many segments.

    First each segment gets the best color that all of it has; then the complete model looks for
    better divisions, and proves that there is none.

    Args:
        solution: of the instance.
        costs: (cells, colors) of each cell painted in each color, not negative; in colors that a
            cell does not have they do not matter.
        options: deadline, workers and seed.

    Returns:
        The solution, with as many segments and the same bounds, after the checker has seen it; and
        why it is not proved that no division of the search space with as many segments costs less
        (up to a millionth a cell), None if it is.

    Raises:
        RefusedResult: the checker refuses what was found.
    """
    if solution.cells is None:
        return solution, _TIME
    found = _recolored(instance, solution, solution.cells, costs)
    least = sum(min(costs[cell.id, list(cell.colors)], default=0.0) for cell in instance.cells)
    if cost_of(found.cells or (), costs) <= least + _GRAIN:
        return found, None
    if solution.status != "optimal":
        return found, "nor is the number of segments proved to be the fewest"
    try:
        return _by_model(instance, found, costs, options)
    except OutOfTime:
        return found, _TIME
    except TooLarge:
        return found, "the model would be too large"


def _recolored(
    instance: Instance, solution: Solution, division: Division, costs: Array
) -> Solution:
    """Each segment in the best color that all of it has, if that costs less."""
    seams = {seam.id for seam in solution.seams}
    colors: dict[int, set[int]] = {}
    paid: dict[int, Array] = defaultdict(lambda: np.zeros(len(instance.colors)))
    for cell in division:
        for sub in cell.subcells:
            own = colors.setdefault(sub.segment, set(instance.cells[cell.id].colors))
            own.intersection_update(instance.cells[cell.id].colors)
            for edge in {abs(strand_of(dart)[0]) for dart in sub.darts} - seams:
                own.intersection_update(instance.joinable(edge))
            paid[sub.segment] += costs[cell.id]
    best = {
        segment: min(own, key=lambda c: (paid[segment][c], c)) for segment, own in colors.items()
    }
    painted = tuple(
        replace(cell, subcells=tuple(replace(s, color=best[s.segment]) for s in cell.subcells))
        for cell in division
    )
    painted = joined(instance, painted, solution.seams, solution.strands)
    # If the number is not proved, two segments may have become one: that is another solution.
    fewer = count_segments(painted) != solution.segments
    if fewer or cost_of(painted, costs) >= cost_of(division, costs):
        return solution
    return passed(instance, replace(solution, cells=painted))


def _by_model(
    instance: Instance, solution: Solution, costs: Array, options: Options
) -> tuple[Solution, str | None]:
    """The best division that the complete model has, or the given one if it is as good."""
    assert solution.cells is not None and solution.segments is not None
    built = CompleteModel(instance, solution.strands, deadline=options.deadline)
    built.begin_with(Start(solution.cells, solution.seams))
    built.model.add(built.segments <= solution.segments)
    built.model.minimize(_cost(built, costs))
    runner = Runner(options)
    solver = runner.portfolio()
    status = runner.solve(solver, built.model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return solution, _TIME
    division, seams = built.read(solver)
    if cost_of(division, costs) < cost_of(solution.cells, costs):
        solution = passed(instance, replace(solution, cells=division, seams=seams))
    return solution, None if status == cp_model.OPTIMAL else _TIME


def _cost(built: CompleteModel, costs: Array) -> cp_model.LinearExprT:
    """What a division costs, but for what each cell costs at least, in grains.

    A cell pays for the step to each color that is not its cheapest if a sector has that color or a
    costlier one.
    """
    model, color = built.model, built.variables.color
    grains = np.rint(costs / _GRAIN).astype(np.int64)
    terms = []
    for cell, sectors in enumerate(built.sectors.nodes):
        own = sorted(built.colors(sectors[0]), key=lambda c: (grains[cell, c], c))
        costlier = built.false
        for cheaper, one in reversed(list(pairwise(own))):
            reached = model.new_bool_var(f"reached[{cell}][{one}]")
            model.add_implication(costlier, reached)
            for sector in sectors:
                model.add_implication(color[sector, one], reached)
            terms.append(int(grains[cell, one] - grains[cell, cheaper]) * reached)
            costlier = reached
    return sum(terms)


def least_left_out(
    instance: Instance, weights: Sequence[int], segments: int, options: Options
) -> tuple[frozenset[int], int] | None:
    """The cells left out when a number of segments covers the most, in the search space ``paper``.

    A cell that a segment enters can be covered whole without another segment: uncovered pieces of
    it go, one by one, to a segment beside them in the same cell. So only whole cells are left out.
    In the model such a cell has a color of its own, which is joinable nowhere, and its root is not
    counted.

    Args:
        weights: of each cell, 0 or more.
        segments: the most that there may be.
        options: deadline, workers and seed.

    Returns:
        The cells left out of the best division found, and the weight that no division covers more
        of. None if nothing was found in time, or the model is too large.
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
    solver = runner.portfolio()
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
