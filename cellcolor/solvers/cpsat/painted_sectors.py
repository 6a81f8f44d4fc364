"""A division by the colors of nodes, with segments that follow when nodes get other colors.

A segment is a set of connected nodes. When it loses some of them, no more of it is looked at than
tells whether it has come apart, so that thousands of changes a second are possible.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.sectors import SectorGraph


class PaintedSectors:
    """The nodes of a sector graph, each painted in one of its color regions.

    A region says more than a color: where the color can spread to.

    Args:
        colors: of each node.
        regions: the color regions of the cells.

    Attributes:
        near: of each region its nodes, with their neighbors in it.
        choices: the regions that each cell lies in.
        around: the neighbors of each node, with the regions in which the two can be joined.
        fixed: the nodes with one choice only.
        region: of each node, the region that it is painted in.
        segment: of each node, the number of its segment.
        nodes: of each segment, by its number.
        count: of each region, how many segments it has.
    """

    def __init__(
        self,
        graph: SectorGraph,
        regions: Sequence[Region],
        colors: Sequence[int],
        deadline: Deadline,
    ) -> None:
        self._color = [color for color, _ in regions]
        number = {(color, cell): n for n, (color, cells) in enumerate(regions) for cell in cells}
        self.near: list[dict[int, list[int]]] = [
            {
                node: [
                    *graph.beside[node],
                    *(other for other, joinable in graph.across[node] if color in joinable),
                ]
                for cell in sorted(cells)
                for node in graph.nodes[cell]
            }
            for color, cells in deadline.watch(regions)
        ]
        within = [
            frozenset(number[color, cell] for color in own)
            for cell, own in enumerate(graph.graph.colors)
        ]
        self.choices = [sorted(own) for own in within]
        self.around = [
            [
                *((other, within[cell]) for other in beside),
                *(
                    (other, frozenset(number[color, cell] for color in joinable))
                    for other, joinable in across
                ),
            ]
            for cell, beside, across in deadline.watch(
                zip(graph.cell, graph.beside, graph.across, strict=True)
            )
        ]
        self.fixed = {node for node, cell in enumerate(graph.cell) if len(self.choices[cell]) == 1}
        self._named = 0
        self.paint_all(number[pair] for pair in zip(colors, graph.cell, strict=True))

    def colors(self, region: Iterable[int]) -> list[int]:
        """The colors of regions."""
        return [self._color[number] for number in region]

    def paint_all(self, region: Iterable[int]) -> None:
        """Paint each node in a region."""
        self.region = list(region)
        self.nodes: dict[int, set[int]] = {}
        self.count = [0] * len(self.near)
        self.segment = [-1] * len(self.region)
        self._join(range(len(self.region)))

    def paint(self, painted: Mapping[int, int]) -> None:
        """Give nodes other regions; segments come apart and together by that."""
        lost: dict[int, list[int]] = {}
        for node in painted:
            number = self.segment[node]
            lost.setdefault(number, []).append(node)
            self.segment[node] = -1
        for number, nodes in lost.items():
            members = self.nodes[number]
            members.difference_update(nodes)
            if not members:
                del self.nodes[number]
                self.count[self.region[nodes[0]]] -= 1
                continue
            near = self.near[self.region[nodes[0]]]
            beside = {
                other for node in nodes for other in near[node] if self.segment[other] == number
            }
            if len(beside) > 1:
                for fragment in self._fragments(number, near, sorted(beside)):
                    members.difference_update(fragment)
                    self._name(set(fragment))
        for node, region in painted.items():
            self.region[node] = region
        self._join(painted)

    def _join(self, nodes: Iterable[int]) -> None:
        """Put nodes without a segment into the segments that they touch, which are merged."""
        segment, region = self.segment, self.region
        for node in nodes:
            own = region[node]
            touched = {
                segment[other]
                for other in self.near[own][node]
                if region[other] == own and segment[other] >= 0
            }
            if not touched:
                self._name({node})
                continue
            largest = max(touched, key=lambda number: len(self.nodes[number]))
            segment[node] = largest
            self.nodes[largest].add(node)
            for number in touched:
                if number != largest:
                    moved = self.nodes.pop(number)
                    self.count[own] -= 1
                    self.nodes[largest] |= moved
                    for other in moved:
                        segment[other] = largest

    def _name(self, nodes: set[int]) -> None:
        """Make a segment of nodes."""
        self.nodes[self._named] = nodes
        self.count[self.region[next(iter(nodes))]] += 1
        for node in nodes:
            self.segment[node] = self._named
        self._named += 1

    def _fragments(
        self, number: int, near: dict[int, list[int]], starts: list[int]
    ) -> Iterator[list[int]]:
        """What a segment has come apart into, all but one piece, the largest as a rule.

        From each place where it lost nodes a flood rises, all at the same pace. Two that meet are
        one; one that cannot rise is a piece. The last one that is left needs not be followed.
        """
        segment = self.segment
        flood_of = {node: flood for flood, node in enumerate(starts)}
        found = [[node] for node in starts]
        rising = [deque(nodes) for nodes in found]
        within = list(range(len(starts)))
        left = dict.fromkeys(within)
        while len(left) > 1:
            for flood in list(left):
                if flood not in left or len(left) == 1:
                    continue
                if not rising[flood]:
                    del left[flood]
                    yield found[flood]
                    continue
                for other in near[rising[flood].popleft()]:
                    if segment[other] != number:
                        continue
                    met = flood_of.get(other)
                    if met is None:
                        flood_of[other] = flood
                        found[flood].append(other)
                        rising[flood].append(other)
                        continue
                    while within[met] != met:
                        met = within[met]
                    if met != flood:
                        within[met] = flood
                        found[flood] += found[met]
                        rising[flood] += rising[met]
                        del left[met]
