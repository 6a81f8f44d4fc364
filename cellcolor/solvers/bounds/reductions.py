"""Two reductions that keep the minimum: dropping colors of cells, and limiting strands of edges."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import color_regions


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A color region that is dropped, because another color, ``stand_in``, can replace it."""

    color: int
    cells: frozenset[int]
    stand_in: int


def drop_dominated(instance: Instance, dropped: Iterable[LeftOut]) -> tuple[frozenset[int], ...]:
    """The colors that each cell keeps when some color regions are dropped."""
    allowed = [set(cell.colors) for cell in instance.cells]
    for region in dropped:
        for cell in region.cells:
            allowed[cell].discard(region.color)
    return tuple(frozenset(colors) for colors in allowed)


def left_out(instance: Instance, deadline: Deadline = NEVER) -> list[LeftOut]:
    """Dominated color regions (docs/semantics.md, section 6), in the order they are dropped.

    A region is dominated if some other color is available in each of its cells and joinable across
    each edge across which the region's own color is joinable: whatever is painted in the region's
    color can be painted in the other. Regions are dropped one at a time, because of two regions
    that dominate each other one has to stay. This keeps the minimum of both search spaces, but not
    the set of optimal schemes. After the deadline no more regions are dropped.
    """
    found: list[LeftOut] = []
    allowed = [set(cell.colors) for cell in instance.cells]
    joinable = {edge.id: set(instance.joinable(edge.id)) for edge in instance.edges}
    for color, cells in sorted(color_regions(instance), key=lambda region: len(region[1])):
        if deadline.over:
            break
        # The edges inside the region across which its color is joinable.
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


def enough_crossings(instance: Instance, colors: Sequence[frozenset[int]]) -> dict[int, float]:
    """How many strands of each live edge suffice for a minimum over all divisions, or infinity.

    An edge with a single joinable color is crossed at most once. If it is crossed m > 1 times, then
    on either side m different sub-cells cross some other edge of their cell, too: m is at most the
    sum of the crossings of the cell's other edges (docs/bounds/crossings.md). This
    is applied until nothing changes. It says nothing about a side whose cell has several live
    loops, nor about edges with the same cell on both sides.

    Args:
        colors: the colors each cell may be painted in, all or some of its own.
    """
    enough = {
        edge.id: math.inf
        if len(colors[edge.left] & colors[edge.right] & set(instance.joinable(edge.id))) > 1
        else 1
        for edge in instance.edges
        if instance.joinable(edge.id)
    }
    borders = [
        [abs(dart) for dart in loops[0]] if len(loops) == 1 else [] for loops in instance.live_loops
    ]
    changed = True
    while changed:
        changed = False
        for edge in instance.edges:
            known = enough.get(edge.id, 1)
            if known == 1 or edge.left == edge.right:
                continue
            for border in (borders[edge.left], borders[edge.right]):
                others = sum(enough[other] for other in border if other != edge.id)
                if border and max(1, others) < enough[edge.id]:
                    enough[edge.id] = max(1, others)
                    changed = True
    return enough
