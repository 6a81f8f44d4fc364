"""The rules that make a division legal, and those that make it a scheme (docs/semantics.md)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from cellcolor.data.darts import Strand, twin

Joinable = Callable[[Strand], frozenset[int]]


@dataclass(frozen=True, slots=True)
class PaintedCell:
    """A cell's division as the rules see it.

    Attributes:
        darts: the cell's live darts, cyclic.
        block_of: the sub-cell of each dart in state 1; the others are in state 0.
        colors: the color of each sub-cell.
    """

    darts: Sequence[Strand]
    block_of: Mapping[Strand, int]
    colors: Sequence[int]

    def joined(self) -> list[Strand]:
        """The darts in state 1, in cyclic order."""
        return [dart for dart in self.darts if dart in self.block_of]


def crossing(cell: PaintedCell) -> tuple[int, int] | None:
    """Two sub-cells whose darts interleave around the border, so that their cuts would cross."""
    blocks = [cell.block_of[dart] for dart in cell.joined()]
    remaining = Counter(blocks)
    stack: list[int] = []
    for block in blocks:
        if not stack or stack[-1] != block:
            # A block may be taken up again only when all those begun since are complete.
            while block in stack and stack[-1] != block:
                if remaining[stack[-1]]:
                    return min(stack[-1], block), max(stack[-1], block)
                stack.pop()
            if block not in stack:
                stack.append(block)
        remaining[block] -= 1
    return None


def superfluous(cell: PaintedCell) -> int | None:
    """Rule 2: with two sub-cells or more, one that has fewer than two darts in state 1."""
    if len(cell.colors) < 2:
        return None
    counts = [0] * len(cell.colors)
    for block in cell.block_of.values():
        counts[block] += 1
    return next((block for block, count in enumerate(counts) if count < 2), None)


def idle_cut(cell: PaintedCell) -> tuple[Strand, Strand] | None:
    """Rule 4: two successive darts in state 1 of different sub-cells with one color."""
    joined = cell.joined()
    for dart, following in zip(joined, joined[1:] + joined[:1], strict=True):
        one, other = cell.block_of[dart], cell.block_of[following]
        if one != other and cell.colors[one] == cell.colors[other]:
            return dart, following
    return None


def unavoidable_join(cells: Sequence[PaintedCell], joinable: Joinable) -> Strand | None:
    """Rule 5: an edge in state 0 that has to show one joinable color on both of its sides.

    Between two successive darts in state 1, the darts in state 0 show first the color of the
    sub-cell before, then that of the sub-cell after. Where the change lies is free in each gap;
    the choices for all gaps of all cells together are a 2-satisfiability problem: a dart's
    variable says that it shows the later color. A dart whose other side is in none of the cells
    may show what it likes.
    """
    shown: dict[Strand, tuple[int, int]] = {}
    clauses: list[tuple[_Literal, _Literal]] = []
    for cell in cells:
        for run, before, after in _gaps(cell):
            shown |= dict.fromkeys(run, (before, after))
            clauses += [((one, False), (other, True)) for one, other in pairwise(run)]
    for dart in shown:
        other = twin(dart)
        if dart[0] < 0 or other not in shown:
            continue
        for late in (False, True):
            for other_late in (False, True):
                color = shown[dart][late]
                if color == shown[other][other_late] and color in joinable(dart):
                    clauses.append(((dart, not late), (other, not other_late)))
    return _contradiction(clauses)


_Literal = tuple[Strand, bool]


def _gaps(cell: PaintedCell) -> Iterator[tuple[list[Strand], int, int]]:
    """The runs of darts in state 0, each with the colors before and after it."""
    joined = cell.joined()
    if not joined:
        if cell.darts:
            yield list(cell.darts), cell.colors[0], cell.colors[0]
        return
    start = list(cell.darts).index(joined[0])
    run: list[Strand] = []
    before = cell.colors[cell.block_of[joined[0]]]
    for dart in [*cell.darts[start + 1 :], *cell.darts[: start + 1]]:
        if dart not in cell.block_of:
            run.append(dart)
            continue
        after = cell.colors[cell.block_of[dart]]
        if run:
            yield run, before, after
        run, before = [], after


def _contradiction(clauses: Sequence[tuple[_Literal, _Literal]]) -> Strand | None:
    """A variable that can be neither true nor false, if the clauses cannot all hold.

    Mostly they all hold with every variable false: each dart shows the color before it.
    """
    if all(not (one[1] and other[1]) for one, other in clauses):
        return None
    import networkx as nx  # slow to import, and most divisions do without

    implications: nx.DiGraph[_Literal] = nx.DiGraph()
    for one, other in clauses:
        implications.add_edge((one[0], not one[1]), other)
        implications.add_edge((other[0], not other[1]), one)
    stuck = [
        dart
        for component in nx.strongly_connected_components(implications)
        for dart, value in component
        if value and (dart, False) in component
    ]
    return max(stuck, default=None)
