"""A division improved by local search: small changes, each kept if it leaves no more segments.

The nodes of a refined graph are painted one by one. A move takes a segment and peels it: its nodes
take the colors of neighboring segments, the outermost first. If nothing of it is left, there is a
segment less. What cannot be peeled, its kernel, is led to other segments on paths of few nodes.
These paths cut other segments, and neighbors absorb the fragments. A node becomes dearer with each
path through it, so that the search does not stay at one place.

There are thousands of moves a second. A segment is a set of nodes, and when it loses some of them,
no more of it is looked at than tells whether it has come apart.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from heapq import heappop, heappush

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Painting, canonical, segments_of
from cellcolor.solvers.cpsat.routes.sectors import (
    RefinedGraph,
    node_colors,
    painting_of_nodes,
    refined,
)

ONE_MORE = 0.0013
"""The chance that a division with one segment more is kept."""

FAR = 3
"""Segments above the best from which the search begins at the best again."""

MOST_KERNELS = 12
"""Cells of a kernel, above which the segment is joined with another instead of dissolved."""

TO_ITS_COLOR, TO_ANY_COLOR, TO_THE_NEAREST = 0.15, 0.375, 0.45
"""How often a move leads one cell of the kernel to a segment of the same color, of any color of the
cell, or of that which costs least, each less the ones before it; the others dissolve the kernel."""

SKIPPED, GUESSED = 0.5, 0.5
"""When a kernel is dissolved: how often a cell is left out that other segments touch as well, and
how often a cell is led to a segment of any color instead of the one that costs least."""

FREE, USED, IN_VAIN, GROWTH = 0.01, 0.02, 0.05, 1.0003
"""The cost of a node that a path need not change; what the price of a node rises by when a path
changes it, and when that is taken back; how much more both are with each move, because old prices
count less."""

FEW_MOVES = 5
"""Moves in vain for each segment after which it is seen what a start is good for."""

PAUSE = 20
"""Moves in vain before a division is made of the nodes. That takes time by the size of the whole,
and in the beginning nearly every move gains something."""


class Recoloring:
    """A division of a refined graph, changed node by node.

    Args:
        graph: the refined graph.
        colors: of each node.
        seed: of the choice of moves.
        deadline: of getting ready, which takes time by the size of the graph.

    Attributes:
        fewest: segments of the best division so far.
    """

    def __init__(
        self, graph: RefinedGraph, colors: Sequence[int], seed: int, deadline: Deadline = NEVER
    ) -> None:
        self._graph = graph
        self._chance = random.Random(seed)
        self._find_regions(deadline)
        self._region = [
            self._number[color, cell] for color, cell in zip(colors, graph.cell, strict=True)
        ]
        self._segment = [-1] * len(colors)
        self._nodes: dict[int, set[int]] = {}
        self._named = 0
        self._price = [0.0] * len(colors)
        self._rise = 1.0
        self._journal: list[tuple[int, int]] = []
        self._settle()
        self._best = list(self._region)
        self.fewest = len(self._nodes)

    @property
    def segments(self) -> int:
        """Of the division now."""
        return len(self._nodes)

    @property
    def current(self) -> list[int]:
        """The color of each node now."""
        return [self._color[region] for region in self._region]

    @property
    def best(self) -> list[int]:
        """The color of each node in the best division so far."""
        return [self._color[region] for region in self._best]

    def move(self) -> None:
        """Try to do with a segment less; what leaves more segments is taken back, nearly always."""
        before = len(self._nodes)
        self._journal = []
        self._try()
        self._rise *= GROWTH
        if self._rise > 1e9:  # long before numbers are too large
            self._price = [price / self._rise for price in self._price]
            self._rise = 1.0
        more = len(self._nodes) - before
        if more > 1 or (more == 1 and self._chance.random() >= ONE_MORE):
            self._take_back()
        elif len(self._nodes) < self.fewest:
            self.fewest = len(self._nodes)
            self._best = list(self._region)
        elif len(self._nodes) > self.fewest + FAR:
            self._region = list(self._best)
            self._settle()

    def _find_regions(self, deadline: Deadline) -> None:
        """Number the color regions: a node's region says its color, and where it can spread to."""
        graph = self._graph
        self._color: list[int] = []
        self._near: list[dict[int, list[int]]] = []
        self._number: dict[tuple[int, int], int] = {}
        for color in sorted({color for colors in graph.graph.colors for color in colors}):
            near = graph.near(color)
            for first in deadline.watch(near):
                if (color, graph.cell[first]) in self._number:
                    continue
                own: dict[int, list[int]] = {first: near[first]}
                for node in (reached := [first]):
                    self._number[color, graph.cell[node]] = len(self._near)
                    for other in near[node]:
                        if other not in own:
                            own[other] = near[other]
                            reached.append(other)
                self._color.append(color)
                self._near.append(own)
        shared: dict[tuple[int, frozenset[int]], frozenset[int]] = {}

        def regions(cell: int, colors: frozenset[int]) -> frozenset[int]:
            key = cell, colors
            if key not in shared:
                shared[key] = frozenset(self._number[color, cell] for color in colors)
            return shared[key]

        self._choices = [
            sorted(regions(cell, colors)) for cell, colors in enumerate(graph.graph.colors)
        ]
        self._around = [
            [
                *((other, regions(cell, graph.graph.colors[cell])) for other in beside),
                *((other, regions(cell, colors)) for other, colors in across),
            ]
            for cell, beside, across in deadline.watch(
                zip(graph.cell, graph.beside, graph.across, strict=True)
            )
        ]
        self._fixed = {
            node for node, cell in enumerate(graph.cell) if len(self._choices[cell]) == 1
        }

    # Segments and their nodes

    def _settle(self) -> None:
        """Find all segments anew."""
        self._nodes = {}
        self._there = [0] * len(self._near)
        self._segment = [-1] * len(self._region)
        self._join(range(len(self._region)))

    def _join(self, nodes: Iterable[int]) -> None:
        """Put nodes that are in no segment into those that they touch, which become one."""
        segment, region = self._segment, self._region
        for node in nodes:
            own = region[node]
            touched = {
                segment[other]
                for other in self._near[own][node]
                if region[other] == own and segment[other] >= 0
            }
            if not touched:
                self._name({node})
                continue
            largest = max(touched, key=lambda number: len(self._nodes[number]))
            segment[node] = largest
            self._nodes[largest].add(node)
            for number in touched:
                if number != largest:
                    moved = self._nodes.pop(number)
                    self._there[own] -= 1
                    self._nodes[largest] |= moved
                    for other in moved:
                        segment[other] = largest

    def _name(self, nodes: set[int]) -> None:
        """Make a segment of nodes."""
        self._nodes[self._named] = nodes
        self._there[self._region[next(iter(nodes))]] += 1
        for node in nodes:
            self._segment[node] = self._named
        self._named += 1

    def _paint(self, painted: dict[int, int]) -> None:
        """Give nodes other regions; segments come apart and together by that."""
        lost: dict[int, list[int]] = {}
        for node in painted:
            number = self._segment[node]
            lost.setdefault(number, []).append(node)
            self._segment[node] = -1
            self._journal.append((node, self._region[node]))
        for number, nodes in lost.items():
            members = self._nodes[number]
            members.difference_update(nodes)
            if not members:
                del self._nodes[number]
                self._there[self._region[nodes[0]]] -= 1
                continue
            near = self._near[self._region[nodes[0]]]
            beside = {
                other for node in nodes for other in near[node] if self._segment[other] == number
            }
            if len(beside) > 1:
                for fragment in self._fragments(number, near, sorted(beside)):
                    members.difference_update(fragment)
                    self._name(set(fragment))
        for node, region in painted.items():
            self._region[node] = region
        self._join(painted)

    def _fragments(
        self, number: int, near: dict[int, list[int]], starts: list[int]
    ) -> Iterator[list[int]]:
        """What a segment has come apart into, all but one piece, the largest as a rule.

        From each place where it lost nodes a flood rises, all at the same pace. Two that meet are
        one; one that cannot rise is a piece. The last one that is left needs not be followed.
        """
        segment = self._segment
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

    def _take_back(self) -> None:
        before: dict[int, int] = {}
        for node, region in reversed(self._journal):
            before[node] = region
            self._price[node] += IN_VAIN * self._rise
        self._paint(before)

    # Moves

    def _try(self) -> None:
        chance = self._chance
        numbers = list(self._nodes)
        number = chance.choice(numbers)
        while chance.random() > len(self._nodes[number]) ** -0.5:  # small ones rather
            number = chance.choice(numbers)
        touched = {next(iter(self._nodes[number]))}
        # Peeling takes time by the size of a segment, and one with cells of one color keeps these.
        kernel = sorted(self._nodes[number] & self._fixed) or self._peeled(number)[1]
        if kernel:
            way = chance.random()
            if way < TO_THE_NEAREST:
                node = chance.choice(kernel)
                cell = self._graph.cell[node]
                regions: Sequence[int] = [self._region[node]]
                if way >= TO_ANY_COLOR:
                    regions = self._choices[cell]
                elif way >= TO_ITS_COLOR:
                    regions = [chance.choice(self._choices[cell])]
                touched |= self._lead(cell, regions, number)
                touched.update(self._graph.nodes[cell])
            else:
                touched |= self._dissolve(kernel, number)
        self._absorb(touched)

    def _dissolve(self, kernel: list[int], number: int) -> set[int]:
        """Lead the cells of a kernel to other segments; hands back what that touched."""
        chance = self._chance
        own = self._region[kernel[0]]
        cells = sorted({self._graph.cell[node] for node in kernel})
        if len(cells) > MOST_KERNELS:
            return self._lead(self._graph.cell[chance.choice(kernel)], [own], number)
        chance.shuffle(cells)
        touched = set(kernel)
        for cell in cells:
            held = {
                self._segment[node] for node in self._graph.nodes[cell] if self._region[node] == own
            }
            others = any(self._region[node] != own for node in self._graph.nodes[cell])
            if others and chance.random() < SKIPPED:
                continue
            regions: Sequence[int] = self._choices[cell]
            if chance.random() < GUESSED:
                regions = [chance.choice(regions)]
            touched |= self._lead(cell, regions, max(held, default=-1))
        return touched

    def _peeled(self, number: int) -> tuple[dict[int, int], list[int]]:
        """The regions that the nodes of a segment can take from its neighbors; and its kernel."""
        segment, region = self._segment, self._region
        members = self._nodes[number]
        found: dict[int, int] = {}
        for node in members:
            beyond = [
                region[other]
                for other, regions in self._around[node]
                if segment[other] != number and region[other] in regions
            ]
            if beyond:
                found[node] = self._chance.choice(beyond) if len(beyond) > 1 else beyond[0]
        order = list(found)
        self._chance.shuffle(order)
        for node in order:
            taken = found[node]
            for other in self._near[taken][node]:
                if segment[other] == number and other not in found:
                    found[other] = taken
                    order.append(other)
        return found, [node for node in members if node not in found]

    def _absorb(self, touched: Iterable[int]) -> None:
        """Let neighbors absorb segments that were touched, where they can, the smallest first."""
        for _ in range(2):
            before = len(self._nodes)
            numbers = sorted({self._segment[node] for node in touched})
            for number in sorted(numbers, key=lambda number: len(self._nodes[number])):
                if number in self._nodes and self._fixed.isdisjoint(self._nodes[number]):
                    found, kernel = self._peeled(number)
                    if not kernel:
                        self._paint(found)
            if len(self._nodes) == before:
                return

    def _lead(self, cell: int, regions: Sequence[int], avoided: int) -> set[int]:
        """Lead a cell to another segment, as cheaply as can be; hands back what that touched."""
        least, path, chosen = float("inf"), [], -1
        held = self._nodes.get(avoided)
        own = self._region[next(iter(held))] if held else -1
        for region in regions:
            if self._there[region] == (region == own):
                continue
            cost, found = self._path(cell, region, avoided, least)
            if cost < least:
                least, path, chosen = cost, found, region
        if not path:
            return set()
        for node in path:
            self._price[node] += USED * self._rise
        self._paint(dict.fromkeys(path, chosen))
        return {other for node in path for other, _ in self._around[node]}.union(path)

    def _path(self, cell: int, region: int, avoided: int, most: float) -> tuple[float, list[int]]:
        """The cheapest path (Dijkstra) from a cell to another segment in a region, and its cost.

        Nodes cost, not arcs, so that each has its distance when it is first reached.
        """
        near, current, segment = self._near[region], self._region, self._segment
        price, rise, draw = self._price, self._rise, self._chance.random
        before: dict[int, int] = {}
        waiting: list[tuple[float, int]] = []
        for node in self._graph.nodes[cell]:
            before[node] = -1
            own = current[node] == region
            heappush(waiting, (0.0 if own else (1 + price[node] / rise) * (0.5 + draw()), node))
        while waiting:
            cost, node = heappop(waiting)
            if cost >= most:
                break
            if current[node] == region and segment[node] != avoided:
                path = []
                while node >= 0:
                    if current[node] != region:
                        path.append(node)
                    node = before[node]
                return cost, path
            for other in near[node]:
                if other not in before:
                    before[other] = node
                    added = FREE
                    if current[other] != region:
                        added = (1 + price[other] / rise) * (0.5 + draw())
                    heappush(waiting, (cost + added, other))
        return most, []


def recolor(
    graph: DartGraph, painting: Painting, seed: int, enough: int, deadline: Deadline, moves: int
) -> Iterator[Painting]:
    """Better and better divisions of a graph, each with a segment less at least.

    Args:
        graph: the dart graph.
        painting: a canonical painting of it.
        seed: of the choice of moves.
        enough: segments that are few enough.
        deadline: when to stop.
        moves: for each segment, before nothing better is expected.
    """
    ways = refined(graph, 1)  # one ring leaves room enough in most cells
    search = Recoloring(ways, node_colors(ways, painting), seed, deadline)
    fewest = len(segments_of(graph, painting))
    in_vain = 0
    while True:
        ended = search.fewest <= enough or in_vain >= moves * search.fewest or deadline.over
        if search.fewest < fewest and (ended or in_vain >= PAUSE):
            fewest = search.fewest
            yield canonical(graph, painting_of_nodes(ways, search.best))
        if ended:
            return
        before = search.fewest
        search.move()
        in_vain = in_vain + 1 if search.fewest == before else 0
