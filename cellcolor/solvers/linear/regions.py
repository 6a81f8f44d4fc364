"""Color regions: connected areas in which one color continues across every edge between."""

from __future__ import annotations

from typing import NamedTuple

from cellcolor.data.instance import Instance


class Region(NamedTuple):
    """A color region of two cells or more.

    Attributes:
        cell: the first of its cells.
        color: which one continues.
        longest_way: no way without a circle in a tree of sub-cells crosses more edges.
    """

    cell: int
    color: int
    longest_way: int


def color_regions(instance: Instance) -> dict[tuple[int, int], Region]:
    """The region of each (cell, color) that can be joined to a neighbor."""
    exits: dict[tuple[int, int], list[int]] = {}
    for edge in instance.live_edges:
        for color in instance.joinable(edge):
            for dart in (edge, -edge):
                exits.setdefault((instance.across(-dart), color), []).append(dart)
    found: dict[tuple[int, int], Region] = {}
    for begin in exits:
        if begin in found:
            continue
        cells, waiting = {begin[0]}, [begin[0]]
        while waiting:
            for dart in exits[waiting.pop(), begin[1]]:
                other = instance.across(dart)
                if other not in cells:
                    cells.add(other)
                    waiting.append(other)
        color = begin[1]
        edges = {abs(dart) for cell in cells for dart in exits[cell, color]}
        # The color goes no further in a cell with one exit: a way meets two such cells at most.
        ends = {abs(exits[cell, color][0]) for cell in cells if len(exits[cell, color]) == 1}
        longest = len(edges) - len(ends) + min(2, len(ends))
        for cell in cells:
            found[cell, color] = Region(min(cells), color, longest)
    return found
