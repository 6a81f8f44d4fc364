"""A division improved by local search: thousands of small moves a second (docs/solver.md).

A move picks a segment of the painted nodes (``painted_sectors``) and tries to do without it:

1. *Peel it.* Its nodes take the colors of neighboring segments, the outermost first. What no
   neighbor can take is its **kernel**: mostly the nodes of cells with one color.
2. *Lead the kernel away.* Cheapest paths connect its cells with other segments, which cuts those
   that are crossed. A node becomes dearer with each path through it (guided local search), so that
   the search does not stay in one place.
3. *Absorb.* Every segment that was touched is peeled in turn, if nothing of it stays.

A move that leaves more segments is taken back, except for a few that leave one more.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from heapq import heappop, heappush
from random import Random

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painted_sectors import PaintedSectors
from cellcolor.solvers.cpsat.painting import Painting, canonical, segments_of
from cellcolor.solvers.cpsat.sectors import (
    SectorGraph,
    painting_of_sectors,
    sector_colors,
    sector_graph,
)

ONE_MORE = 0.0013
"""The chance that a move is kept although it leaves one segment more."""

FAR = 3
"""With more segments than these above the fewest, the search returns to the best division."""

MOST_DISSOLVED = 12
"""Of a kernel with up to so many cells all are led away, of a larger one a single cell."""

TO_ITS_COLOR, TO_ANY_COLOR, TO_THE_NEAREST = 0.15, 0.375, 0.45
"""What is done with a kernel, as cumulative shares of the moves: one cell of it is led to a segment
of the same color, of a random color of the cell, or of the color that costs least. All other moves
dissolve the kernel: they lead each of its cells away."""

SKIPPED, GUESSED = 0.5, 0.5
"""When a kernel is dissolved: how often a cell is left out that other segments touch as well, and
how often a cell is led to a segment of a random color instead of the color that costs least."""

FREE, USED, IN_VAIN, GROWTH = 0.01, 0.02, 0.05, 1.0003
"""The cost of a node that a path need not change. What a node's price rises by when a path changes
it, and when that is taken back. The factor by which both grow with each move, so that old rises
count less."""

PAUSE = 20
"""Moves in vain before a division is made of the nodes, which takes time: in the beginning nearly
every move gains something."""


class Recoloring:
    """A division of a sector graph, changed node by node.

    Args:
        regions: the color regions of the cells.
        colors: of each node.
        rng: chooses the moves.
        deadline: of getting ready.

    Attributes:
        fewest: segments of the best division so far.
    """

    def __init__(
        self,
        graph: SectorGraph,
        regions: Sequence[Region],
        colors: Sequence[int],
        rng: Random,
        deadline: Deadline = NEVER,
    ) -> None:
        self._graph = graph
        self._chance = rng
        self._painted = PaintedSectors(graph, regions, colors, deadline)
        # What changing a node costs besides 1, in units of the rise, which grows with each move.
        self._price = [0.0] * len(colors)
        self._rise = 1.0
        # The nodes that this move has changed, with their regions before.
        self._journal: list[tuple[int, int]] = []
        self._best = list(self._painted.region)
        self.fewest = self.segments

    @property
    def segments(self) -> int:
        """How many segments the division has now."""
        return len(self._painted.nodes)

    @property
    def current(self) -> list[int]:
        """The color of each node now."""
        return self._painted.colors(self._painted.region)

    @property
    def best(self) -> list[int]:
        """The color of each node in the best division so far."""
        return self._painted.colors(self._best)

    def move(self) -> None:
        """Try to do with a segment less, and take back what leaves more segments, nearly always."""
        before = self.segments
        self._journal = []
        self._change()
        self._rise *= GROWTH
        if self._rise > 1e9:  # long before numbers are too large
            self._price = [price / self._rise for price in self._price]
            self._rise = 1.0
        more = self.segments - before
        if more > 1 or (more == 1 and self._chance.random() >= ONE_MORE):
            self._take_back()
        elif self.segments < self.fewest:
            self.fewest = self.segments
            self._best = list(self._painted.region)
        elif self.segments > self.fewest + FAR:
            self._painted.paint_all(self._best)

    def _paint(self, painted: Mapping[int, int]) -> None:
        self._journal += [(node, self._painted.region[node]) for node in painted]
        self._painted.paint(painted)

    def _take_back(self) -> None:
        for node, _ in self._journal:
            self._price[node] += IN_VAIN * self._rise
        self._painted.paint(dict(reversed(self._journal)))

    def _change(self) -> None:
        """Pick a segment, lead its kernel or some of it away, and let neighbors absorb the rest."""
        painted, chance = self._painted, self._chance
        numbers = list(painted.nodes)
        number = chance.choice(numbers)
        while chance.random() > len(painted.nodes[number]) ** -0.5:  # prefers small ones
            number = chance.choice(numbers)
        touched = {next(iter(painted.nodes[number]))}
        # Nodes with one choice are never peeled; where there are some, peeling is not needed.
        kernel = sorted(painted.nodes[number] & painted.fixed) or self._peeled(number)[1]
        way = chance.random() if kernel else 0.0
        if kernel and way >= TO_THE_NEAREST:
            touched |= self._dissolve(kernel, number)
        elif kernel:
            node = chance.choice(kernel)
            cell = self._graph.cell[node]
            regions: Sequence[int] = [painted.region[node]]
            if way >= TO_ANY_COLOR:
                regions = painted.choices[cell]
            elif way >= TO_ITS_COLOR:
                regions = [chance.choice(painted.choices[cell])]
            touched |= self._lead(cell, regions, number)
            touched.update(self._graph.nodes[cell])
        self._absorb(touched)

    def _dissolve(self, kernel: list[int], number: int) -> set[int]:
        """Lead the cells of a kernel to other segments; the nodes that this touched."""
        painted, chance = self._painted, self._chance
        own = painted.region[kernel[0]]
        cells = sorted({self._graph.cell[node] for node in kernel})
        if len(cells) > MOST_DISSOLVED:
            return self._lead(self._graph.cell[chance.choice(kernel)], [own], number)
        chance.shuffle(cells)
        touched = set(kernel)
        for cell in cells:
            nodes = self._graph.nodes[cell]
            held = {painted.segment[node] for node in nodes if painted.region[node] == own}
            others = any(painted.region[node] != own for node in nodes)
            if others and chance.random() < SKIPPED:
                continue
            regions: Sequence[int] = painted.choices[cell]
            if chance.random() < GUESSED:
                regions = [chance.choice(regions)]
            touched |= self._lead(cell, regions, max(held, default=-1))
        return touched

    def _peeled(self, number: int) -> tuple[dict[int, int], list[int]]:
        """The region that each node of a segment can take over from a neighbor; and the kernel."""
        segment, region = self._painted.segment, self._painted.region
        members = self._painted.nodes[number]
        found: dict[int, int] = {}
        for node in members:
            beyond = [
                region[other]
                for other, regions in self._painted.around[node]
                if segment[other] != number and region[other] in regions
            ]
            if beyond:
                found[node] = self._chance.choice(beyond) if len(beyond) > 1 else beyond[0]
        order = list(found)
        self._chance.shuffle(order)
        for node in order:
            taken = found[node]
            for other in self._painted.near[taken][node]:
                if segment[other] == number and other not in found:
                    found[other] = taken
                    order.append(other)
        return found, [node for node in members if node not in found]

    def _absorb(self, touched: Iterable[int]) -> None:
        """Let neighbors absorb whole segments among those that were touched, smallest first."""
        painted = self._painted
        for _ in range(2):
            before = self.segments
            numbers = sorted({painted.segment[node] for node in touched})
            for number in sorted(numbers, key=lambda number: len(painted.nodes[number])):
                if number in painted.nodes and painted.fixed.isdisjoint(painted.nodes[number]):
                    found, kernel = self._peeled(number)
                    if not kernel:
                        self._paint(found)
            if self.segments == before:
                return

    def _lead(self, cell: int, regions: Sequence[int], avoided: int) -> set[int]:
        """Lead a cell to a segment in one of some regions, by the cheapest path.

        Args:
            avoided: the segment that the cell is to leave.

        Returns:
            The nodes that this touched; none if there is no path.
        """
        least, path, chosen = float("inf"), [], -1
        held = self._painted.nodes.get(avoided)
        own = self._painted.region[next(iter(held))] if held else -1
        for region in regions:
            if self._painted.count[region] == (region == own):
                continue
            cost, found = self._path(cell, region, avoided, least)
            if cost < least:
                least, path, chosen = cost, found, region
        if not path:
            return set()
        for node in path:
            self._price[node] += USED * self._rise
        self._paint(dict.fromkeys(path, chosen))
        return {other for node in path for other, _ in self._painted.around[node]}.union(path)

    def _path(self, cell: int, region: int, avoided: int, most: float) -> tuple[float, list[int]]:
        """The cheapest path (Dijkstra) from a cell to another segment in a region, and its cost.

        Nodes cost, not arcs, so that each has its distance when it is first reached.
        """
        painted = self._painted
        near, current, segment = painted.near[region], painted.region, painted.segment
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
    graph: DartGraph,
    regions: Sequence[Region],
    painting: Painting,
    rng: Random,
    enough: int,
    deadline: Deadline,
    moves: int,
    rings: int = 1,
) -> Iterator[Painting]:
    """Better and better divisions of a graph, each with a segment less at least.

    Args:
        painting: a canonical painting of it.
        enough: segments that are few enough.
        moves: for each segment, before nothing better is expected.
        rings: of sectors in a cell; with none, each cell is painted whole.
    """
    sectors = sector_graph(graph, rings)
    search = Recoloring(sectors, regions, sector_colors(sectors, painting), rng, deadline)
    fewest = len(segments_of(graph, painting))
    in_vain = 0
    while True:
        ended = search.fewest <= enough or in_vain >= moves * search.fewest or deadline.over
        if search.fewest < fewest and (ended or in_vain >= PAUSE):
            fewest = search.fewest
            yield canonical(graph, painting_of_sectors(sectors, search.best))
        if ended:
            return
        before = search.fewest
        search.move()
        in_vain = in_vain + 1 if search.fewest == before else 0
