"""The enumerative solver of one cell (paper, section IV).

A cell is coded dart by dart: ``1`` where its painting continues across the edge, ``0`` where it
does not. In a simple cell (section IV-B) all ``1`` belong to the one painted cell. A complex cell
(section IV-C) has sub-cells: a run of ``×`` stands for darts that another sub-cell takes, which is
coded in turn, in brackets, inside that run. Both are one search along the cyclic list. Every dart
is a ``0``, continues a sub-cell whose bracket is open (which closes the brackets inside it) or
opens a bracket. Since the first ``1`` always belongs to the outermost sub-cell, no division is
coded twice.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.dfs.graph import GraphCell

EITHER = -1
"""Stands for a color: either of two."""

Side = tuple[int, int]
"""What a solved cell shows at a dart: its state and color, ``(0, EITHER)`` where the painting ends
in the color of the sub-cell before or of that after the dart."""


@dataclass(frozen=True, slots=True)
class CellScheme:
    """One way to divide and paint one cell.

    Attributes:
        subcells: color and places of the darts in state 1 of each sub-cell; a cell with no such
            dart is one sub-cell without darts.
        sides: for each dart, what the cell beyond it is shown.
    """

    subcells: tuple[tuple[int, tuple[int, ...]], ...]
    sides: tuple[Side, ...]


def zero_colors(painted: Sequence[int | None], own: int) -> list[tuple[int, int]]:
    """The colors that each dart in state 0 may show: that of the sub-cell before and after it.

    "The 0s can be freely moved outside the bracket" (section IV-C): a run of zeros between two
    sub-cells may lie in either, its beginning in the one before and its end in the one after.

    Args:
        painted: the color of each dart in state 1, None in state 0, in cyclic order.
        own: the color of the cell when no dart is in state 1.

    Returns:
        (before, after) for each dart; it means nothing for one in state 1.
    """
    ones = [color for color in painted if color is not None] or [own]
    shown, passed = [], 0
    for color in painted:
        shown.append((ones[passed - 1], ones[passed % len(ones)]))
        passed += color is not None
    return shown


def cell_schemes(
    cell: GraphCell, known: Sequence[Side | None], deadline: Deadline = NEVER
) -> Iterator[CellScheme]:
    """Every way to divide and paint a cell that agrees with its solved neighbors.

    Args:
        known: for each dart what the cell beyond shows, None as long as that cell is unsolved.
    """
    search = _CellSearch(cell, known, deadline)
    yield from search.schemes(several=False)
    yield from search.schemes(several=True)


@dataclass(frozen=True, slots=True)
class _Code:
    """The code of the first darts of a cell.

    Attributes:
        owner: the number of the sub-cell of each of these darts, -1 in state 0.
        colors: of the sub-cells.
        opened: the sub-cells whose brackets are open, the outermost first.
        last: the place of the last dart in state 1, -1 before there is one.
    """

    owner: tuple[int, ...] = ()
    colors: tuple[int, ...] = ()
    opened: tuple[int, ...] = ()
    last: int = -1


class _CellSearch:
    """The search of :func:`cell_schemes`."""

    def __init__(self, cell: GraphCell, known: Sequence[Side | None], deadline: Deadline) -> None:
        self._cell, self._known, self._deadline = cell, known, deadline
        self._room = [0]
        """How many darts from a place on may be in state 1."""
        for side in reversed(known):
            self._room.insert(0, self._room[0] + (side is None or side[0] == 1))

    def schemes(self, several: bool) -> Iterator[CellScheme]:
        """Those of one sub-cell (section IV-B), or those of several (section IV-C)."""
        trail = [iter([_Code()])]
        while trail:
            self._deadline.check()
            code = next(trail[-1], None)
            if code is None:
                trail.pop()
            elif len(code.owner) < len(self._cell.darts):
                trail.append(self._longer(code, several))
            elif (len(code.colors) > 1) == several:
                yield from self._complete(code)

    def _longer(self, code: _Code, several: bool) -> Iterator[_Code]:
        """The code with one dart more, in every way."""
        i, block = len(code.owner), len(code.colors)
        single = sum(code.owner.count(own) == 1 for own in code.opened)
        if several and single > self._room[i]:
            return  # "a single × cannot form a sub-cell": too few darts are left for these
        side = self._side(i, code)
        # Of an edge's strands those that are joined come first: to exchange one in state 0 with its
        # neighbor in state 1 changes neither the order of the darts in state 1 nor the segments.
        strand = self._cell.strands[i] if side is None else 0
        beside_one = bool(code.owner) and code.owner[-1] >= 0
        if side is None:
            colors = sorted(self._cell.joinable[i]) if strand < 1 or beside_one else []
        else:
            colors = [side[1]] if side[0] == 1 else []
        for level in reversed(range(len(code.opened))):
            own = code.opened[level]
            if code.colors[own] in colors and self._follows(code, i, own, code.colors[own]):
                yield _Code((*code.owner, own), code.colors, code.opened[: level + 1], i)
            if code.owner.count(own) == 1:
                break  # closing this bracket would leave a single × behind
        for color in colors if several or not block else ():
            if self._follows(code, i, block, color):
                yield _Code((*code.owner, block), (*code.colors, color), (*code.opened, block), i)
        if (side is None or side[0] == 0) and not (strand < 0 and beside_one):
            yield _Code((*code.owner, -1), code.colors, code.opened, code.last)

    def _side(self, i: int, code: _Code) -> Side | None:
        """What is shown across dart i, which may be an edge of the cell with itself."""
        partner = self._cell.partners[i]
        if not 0 <= partner < i:
            return self._known[i]
        own = code.owner[partner]
        return (1, code.colors[own]) if own >= 0 else (0, EITHER)

    def _follows(self, code: _Code, i: int, own: int, color: int) -> bool:
        """Whether dart i may come next in state 1, in this sub-cell."""
        if code.last < 0:
            return True
        before = code.owner[code.last]
        return (own == before or color != code.colors[before]) and self._gap(
            range(code.last + 1, i), code.colors[before], color
        )

    def _gap(self, zeros: Sequence[int], before: int, after: int) -> bool:
        """Whether a run of zeros can show colors other than their solved neighbors show."""
        forced_after = False
        for i in zeros:
            side = self._known[i]
            if side is None or side[1] not in self._cell.joinable[i]:
                continue
            forced_after = forced_after or side[1] == before
            if forced_after and side[1] == after:
                return False
        return True

    def _complete(self, code: _Code) -> Iterator[CellScheme]:
        """The scheme with this code, if the end of the list fits its beginning.

        Without a dart in state 1 there is one for each color of the cell.
        """
        size = len(code.owner)
        if code.last < 0:
            for color in self._cell.colors:
                if self._gap(range(size), color, color):
                    yield CellScheme(((color, ()),), ((0, color),) * size)
            return
        darts = [
            tuple(i for i in range(size) if code.owner[i] == own) for own in range(len(code.colors))
        ]
        if len(darts) > 1 and any(len(places) == 1 for places in darts):
            return
        first, own = darts[0][0], code.owner[code.last]
        color = code.colors[own]
        if own != 0 and color == code.colors[0]:
            return
        if self._gap([*range(code.last + 1, size), *range(first)], color, code.colors[0]):
            painted = [code.colors[own] if own >= 0 else None for own in code.owner]
            sides = tuple(
                (1, one) if one is not None else (0, before if before == after else EITHER)
                for one, (before, after) in zip(painted, zero_colors(painted, color), strict=True)
            )
            yield CellScheme(tuple(zip(code.colors, darts, strict=True)), sides)
