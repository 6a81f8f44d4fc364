"""All optimal schemes, counted and listed by dynamic programming over the cells (``frontier``)."""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping, Sequence
from random import Random

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, scheme_key
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.cell_divisions import Blocks, Planarity
from cellcolor.solvers.cpsat.dart_graph import dart_graph
from cellcolor.solvers.cpsat.frontier import Frontier
from cellcolor.solvers.cpsat.painting import begun, division_of
from cellcolor.solvers.interface import Options

_COUNTING = 1 / 2
"""Share of the time that is left for all schemes at once."""
_NEARBY = 0.3
"""Seconds for all the schemes around a known one."""
_IN_VAIN = 100
"""Known schemes around which nothing new was found, before the list ends without a time limit."""


class OptimalSchemes(Iterator[Division]):
    """Every scheme with the fewest segments, each once (semantics, section 3).

    If there are too many fronts to list all schemes at once, those are listed that differ in a few
    cells from the one to start from, from one of these, and so on. That never proves that there are
    no others, so it always ends with ``OutOfTime`` or ``TooLarge``.

    Args:
        options: deadline, seed, and a division to start from.
        segments: the minimum.

    Attributes:
        count: how many there are; None as long as that is not known.

    Raises:
        TooLarge: there are too many fronts, or cells with too many darts.
    """

    def __init__(self, instance: Instance, options: Options, segments: int) -> None:
        self.count: int | None = None
        self._instance, self._options, self._segments = instance, options, segments
        once = dict.fromkeys((edge.id for edge in instance.edges), 1)
        self._graph = dart_graph(instance, once, None)
        self._planarity = Planarity(self._graph, options.deadline)
        self._found = self._all()

    def __next__(self) -> Division:
        return next(self._found)

    def _all(self) -> Generator[Division, None, None]:
        if not self._instance.cells:
            self.count = 1
            yield ()
            return
        deadline = self._options.deadline
        try:
            frontier = self._frontier(deadline.share(_COUNTING))
        except (OutOfTime, TooLarge) as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            deadline.check()
            yield from self._nearby()
            raise
        self.count = frontier.count
        for painting in frontier.paintings():
            deadline.check()
            yield division_of(self._graph, painting)

    def _frontier(self, deadline: Deadline, given: Mapping[int, Blocks] | None = None) -> Frontier:
        regions = color_regions(self._instance)
        draw = self._planarity.can_be_drawn
        return Frontier(self._graph, regions, self._segments, draw, deadline, given)

    def _nearby(self) -> Iterator[Division]:
        """Schemes that differ from a known one in a few cells only."""
        if self._options.start is None:
            return
        once = dict.fromkeys(self._instance.live_edges, 1)
        start = begun(self._instance, once, self._options.start, self._graph)
        first = division_of(self._graph, start)
        rng, known, seen = Random(self._options.seed), [start], {scheme_key(first)}
        if self._instance.most_live_loops < 2:
            yield first
        around = [
            sorted({self._graph.darts[self._graph.darts[dart].twin].cell for dart in own})
            for own in self._graph.lists
        ]
        size, in_vain = 2, 0
        while in_vain < _IN_VAIN:
            free = _patch(around, size, rng)
            given = {
                cell: tuple((block.color, tuple(sorted(block.darts))) for block in blocks)
                for cell, blocks in enumerate(rng.choice(known))
                if cell not in free
            }
            in_vain += 1
            try:
                deadline = Deadline.after(min(_NEARBY, self._options.deadline.left))
                for painting in self._frontier(deadline, given).paintings():
                    self._options.deadline.check()
                    division = division_of(self._graph, painting)
                    if (key := scheme_key(division)) not in seen:
                        in_vain = 0
                        seen.add(key)
                        known.append(painting)
                        yield division
                size = min(size + 1, len(around))
            except (OutOfTime, TooLarge) as error:
                if isinstance(error, KeyboardInterrupt):
                    raise
                self._options.deadline.check()
                size = max(size - 2, 1)


def _patch(around: Sequence[Sequence[int]], size: int, rng: Random) -> set[int]:
    """So many cells, or a few fewer, that are connected."""
    found = [rng.randrange(len(around))]
    for cell in found:
        beside = [other for other in around[cell] if other not in found]
        found += rng.sample(beside, len(beside))
        if len(found) >= size:
            break
    return set(found[:size])
