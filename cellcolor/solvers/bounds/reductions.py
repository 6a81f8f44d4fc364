"""What a minimum can do without: some colors of cells, and more than a few strands of an edge."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
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


def enough_crossings(
    instance: Instance,
    colors: Sequence[frozenset[int]],
) -> dict[int, float]:
    """Strands of each live edge that are enough for a minimum over all divisions.

    Among all divisions of the surface with the fewest segments, take one with the fewest
    sub-cells, and a spanning tree of each segment. Then (docs/bounds.md, "Crossing an edge twice")

    - successive strands of an edge that the trees cross have different colors, so an edge with a
      single joinable color is crossed once;
    - the sub-cells on either side of an edge that is crossed m > 1 times are m different ones,
      each crossing some other edge of its cell too. So m is at most the sum of the crossings of
      the other edges of the cell, on either side.

    The second point is repeated until nothing changes. Cells with several live loops bound
    nothing, and neither do edges that have one cell on both sides.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all or some of its own.

    Returns:
        A number for every live edge; infinity where nothing is known.
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
