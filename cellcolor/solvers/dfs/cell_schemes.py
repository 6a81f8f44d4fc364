"""The enumerative solver of one cell (paper, section IV).

A cell is coded dart by dart: ``1`` where its painting continues across the edge, ``0`` where it
does not. In a simple cell (section IV-B) all ``1`` belong to the one painted cell. A complex cell
(section IV-C) may have sub-cells: a run of ``×`` stands for darts that another sub-cell takes,
which is coded in turn, in brackets, inside that run. Here both are one search along the cyclic
list. The sub-cells whose brackets are still open form a stack; every dart is a ``0``, goes on with
a sub-cell of the stack (which closes the brackets above it) or opens a bracket. Since the first
``1`` always belongs to the outermost sub-cell, no division is coded twice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.dfs.graph import GraphCell

DartKnowledge = tuple[int, int | None] | None
"""What is known of an edge from the cell beyond it: ``(1, color)``, ``(0, color)`` when the other
side certainly shows that color, ``(0, None)`` when it may show either of two, None if unsolved."""

_Place = tuple[int, tuple[int, ...], int]
"""The next dart, the open sub-cells, and the last dart in state 1, -1 before there is one."""


@dataclass(frozen=True, slots=True)
class CellScheme:
    """One way to divide and paint one cell.

    Attributes:
        subcells: color and places of the darts in state 1 of each sub-cell; a cell with no such
            dart is one sub-cell without darts.
        sides: for each dart, what its other side learns.
    """

    subcells: tuple[tuple[int, tuple[int, ...]], ...]
    sides: tuple[DartKnowledge, ...]


def zero_colors(painted: Sequence[int | None], own: int) -> list[tuple[int, int] | None]:
    """The colors that each dart in state 0 may show: that of the sub-cell before and after it.

    "The 0s can be freely moved outside the bracket" (section IV-C): a run of zeros between two
    sub-cells may lie in either, its beginning in the one before and its end in the one after.

    Args:
        painted: the color of each dart in state 1, None in state 0, in cyclic order.
        own: the color of the cell when no dart is in state 1.

    Returns:
        (before, after) for each dart in state 0, None for the others.
    """
    ones = [color for color in painted if color is not None]
    before = ones[-1] if ones else own
    after: list[int] = []
    following = ones[0] if ones else own
    for color in reversed(painted):
        following = following if color is None else color
        after.append(following)
    shown: list[tuple[int, int] | None] = []
    for color, following in zip(painted, reversed(after), strict=True):
        shown.append((before, following) if color is None else None)
        before = before if color is None else color
    return shown


def cell_schemes(
    cell: GraphCell, known: Sequence[DartKnowledge], deadline: Deadline = NEVER
) -> Iterator[CellScheme]:
    """Every way to divide and paint a cell that agrees with what is known across its darts."""
    return _CellSearch(cell, known, deadline).schemes()


class _CellSearch:
    """The search of :func:`cell_schemes`."""

    def __init__(self, cell: GraphCell, known: Sequence[DartKnowledge], deadline: Deadline) -> None:
        self._cell = cell
        self._known = known
        self._deadline = deadline
        size = len(cell.darts)
        self._block: list[int] = [-1] * size
        """The sub-cell of each dart in state 1, -1 in state 0."""
        self._color: list[int] = []
        self._members: list[int] = []
        """The color of each sub-cell, and how many darts in state 1 it has so far."""
        self._room = [0] * (size + 1)
        """How many darts from here on may be in state 1."""
        for i in reversed(range(size)):
            side = known[i]
            self._room[i] = self._room[i + 1] + (side is None or side[0] == 1)

    def schemes(self) -> Iterator[CellScheme]:
        trail: list[Iterator[_Place]] = [iter([(0, (), -1)])]
        while trail:
            place = next(trail[-1], None)
            if place is None:
                trail.pop()
            elif place[0] == len(self._block):
                yield from self._complete(place[2])
            else:
                trail.append(self._ways(*place))

    def _ways(self, i: int, stack: tuple[int, ...], last: int) -> Iterator[_Place]:
        """Code dart i in every way, one after the other, and take it back: where that leads."""
        self._deadline.check()
        single = sum(self._members[b] == 1 for b in stack) if len(self._color) > 1 else 0
        if single > self._room[i]:
            return  # "a single × cannot form a sub-cell": too few darts left to complete them
        colors = self._state_one(i)
        for level in reversed(range(len(stack))):
            block = stack[level]
            color = self._color[block]
            if color in colors and self._follows(i, last, block, color):
                self._block[i] = block
                self._members[block] += 1
                yield i + 1, stack[: level + 1], i
                self._members[block] -= 1
            if self._members[block] == 1:
                break  # closing this bracket would leave a single × behind
        for color in colors:
            if self._follows(i, last, -1, color):
                self._block[i] = len(self._color)
                self._color.append(color)
                self._members.append(1)
                yield i + 1, (*stack, self._block[i]), i
                self._color.pop()
                self._members.pop()
        self._block[i] = -1
        if self._may_be_zero(i):
            yield i + 1, stack, last

    def _state_one(self, i: int) -> list[int]:
        """The colors in which dart i may be in state 1."""
        joinable, side, partner = self._cell.joinable[i], self._known[i], self._cell.partner[i]
        if side is not None:
            state, color = side
            return [color] if state == 1 and color is not None else []
        if 0 <= partner < i:  # the other side of this edge belongs to this cell
            block = self._block[partner]
            return [self._color[block]] if block >= 0 else []
        if self._cell.strand_before[i] > 0 and self._block[i - 1] < 0:
            return []
        return sorted(joinable)

    def _may_be_zero(self, i: int) -> bool:
        side, partner = self._known[i], self._cell.partner[i]
        if side is not None:
            return side[0] == 0
        if 0 <= partner < i:
            return self._block[partner] < 0
        # Strands that are joined come first: exchanging a strand in state 0 with its neighbour in
        # state 1 changes neither the order of the darts in state 1 nor the segments.
        return not (self._cell.strand_before[i] < 0 and self._block[i - 1] >= 0)

    def _follows(self, i: int, last: int, block: int, color: int) -> bool:
        """Whether dart i may come next in state 1, in this sub-cell (-1: a new one)."""
        if last < 0:
            return True
        before = self._block[last]
        return (block == before or color != self._color[before]) and self._gap(
            range(last + 1, i), self._color[before], color
        )

    def _gap(self, zeros: Sequence[int], before: int, after: int) -> bool:
        """Whether a run of zeros can show colors other than their solved neighbours show."""
        forced_after = False
        for i in zeros:
            side = self._known[i]
            if side is None or side[1] is None or side[1] not in self._cell.joinable[i]:
                continue
            forced_after = forced_after or side[1] == before
            if forced_after and side[1] == after:
                return False
        return True

    def _complete(self, last: int) -> Iterator[CellScheme]:
        size = len(self._block)
        if last < 0:
            for color in self._cell.colors:
                if self._gap(range(size), color, color):
                    yield from self._scheme(((color, ()),), color)
            return
        first = next(i for i in range(size) if self._block[i] >= 0)
        several = len(self._color) > 1
        if several and 1 in self._members:
            return
        a, b = self._block[last], self._block[first]
        if a != b and self._color[a] == self._color[b]:
            return
        around = [*range(last + 1, size), *range(first)]
        if self._gap(around, self._color[a], self._color[b]):
            darts: list[list[int]] = [[] for _ in self._color]
            for i, block in enumerate(self._block):
                if block >= 0:
                    darts[block].append(i)
            subcells = tuple((c, tuple(d)) for c, d in zip(self._color, darts, strict=True))
            yield from self._scheme(subcells, self._color[0])

    def _scheme(
        self, subcells: tuple[tuple[int, tuple[int, ...]], ...], own: int
    ) -> Iterator[CellScheme]:
        painted = [self._color[b] if b >= 0 else None for b in self._block]
        sides: list[DartKnowledge] = []
        for color, shown in zip(painted, zero_colors(painted, own), strict=True):
            if shown is None:
                sides.append((1, color))
            else:
                sides.append((0, shown[0] if shown[0] == shown[1] else None))
        for i, partner in enumerate(self._cell.partner):
            side = sides[i]
            if 0 <= partner < i and side is not None and side[0] == 0:
                touching = side[1] is not None and side == sides[partner]
                if touching and side[1] in self._cell.joinable[i]:
                    return
        yield CellScheme(subcells, tuple(sides))
