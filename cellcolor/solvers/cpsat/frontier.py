"""Optimal schemes by dynamic programming over the cells: counted exactly and listed.

This is a frontier, or transfer matrix, method. The cells are painted one after the other. Two
partial paintings have the same completions if they look alike from the cells to come, and make one
**front**: the states of the darts towards unpainted cells, which of these are connected, what zeros
among them can show, and how many segments are complete. The fronts after each cell form a layered
graph. Its paths from the first to the last layer are the schemes, each one once.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from functools import cache
from typing import NamedTuple

from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.cell_divisions import ZERO, Blocks, divisions
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block, Painting
from cellcolor.solvers.cpsat.shown_colors import Choices, ShownColors, choices_with, shown_in_cell
from cellcolor.union_find import UnionFind

MOST_STEPS = 1_000_000
"""Steps from front to front that are kept; they take some hundred megabytes."""

MOST_DARTS = 200
"""Darts of one cell, whose divisions are listed by recursion over its darts."""


_Joined = tuple[int, int] | None
"""The color and the segment of a dart in state 1; None for a zero."""


class _Front(NamedTuple):
    """What the cells to come see of a partial painting.

    Attributes:
        closed: segments that are complete.
        joined: what each open dart, one towards an unpainted cell, is joined with.
        shown: every way in which the zeros can show colors, one or more (``shown_colors``).
    """

    closed: int
    joined: tuple[_Joined, ...]
    shown: frozenset[Choices]


_EMPTY = _Front(0, (), frozenset({Choices((), frozenset())}))


class Frontier:
    """All schemes of a graph with a number of segments.

    Args:
        graph: the dart graph, loops apart.
        segments: of the schemes, the fewest there are.
        can_be_drawn: whether the blocks of a cell with several loops do not cross.
        given: the division of cells that need not vary; all are from one scheme.

    Attributes:
        count: of all schemes.

    Raises:
        TooLarge: there are too many fronts, or darts of one cell.
    """

    def __init__(
        self,
        graph: DartGraph,
        regions: Sequence[Region],
        segments: int,
        can_be_drawn: Callable[[int, Sequence[Block]], bool],
        deadline: Deadline,
        given: Mapping[int, Blocks] | None = None,
    ) -> None:
        if max(map(len, graph.lists), default=0) > MOST_DARTS:
            raise TooLarge("a cell has too many darts for its divisions to be counted")
        self._graph, self._segments, self._deadline = graph, segments, deadline
        self._can_be_drawn, self._given = can_be_drawn, given or {}
        self._region = {(cell, c): n for n, (c, cells) in enumerate(regions) for cell in cells}
        self._order = _order(graph, self._given)
        # After each number of cells, the painted darts whose twin is not painted yet.
        place = {cell: number for number, cell in enumerate(self._order)}
        spans = [(place[dart.cell], place[graph.darts[dart.twin].cell]) for dart in graph.darts]
        self._open = [
            [number for number, (own, other) in enumerate(spans) if own < depth <= other]
            for depth in range(len(self._order) + 1)
        ]
        self._needed = cache(self._needed_now)
        self._divisions = cache(self._divisions_now)
        # By layer and front its steps: a division of the next cell, and the number of the front
        # that it leads to. Steps that lead to no scheme are left out.
        self._steps: list[list[list[tuple[Blocks, int]]]] = []
        ends = self._build()
        # For each front of a layer, the last one first, how many schemes are reached from it.
        reached = [1] * ends
        for depth in reversed(range(len(self._steps))):
            layer = [[step for step in own if reached[step[1]]] for own in self._steps[depth]]
            self._steps[depth] = layer
            reached = [sum(reached[end] for _, end in own) for own in layer]
        self.count = reached[0]

    def paintings(self) -> Iterator[Painting]:
        """Every scheme, once."""
        trail = [iter(self._steps[0][0])]
        chosen: list[Blocks] = []
        while trail:
            step = next(trail[-1], None)
            if step is None:
                trail.pop()
                del chosen[-1:]
                continue
            chosen.append(step[0])
            if len(chosen) < len(self._steps):
                trail.append(iter(self._steps[len(chosen)][step[1]]))
            else:
                yield self._painting(chosen)
                chosen.pop()

    def _painting(self, chosen: Sequence[Blocks]) -> Painting:
        of_cell = sorted(zip(self._order, chosen, strict=True))
        return [[Block(color, set(darts)) for color, darts in blocks] for _, blocks in of_cell]

    def _build(self) -> int:
        """Find all fronts, layer by layer; the number of fronts in the last one."""
        kept = 0
        layer: dict[_Front, int] = {_EMPTY: 0}
        for depth in range(len(self._order)):
            following: dict[_Front, int] = {}
            steps: list[list[tuple[Blocks, int]]] = []
            for front in layer:
                self._deadline.check()
                steps.append(
                    [
                        (blocks, following.setdefault(after, len(following)))
                        for blocks, after in self._onward(depth, front)
                    ]
                )
                kept += len(steps[-1])
                if kept > MOST_STEPS:
                    raise TooLarge("the schemes have too many fronts to be counted")
            self._steps.append(steps)
            layer = following
        return len(layer)

    def _onward(self, depth: int, front: _Front) -> Iterator[tuple[Blocks, _Front]]:
        """Each way to paint the next cell that may lead to a scheme, and the front after it."""
        darts, cell = self._graph.darts, self._order[depth]
        before = dict(zip(self._open[depth], front.joined, strict=True))
        zeros = [dart for dart, joined in before.items() if joined is None]
        choices = [(dict(zip(zeros, shown, strict=True)), own) for shown, own in front.shown]
        states = {dart: ZERO if joined is None else joined[0] for dart, joined in before.items()}
        known = tuple(states.get(darts[dart].twin) for dart in self._graph.lists[cell])
        for blocks, ways in self._divisions(cell, known):
            closed, joined = self._joined_after(depth, before, blocks)
            closed += front.closed
            held = 0
            for dart, own in zip(self._open[depth + 1], joined, strict=True):
                if own is not None:
                    held |= 1 << self._region[darts[dart].cell, own[0]]
            if closed + self._needed(depth + 1, held) > self._segments:
                continue
            shown = choices_with(self._graph, choices, cell, ways, self._open[depth + 1])
            if shown and (depth + 1 < len(self._order) or closed == self._segments):
                yield blocks, _Front(closed, joined, shown)

    def _joined_after(
        self, depth: int, before: Mapping[int, _Joined], blocks: Blocks
    ) -> tuple[int, tuple[_Joined, ...]]:
        """How many segments the divided cell completes, and what its darts and the others join.

        Args:
            depth: how many cells are painted before it.
            before: the color and the segment of each open dart before, None for a zero.
            blocks: of the cell. Until they are united with others they are segments -1, -2, …
        """
        of = {dart: own for dart, own in before.items() if own is not None}
        segments = UnionFind([*range(-len(blocks), 0), *(segment for _, segment in of.values())])
        for number, (color, own) in enumerate(blocks):
            of |= dict.fromkeys(own, (color, -1 - number))
        for _, own in blocks:
            for dart in own:
                twin = self._graph.darts[dart].twin
                if twin in of:
                    segments.union(of[dart][1], of[twin][1])
        numbers: dict[int, int] = {}
        joined: list[_Joined] = []
        for dart in self._open[depth + 1]:
            if dart in of:
                color, segment = of[dart]
                joined.append((color, numbers.setdefault(segments[segment], len(numbers))))
            else:
                joined.append(None)
        return len(segments.sets()) - len(numbers), tuple(joined)

    def _needed_now(self, depth: int, held: int) -> int:
        """A lower bound of the regions that include those held and touch every cell to come.

        Cells that no held region touches, and that share no region, need one more each.
        """
        cells = {
            sum(1 << self._region[cell, color] for color in self._graph.colors[cell])
            for cell in self._order[depth:]
        }
        needed, taken = held.bit_count(), held
        for regions in sorted(cells, key=lambda own: (own.bit_count(), own)):
            if not regions & taken:
                taken |= regions
                needed += 1
        return needed

    def _divisions_now(
        self, cell: int, known: tuple[int | None, ...]
    ) -> list[tuple[Blocks, list[ShownColors]]]:
        """Every way to divide a cell, with the ways in which its zeros can show colors."""
        found: Iterable[Blocks] = [self._given[cell]] if cell in self._given else ()
        if not found:
            found = divisions(self._graph, cell, known, self._can_be_drawn, self._deadline)
        return [
            (blocks, shown_in_cell(self._graph.loops[cell], blocks))
            for blocks in self._deadline.watch(found)
        ]


def _order(graph: DartGraph, given: Collection[int]) -> list[int]:
    """The given cells, and then the others in an order with few open darts."""
    around = [[graph.darts[graph.darts[d].twin].cell for d in own] for own in graph.lists]
    order = sorted(given)
    left = set(range(len(graph.lists))).difference(order)
    reached: set[int] = set()
    while left:

        def weight(cell: int) -> tuple[int, int, int]:
            free = sum(other in left and other != cell for other in around[cell])
            return free, 2 * free - len(around[cell]), cell

        chosen = min(reached & left or left, key=weight)
        left.discard(chosen)
        order.append(chosen)
        reached.update(around[chosen])
    return order
