"""The rules that make a division legal, and those that make it a scheme (docs/semantics.md).

Where cells have several loops, the rules are read without seams (section 5).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise, product

from cellcolor.checker.dart_lists import strands_along, whole_subcells
from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import Strand, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam

Joinable = Callable[[Strand], frozenset[int]]


@dataclass(frozen=True, slots=True)
class PaintedCell:
    """A cell's division as the rules see it.

    Attributes:
        darts: the cell's live darts, cyclic.
        block_of: the sub-cell of each dart in state 1; the others are in state 0.
        colors: of the sub-cells.
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
    that is a 2-satisfiability problem: a dart's variable says that it shows the later color. A dart
    whose other side is in none of the cells may show what it likes.
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
        for late, other_late in product((False, True), repeat=2):
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


PaintedLoops = dict[int, list[PaintedCell]]
"""The division of each cell with live loops, loop by loop; each has the sub-cells of the cell."""


def as_one(loops: Sequence[PaintedCell]) -> PaintedCell:
    """All loops of a cell as if they were one."""
    darts = [dart for loop in loops for dart in loop.darts]
    block_of = {dart: block for loop in loops for dart, block in loop.block_of.items()}
    return PaintedCell(darts, block_of, loops[0].colors)


def unconnected_pair(loops: Sequence[PaintedCell]) -> tuple[int, int] | None:
    """Two sub-cells of one color that no chain of loops and sub-cells connects."""
    groups: Groups[int] = Groups()
    for loop in loops:
        for one, other in pairwise(loop.block_of.values()):
            groups.join(one, other)
    colors = loops[0].colors
    blocks = sorted({block for loop in loops for block in loop.block_of.values()})
    for one, other in combinations(blocks, 2):
        if colors[one] == colors[other] and groups.find(one) != groups.find(other):
            return one, other
    return None


def on_loops(
    instance: Instance, division: Division, seams: Sequence[Seam], strands: int
) -> PaintedLoops:
    """A legal division without its seams."""
    virtual = {seam.id for seam in seams}
    found: PaintedLoops = {}
    for cell, divided in zip(instance.cells, division, strict=True):
        subcells = whole_subcells(divided, virtual)
        block_of = {dart: number for number, sub in enumerate(subcells) for dart in sub.strands}
        colors = [sub.color for sub in subcells]
        for live in instance.live_loops[cell.id]:
            loop = [strand for dart in live for strand in strands_along(dart, strands)]
            own = {dart: block_of[dart] for dart in loop if dart in block_of}
            found.setdefault(cell.id, []).append(PaintedCell(loop, own, colors))
    return found


def unavoidable_join_on_loops(cells: PaintedLoops, joinable: Joinable) -> Strand | None:
    """Rule 5 loop by loop: an edge in state 0 that has to show one joinable color on both sides.

    A loop without darts in state 1 lies in one sub-cell of its cell, whichever suits, and all its
    darts show that color. Such loops are tried one after the other.
    """
    every = [loop for loops in cells.values() for loop in loops]
    settled = [loop for loop in every if loop.block_of]
    open_loops = [(loop, sorted(set(loop.colors))) for loop in every if not loop.block_of]
    open_loops.sort(key=lambda item: len(item[1]))
    found = unavoidable_join(settled, joinable)
    if found is not None or not open_loops:
        return found
    known = len(settled)
    trail = [iter(open_loops[0][1])]
    while trail:
        loop, _ = open_loops[len(trail) - 1]
        color = next(trail[-1], None)
        del settled[known + len(trail) - 1 :]  # the color before
        if color is None:
            trail.pop()
            continue
        settled.append(PaintedCell(loop.darts, {}, [color]))
        found = unavoidable_join(settled, joinable)
        if found is None and len(trail) == len(open_loops):
            return None
        if found is None:
            trail.append(iter(open_loops[len(trail)][1]))
    return found


def can_be_drawn(loops: Sequence[Sequence[int]]) -> bool:
    """Whether a planar cell can be divided into connected sub-cells that meet its loops like this.

    What is in nobody's way is drawn at once. If two loops are left that one sub-cell meets, the
    cell is cut open along a path in this sub-cell from the one to the other, which makes one loop
    of them. The sub-cell is then in two parts, and each of its other darts belongs to either: both
    are tried.

    Args:
        loops: for each loop of the cell the sub-cells of its darts in state 1, in cyclic order.
    """
    trail = [iter([[list(loop) for loop in loops]])]
    while trail:
        rest = next(trail[-1], None)
        if rest is None:
            trail.pop()
        elif rest := _reduced(rest):
            trail.append(_cut_open(rest))
        else:
            return True
    return False


def _cut_open(rest: list[list[int]]) -> Iterator[list[list[int]]]:
    """The loops with one less, for each way to part a sub-cell's darts; none if there is none."""
    where = {(label, number) for number, loop in enumerate(rest) for label in loop}
    on_loops = Counter(label for label, _ in where)
    shared = next((label for label, count in on_loops.items() if count > 1), None)
    if shared is None:
        return  # sub-cells that interleave on one loop
    one, other, *more = sorted(rest, key=lambda loop: shared not in loop)
    left, right = max(on_loops) + 1, max(on_loops) + 2
    merged = [left, *_after(one, shared), right, *_after(other, shared)]
    count = sum(loop.count(shared) for loop in [merged, *more])
    for chosen in product((left, right), repeat=count):
        sides = iter(chosen)
        yield [
            [next(sides) if label == shared else label for label in loop]
            for loop in [merged, *more]
        ]


def _after(loop: list[int], label: int) -> list[int]:
    """A loop without one dart of a sub-cell, from there on."""
    place = loop.index(label)
    return loop[place + 1 :] + loop[:place]


def _reduced(loops: list[list[int]]) -> list[list[int]]:
    """Without what can be drawn in any case, until nothing changes.

    Darts of one sub-cell that follow each other on a loop count as one. A sub-cell that has only
    one dart then, and a loop with only one sub-cell, are in nobody's way.
    """
    while True:
        merged = [
            [
                label
                for before, label in zip([loop[-1], *loop], loop, strict=False)
                if label != before
            ]
            or loop[:1]
            for loop in loops
            if loop
        ]
        counts = Counter(label for loop in merged for label in loop)
        kept = [[label for label in loop if counts[label] > 1] for loop in merged]
        kept = [loop for loop in kept if len(loop) > 1]
        if kept == loops:
            return kept
        loops = kept
