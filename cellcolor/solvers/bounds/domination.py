"""What can be left out of an instance without changing the minimum."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import color_regions


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A color region that another color can replace.

    Attributes:
        color: the region's color.
        cells: the region's cells.
        stand_in: the other color.
    """

    color: int
    cells: frozenset[int]
    stand_in: int


def drop_dominated(instance: Instance, dropped: Iterable[LeftOut]) -> tuple[frozenset[int], ...]:
    """The remaining colors of each cell after some color regions are left out."""
    allowed = [set(cell.colors) for cell in instance.cells]
    for region in dropped:
        for cell in region.cells:
            allowed[cell].discard(region.color)
    return tuple(frozenset(colors) for colors in allowed)


def left_out(instance: Instance, deadline: Deadline = NEVER) -> list[LeftOut]:
    """Color regions that a minimum does not need (docs/semantics.md, section 6), in their order.

    A color's region may be left out if some other color is available in each of its cells and
    joinable across each edge that is joinable for it: anything painted in the one can be painted
    in the other. Regions are left out one at a time, since one of two equal ones has to stay. This
    keeps the minimum of both search spaces, not the set of optimal schemes. After the deadline
    the remaining regions stay.
    """
    found: list[LeftOut] = []
    allowed = [set(cell.colors) for cell in instance.cells]
    joinable = {edge.id: set(instance.joinable(edge.id)) for edge in instance.edges}
    for color, cells in sorted(color_regions(instance), key=lambda region: len(region[1])):
        if deadline.over:
            break
        # Edges between cells of one region that are joinable for its color.
        edges = {
            abs(dart)
            for cell in cells
            for loop in instance.cells[cell].loops
            for dart in loop
            if color in joinable[abs(dart)]
        }
        others = set.intersection(*(allowed[cell] for cell in cells)) - {color}
        for edge in edges:
            if not others:
                break
            others &= joinable[edge]
        if others:
            found.append(LeftOut(color, cells, min(others)))
            for cell in cells:
                allowed[cell].discard(color)
            for edge in edges:
                joinable[edge].discard(color)
    return found
