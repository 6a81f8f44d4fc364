"""Lower bounds that hold for any division of the physical surface: set cover, independent set.

A color region is a connected component of the cells that have a color. Every segment lies in one,
so there are at least as many segments as regions needed to touch all cells. Cells of which no two
lie in a common region are in different segments: an independent set of the graph that joins two
cells where a region holds both. (Files call this kind of bound ``strangers``.)
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import TYPE_CHECKING

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.union_find import UnionFind

if TYPE_CHECKING:
    from ortools.sat.python import cp_model

Region = tuple[int, frozenset[int]]
"""A color region: the color, and its cells."""

_Found = tuple[set[int] | None, int]
"""The variables chosen, None if no solution was found in time; and the bound proved."""

EFFORT = 5.0
"""Deterministic seconds for a cover; nearly all take a thousandth of that."""

CERTIFICATE_EFFORT = 0.5
"""Deterministic seconds for each model on the way to a certificate, which is never waited for."""


@dataclass(frozen=True, slots=True)
class Cover:
    """The fewest color regions that were found to touch every cell together.

    No cover has fewer than ``bound`` regions, and no division of the surface fewer segments.
    """

    regions: list[Region]
    bound: int


def color_regions(instance: Instance) -> list[Region]:
    """Every color's region, split into components over the edges that are joinable for it.

    No segment reaches beyond one of these (docs/semantics.md, section 4). They come by color, those
    of one color by their smallest cell.
    """
    together = UnionFind((color, cell.id) for cell in instance.cells for color in cell.colors)
    for edge in instance.edges:
        for color in instance.joinable(edge.id):
            together.union((color, edge.left), (color, edge.right))
    found = sorted(together.sets(), key=min)
    return [(min(own)[0], frozenset(cell for _, cell in own)) for own in found]


def within(instance: Instance, regions: Iterable[Region]) -> Instance:
    """The instance in the colors of some color regions, which touch every cell."""
    allowed = {(cell, color) for color, cells in regions for cell in cells}

    def few(colors: Sequence[int], *cells: int) -> tuple[int, ...]:
        return tuple(c for c in colors if all((cell, c) in allowed for cell in cells))

    return replace(
        instance,
        cells=tuple(replace(cell, colors=few(cell.colors, cell.id)) for cell in instance.cells),
        edges=tuple(
            replace(e, colors=few(instance.joinable(e.id), e.left, e.right)) for e in instance.edges
        ),
    )


def set_cover(regions: Sequence[Region], deadline: Deadline = NEVER) -> Cover:
    """A smallest set of color regions that touches every cell; its size is a lower bound.

    After the deadline it is the best cover and bound so far.
    """
    touching = _touching(regions)
    greedy = _greedy(regions, touching)
    numbers, bound = _smallest(touching, EFFORT, deadline, greedy)
    chosen = greedy if numbers is None else numbers
    return Cover([regions[number] for number in sorted(chosen)], max(bound, bool(regions)))


def hard_cells(instance: Instance, value: int, deadline: Deadline = NEVER) -> list[int] | None:
    """A few cells that fewer than ``value`` color regions cannot touch: why no cover is smaller.

    If there are as many cells as ``value``, no two of them lie in one color region: they are an
    independent set, which can be seen by eye. Otherwise each group of cells that color regions
    connect has its own cells: repeatedly, a cell is added that a smallest cover of the others
    misses.

    Returns:
        The cells, ascending; None if none were found in time.
    """
    regions = color_regions(instance)
    cells = greedy_independent_set(regions)
    if len(cells) >= value:
        return sorted(cells)[:value]
    touching = _touching(regions)
    found: list[int] = []
    for group in sorted(_groups(touching), key=len):
        if value > 0 and not deadline.over:
            demands = [touching[cell] for cell in group]
            need = min(value, _smallest(demands, CERTIFICATE_EFFORT, deadline)[1])
            hard = _hard_cells_of(group, need, touching, deadline)
            if hard is None:
                return None
            found += hard
            value -= need
    return sorted(found) if value == 0 else None


def _hard_cells_of(
    group: Sequence[int], value: int, touching: Sequence[set[int]], deadline: Deadline
) -> list[int] | None:
    """:func:`hard_cells` of cells that no color region connects with others."""
    cells = _apart(group, touching)
    if len(cells) >= value:
        return cells[:value]
    hardest_first = sorted(group, key=lambda cell: len(touching[cell]))
    while not deadline.over:
        demands = [touching[cell] for cell in cells]
        chosen, bound = _smallest(demands, CERTIFICATE_EFFORT, deadline)
        if bound >= value:
            return cells
        missed = (c for c in hardest_first if touching[c].isdisjoint(chosen or ()))
        if chosen is None or (cell := next(missed, None)) is None:
            return None
        cells.append(cell)
    return None


def greedy_independent_set(regions: Sequence[Region]) -> list[int]:
    """Cells of which no two lie in one color region; not always the most."""
    touching = _touching(regions)
    return _apart(range(len(touching)), touching)


def _apart(cells: Iterable[int], touching: Sequence[set[int]]) -> list[int]:
    """Some of the cells, of which no two lie in one color region."""
    used: set[int] = set()
    found = []
    for cell in sorted(cells, key=lambda cell: len(touching[cell])):
        if used.isdisjoint(touching[cell]):
            found.append(cell)
            used.update(touching[cell])
    return found


def _groups(demands: Sequence[Collection[int]]) -> list[list[int]]:
    """The places of demands in groups that no chain of regions connects."""
    first: dict[int, int] = {}
    together = UnionFind(range(len(demands)))
    for place, numbers in enumerate(demands):
        for number in numbers:
            together.union(first.setdefault(number, place), place)
    return sorted(map(sorted, together.sets()))


def _touching(regions: Sequence[Region]) -> list[set[int]]:
    """The numbers of the regions that each cell lies in."""
    touching: list[set[int]] = [set() for _ in frozenset[int]().union(*(r[1] for r in regions))]
    for number, (_, own) in enumerate(regions):
        for cell in own:
            touching[cell].add(number)
    return touching


def _smallest(
    demands: Iterable[set[int]], effort: float, deadline: Deadline, hint: Collection[int] = ()
) -> _Found:
    """A minimum hitting set, the fewest regions with at least one of each demand."""
    from ortools.sat.python import cp_model  # slow to import, so only where it is used

    chosen: set[int] | None = set()
    bound = 0
    # Cells that the same regions touch are one demand.
    different = sorted({tuple(sorted(numbers)) for numbers in demands})
    # Demands that nothing connects are models of their own: together they would be a hard one.
    for places in _groups(different):
        model = cp_model.CpModel()
        own = sorted({number for place in places for number in different[place]})
        literal = {number: model.new_bool_var("") for number in own}
        for place in places:
            model.add_bool_or(literal[number] for number in different[place])
        for number in own if hint else ():
            model.add_hint(literal[number], number in hint)
        model.minimize(sum(literal.values()))
        found, least = _solve(model, list(literal.values()), effort, deadline)
        bound += least
        if chosen is not None:
            chosen = None if found is None else chosen | {own[place] for place in found}
    return chosen, bound


def _greedy(regions: Sequence[Region], touching: Sequence[set[int]]) -> set[int]:
    """A cover: for the cell with the fewest regions the largest of them, and so on."""
    chosen: set[int] = set()
    covered: set[int] = set()
    for cell in sorted(range(len(touching)), key=lambda cell: len(touching[cell])):
        if cell not in covered:
            best = max(sorted(touching[cell]), key=lambda number: len(regions[number][1] - covered))
            chosen.add(best)
            covered |= regions[best][1]
    return chosen


def _solve(
    model: cp_model.CpModel, chosen: Sequence[cp_model.IntVar], effort: float, deadline: Deadline
) -> _Found:
    """Solve a small model as far as there is time and effort for it."""
    from ortools.sat.python import cp_model

    from cellcolor.solvers.interruptible import make_cp_solver, solve_interruptibly

    solver = make_cp_solver(deadline, 1, 0, effort)
    # A cover of many regions is bounded by its linear relaxation or hardly at all.
    solver.parameters.linearization_level = 2
    status, interrupt = solve_interruptibly(solver, model)
    if interrupt is not None:
        raise interrupt
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None, 0
    picked = {n for n, literal in enumerate(chosen) if solver.boolean_value(literal)}
    return picked, ceil(solver.best_objective_bound - 1e-6)
