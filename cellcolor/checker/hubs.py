"""How many segments cells with many edges save: verified on the graph, by counting links.

Let the hubs be some cells no two of which share a live edge. Of all divisions with the fewest
segments take one with the fewest sub-cells, and a spanning tree of each segment. Without the hubs
the trees fall into pieces. A sub-cell of a hub with k counted darts puts k pieces together, and so
saves k - 1 segments: it has k - 1 links, between each of its darts and the next. So there are as
many segments as pieces, less the links of all hubs, or more. Each edge of a hub is counted once at
most if it has one color, or leads to a cell with no other live dart (docs/bounds.md, "Crossing an
edge twice"). Sub-cells have one color each and do not cross, which limits the links.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.checker.groups import Groups
from cellcolor.checker.hubs_with_loops import most_links
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance


class Hubs:
    """Some cells that are taken away.

    Args:
        instance: the topological graph.
        regions: the color regions that each cell lies in, without those that were left out.
        hubs: the cells.
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
        """The most links that a cell can have, or more.

        Args:
            hub: the cell.
            count: called once for each choice that is tried.
        """
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
