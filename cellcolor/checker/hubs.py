"""How many segments cells with many edges save: verified on the graph, by counting links.

Let the hubs be some cells no two of which share a live edge. Of all divisions with the fewest
segments take one with the fewest sub-cells, and a spanning tree of each segment. Without the hubs
the trees fall into pieces. A sub-cell of a hub with k counted darts puts k pieces together, and so
saves k - 1 segments: it has k - 1 links, between each of its darts and the next. So there are as
many segments as pieces, less the links of all hubs, or more. Each edge of a hub is counted once at
most if it has one color, or leads to a cell with no other live dart (docs/bounds/crossings.md).
Sub-cells have one color each and do not cross, which limits the links.

The most links in a cell with several loops, by counting faces.

Draw a point in each loop and in each group of darts that a sub-cell connects, and a line for each
dart. By Euler's formula, for each part of that plane graph, there are as many links as loops and
walks round its faces together, less two for each part. A walk passes corners between a dart of a
loop and the next. After a corner from color a to color b comes one from b, so that two corners of a
walk are opposite ones, and a walk of three and more is needed wherever loops are to be connected
that have no opposite corners (docs/bounds/hubs.md, "Hubs with several loops").
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance


class Hubs:
    """Some cells that are taken away.

    Args:
        regions: the color regions that each cell lies in, without those that were left out.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[frozenset[ColorRegion]],
        hubs: Collection[int],
    ) -> None:
        self._instance = instance
        self._colors = [{color for color, _ in own} for own in regions]
        self._hubs = frozenset(hubs)

    def regions(self) -> list[frozenset[ColorRegion]]:
        """The color regions that each cell lies in without the hubs; a hub lies in none."""
        together: Groups[ColorRegion] = Groups()
        for edge in self._instance.edges:
            if self._hubs.isdisjoint((edge.left, edge.right)):
                for color in self._live(edge.id):
                    together.join((color, edge.left), (color, edge.right))
        return [
            frozenset(together.find((color, cell)) for color in own)
            if cell not in self._hubs
            else frozenset()
            for cell, own in enumerate(self._colors)
        ]

    def problem(self, hub: int) -> str:
        """Why the links of a cell do not limit what it saves; empty if they do."""
        loops = self._live_loops(hub)
        for dart in (dart for loop in loops for dart in loop):
            beyond = self._instance.across(dart)
            if beyond in self._hubs:
                return f"hub {hub} shares edge {abs(dart)} with a hub"
            others = [self._live_darts(loop) for loop in self._instance.cells[beyond].loops]
            if len(self._live(dart)) > 1 and sum(map(len, others)) > 1:
                return f"edge {abs(dart)} of hub {hub} may be crossed more than once"
            if len(self._live(dart)) > 1 and len(loops) > 1:
                return f"edge {abs(dart)} of hub {hub} has several colors beside several loops"
        return ""

    def links(self, hub: int, count: Callable[[], None]) -> int:
        """The most links that a cell can have, or more; each choice that is tried is counted."""
        loops = self._live_loops(hub)
        if len(loops) > 1:
            return most_links([[min(self._live(d)) for d in loop] for loop in loops], count)
        darts = [dart for loop in loops for dart in loop]
        colors = [self._live(dart) for dart in darts]
        # most[i][j]: of the darts from i to j, j left out. chains[i, color][j]: the same if dart i
        # is in a sub-cell of that color.
        most = [[0] * (len(darts) + 1) for _ in range(len(darts) + 1)]
        chains: dict[tuple[int, int], list[int]] = {}
        for one in reversed(range(len(darts))):
            for color in colors[one]:
                chain = most[one + 1][:]
                for other in range(one + 1, len(darts)):
                    if color in colors[other]:
                        count()
                        between = most[one + 1][other] + 1
                        further = chains[other, color]
                        for end in range(other + 1, len(darts) + 1):
                            chain[end] = max(chain[end], between + further[end])
                chains[one, color] = chain
            options = [most[one + 1], *(chains[one, color] for color in colors[one])]
            most[one] = [max(ends) for ends in zip(*options, strict=True)]
        return most[0][len(darts)]

    def _live(self, dart: int) -> set[int]:
        """The colors in which a dart's edge can be joined."""
        edge = self._instance.edge(abs(dart))
        if OUTSIDE in (edge.left, edge.right):
            return set()
        both = self._colors[edge.left] & self._colors[edge.right]
        return both & set(self._instance.joinable(abs(dart)))

    def _live_darts(self, loop: Sequence[int]) -> list[int]:
        return [dart for dart in loop if self._live(dart)]

    def _live_loops(self, cell: int) -> list[list[int]]:
        found = map(self._live_darts, self._instance.cells[cell].loops)
        return [live for live in found if live]


Corner = tuple[int, int]
"""The color of a dart, and that of the next dart of its loop."""


def most_links(loops: Sequence[Sequence[int]], count: Callable[[], None]) -> int:
    """No more links can be drawn side by side, each between two darts of one color.

    Loops are the colors of their darts, in cyclic order. Each choice that is tried is counted.
    """
    # A dart that is left out was the end of one link at most, after others are put together.
    corners: list[list[Corner]] = []
    left_out = 0
    for loop in loops:
        turns = zip(loop, [*loop[1:], loop[0]], strict=True)
        kept = [(one, other) for one, other in turns if one != other]
        left_out += len(loop) - len(kept)
        if kept:
            corners.append(kept)
    colors = {color for loop in loops for color in loop}
    by_color = sum(map(len, loops)) - len(colors)
    return min(by_color, left_out + (_most(corners, count) if corners else 0))


def _most(loops: Sequence[Sequence[Corner]], count: Callable[[], None]) -> int:
    """The same for loops of which only the corners are known, each between two colors."""
    everywhere = [corner for loop in loops for corner in loop]
    number = {corner: everywhere.count(corner) for corner in set(everywhere)}
    alone = {
        (a, b): found - number.get((b, a), 0)
        for (a, b), found in number.items()
        if found > number.get((b, a), 0)
    }
    kinds: Groups[int] = Groups()
    parts: Groups[int] = Groups()
    for one, its in enumerate(loops):
        for other, others in enumerate(loops[:one]):
            if not {(b, a) for a, b in its}.isdisjoint(others):
                kinds.join(one, other)
            if not {a for a, _ in its}.isdisjoint(a for a, _ in others):
                parts.join(one, other)
    every = range(len(loops))
    kind_count = len({kinds.find(loop) for loop in every})
    part_count = len({parts.find(loop) for loop in every})
    odd_kinds = len(
        {kinds.find(n) for n, its in enumerate(loops) if not alone.keys().isdisjoint(its)}
    )
    best = 0
    # Corners in walks of three and more: those without an opposite one, and any pairs of opposites.
    for pairs in range((len(everywhere) - sum(alone.values())) // 2 + 1):
        long = sum(alone.values()) + 2 * pairs
        in_pairs = (len(everywhere) - long) // 2
        if long in (1, 2):
            continue
        for drawn in range(part_count, kind_count + 1):
            count()
            # So many kinds have to be connected by longer walks, each of which makes one of as
            # many as it has corners, at most.
            saved = kind_count - drawn
            walks = min(long // 3, long - saved)
            if saved and (walks < 1 or saved >= pairs + odd_kinds):
                continue
            best = max(best, len(loops) + in_pairs + walks - 2 * drawn)
    return best
