"""The iterative solver of the whole graph (paper, section V).

Depth first, cell by cell: each scheme of a cell that agrees with its solved neighbours is a
branch. The cost is that of the painting so far, carried along; a branch ends where the segments
it cannot lose any more exceed what is asked for. Of a complete painting the darts in state 0 are
tested (``zeros_fit``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, islice

from cellcolor.data.cells_and_edges import DartName, twin
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.dfs.cell_schemes import CellScheme, DartKnowledge, cell_schemes, zero_colors
from cellcolor.solvers.dfs.graph import GraphCell

_REMEMBERED = 5000
"""Longer lists of cell schemes are enumerated again each time, so that memory stays small."""


class Search:
    """The depth-first search of one connected part of the graph.

    Args:
        cells: the cells, in the order in which they are solved.
        region: the region of each (cell, color).
        costs: what a segment of each color costs; None for 1 each. With costs, budget, bound and
            what is yielded are of what the segments cost.

    Attributes:
        budget: the most segments a painting may have; lower it while the search runs to prune.
        bound: no painting has fewer segments.
    """

    def __init__(
        self,
        cells: Sequence[GraphCell],
        region: dict[tuple[int, int], int],
        deadline: Deadline,
        costs: Sequence[int] | None = None,
    ) -> None:
        self._cells = cells
        self._price = [1] * (max(region.values(), default=-1) + 1)
        if costs is not None:
            for (_, color), number in region.items():
                self._price[number] = costs[color]
        self._region = region
        self._deadline = deadline
        self._segments = SegmentCounts(self._price)
        self._memory: list[dict[tuple[DartKnowledge, ...], list[CellScheme]]] = [{} for _ in cells]
        self._covers: list[dict[int, int]] = [{} for _ in range(len(cells) + 1)]
        self._chosen: list[CellScheme] = []
        self._index_darts()
        self.budget = 0
        self.bound = self._first_bound()

    def _first_bound(self) -> int:
        """The size of a smallest cover; 1 if there is no time to find it."""
        try:
            return self._cover(0, 0)
        except OutOfTime as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            return 1

    def _index_darts(self) -> None:
        """Number the darts, and prepare what is looked up by their numbers."""
        number: dict[DartName, int] = {}
        depth_of: list[int] = []
        for depth, cell in enumerate(self._cells):
            for dart in cell.darts:
                number[dart] = len(number)
                depth_of.append(depth)
        self._numbers = [[number[dart] for dart in cell.darts] for cell in self._cells]
        self._twins = [[number[twin(dart)] for dart in cell.darts] for cell in self._cells]
        self._side: list[DartKnowledge] = [None] * len(number)
        """What each dart's other side learns; None as long as its cell is unsolved."""
        self._holder = [-1] * len(number)
        """The sub-cell of each dart in state 1 of the solved cells."""
        self._earlier = [[depth_of[t] < d for t in ts] for d, ts in enumerate(self._twins)]
        """Of each cell's darts, whether the other side's cell is solved before it."""
        self._frontier: list[list[int]] = [[]]
        """At each depth the darts of solved cells that face unsolved ones."""
        for depth in range(len(self._cells)):
            own = zip(self._numbers[depth], self._twins[depth], strict=True)
            kept = [d for d in self._frontier[-1] if d not in set(self._twins[depth])]
            self._frontier.append(kept + [d for d, t in own if depth_of[t] > depth])

    def paintings(self) -> Iterator[tuple[int, list[CellScheme]]]:
        """Every valid painting within the budget: its segments and the scheme of each cell.

        Raises:
            OutOfTime: the deadline has passed.
        """
        trail = [self._ways(0)]
        while trail:
            self._deadline.check()
            depth = len(trail)
            if not next(trail[-1], False):
                trail.pop()
            elif depth < len(self._cells):
                trail.append(self._ways(depth))
            elif self._bound(depth) <= self.budget and zeros_fit(self._cells, self._chosen):
                yield self._segments.cost, list(self._chosen)

    def _ways(self, depth: int) -> Iterator[bool]:
        """Solve a cell in every way within the budget, one after the other, and take it back."""
        bound = self._bound(depth)
        if bound > self.budget:
            return
        mark = self._segments.mark()
        for scheme in self._branches(depth):
            self._paint(depth, scheme)
            self._chosen.append(scheme)
            yield True
            self._chosen.pop()
            self._segments.undo(mark)
            if bound > self.budget:
                break
        for number in self._numbers[depth]:
            self._side[number] = None

    def _branches(self, depth: int) -> Iterable[CellScheme]:
        """The schemes of a cell under its solved neighbours, the least divided ones first."""
        known = tuple([self._side[t] for t in self._twins[depth]])
        remembered = self._memory[depth].get(known)
        if remembered is None:
            schemes = cell_schemes(self._cells[depth], known, self._deadline)
            remembered = list(islice(schemes, _REMEMBERED))
            if len(remembered) == _REMEMBERED:
                return chain(remembered, schemes)
            remembered.sort(key=_preference)
            self._memory[depth][known] = remembered
        return remembered

    def _paint(self, depth: int, scheme: CellScheme) -> None:
        """Solve a cell, and carry the cost along (section V-A).

        The cost rises by one for each sub-cell and falls by one for each distinct *segment* among
        its neighbours that it joins; the paper's rule counts distinct cells there instead.
        """
        cell, segments = self._cells[depth], self._segments
        numbers, twins, earlier = self._numbers[depth], self._twins[depth], self._earlier[depth]
        for number, side in zip(numbers, scheme.sides, strict=True):
            self._side[number] = side
        for color, darts in scheme.subcells:
            subcell = segments.add(self._region[cell.id, color])
            for i in darts:
                self._holder[numbers[i]] = subcell
        for _, darts in scheme.subcells:
            for i in darts:
                if earlier[i] or cell.partner[i] >= 0:
                    segments.join(self._holder[numbers[i]], self._holder[twins[i]])

    def _bound(self, depth: int) -> int:
        """A number of segments that every completion of the current painting has at least.

        Segments with no dart in state 1 towards an unsolved cell are complete. The others, and
        all to come, lie in regions that hold every segment still growing and touch every unsolved
        cell; they are at least as many as the fewest such regions.
        """
        segments = self._segments
        growing = set()
        for dart in self._frontier[depth]:
            side = self._side[dart]
            if side is not None and side[0] == 1:
                growing.add(segments.find(self._holder[dart]))
        held = cost = 0
        for subcell in growing:
            held |= 1 << segments.region[subcell]
            cost += self._price[segments.region[subcell]]
        return segments.cost - cost + self._cover(depth, held)

    def _cover(self, depth: int, held: int) -> int:
        """The least price of regions, those held (bits) among them, that touch all cells left."""
        known = self._covers[depth].get(held)
        if known is None:
            needed = []
            for cell in self._cells[depth:]:
                regions = 0
                for color in cell.colors:
                    regions |= 1 << self._region[cell.id, color]
                if not regions & held:
                    needed.append(regions)
            known = sum(self._price[region] for region in _bits(held))
            known += _hitting(frozenset(needed), self._price, self._deadline)
            self._covers[depth][held] = known
        return known


def _preference(scheme: CellScheme) -> tuple[int, int]:
    return len(scheme.subcells), sum(side is not None and side[0] == 0 for side in scheme.sides)


def _bits(of: int) -> Iterator[int]:
    """The places of the bits of a number."""
    while of:
        bit = of & -of
        of ^= bit
        yield bit.bit_length() - 1


def _hitting(sets: frozenset[int], price: Sequence[int], deadline: Deadline) -> int:
    """The least price of a hitting set, one bit or more of each bit set, by branch and bound."""
    best = sum(min(price[place] for place in _bits(one)) for one in sets)
    trail = [iter([(sets, 0)])]
    while trail:
        deadline.check()
        left, cost = next(trail[-1], (None, 0))
        if left is None:
            trail.pop()
        elif not left:
            best = min(best, cost)
        elif cost + 1 < best:
            trail.append(_hits(left, price, cost))
    return best


def _hits(
    sets: frozenset[int], price: Sequence[int], cost: int
) -> Iterator[tuple[frozenset[int], int]]:
    """For each bit of the smallest set, the sets that it does not hit, and the price so far."""
    sets = frozenset(s for s in sets if not any(t != s and t & s == t for t in sets))
    smallest = min(sets, key=lambda s: (s.bit_count(), s))
    for place in _bits(smallest):
        yield frozenset(s for s in sets if not s >> place & 1), cost + price[place]


class SegmentCounts:
    """Sub-cells joined into segments: a union-find whose last steps can be taken back.

    Attributes:
        cost: the paper's cost of the current painting, "the number of color segments in the
            current portion of the graph", where each costs 1.
        region: of each sub-cell, where its segment must stay.
    """

    def __init__(self, price: Sequence[int]) -> None:
        self._price = price
        self.cost = 0
        self.region: list[int] = []
        self._parent: list[int] = []
        self._size: list[int] = []
        self._joined: list[int] = []

    def add(self, region: int) -> int:
        """A new sub-cell, a segment of its own so far. Returns its number."""
        self.cost += self._price[region]
        self.region.append(region)
        self._parent.append(len(self._parent))
        self._size.append(1)
        return len(self._parent) - 1

    def find(self, subcell: int) -> int:
        """A sub-cell that stands for the whole segment."""
        parent = self._parent
        while parent[subcell] != subcell:
            subcell = parent[subcell]
        return subcell

    def join(self, a: int, b: int) -> None:
        """The painting continues from one sub-cell to the other; it may have done so before."""
        a, b = self.find(a), self.find(b)
        if a == b:
            return
        if self._size[a] < self._size[b]:
            a, b = b, a
        self._parent[b] = a
        self._size[a] += self._size[b]
        self._joined.append(b)
        self.cost -= self._price[self.region[b]]

    def mark(self) -> tuple[int, int]:
        """What :meth:`undo` comes back to."""
        return len(self._parent), len(self._joined)

    def undo(self, mark: tuple[int, int]) -> None:
        """Take back every step since the mark."""
        subcells, joined = mark
        while len(self._joined) > joined:
            child = self._joined.pop()
            self._size[self._parent[child]] -= self._size[child]
            self._parent[child] = child
            self.cost += self._price[self.region[child]]
        self.cost -= sum(self._price[region] for region in self.region[subcells:])
        del self._parent[subcells:], self._size[subcells:], self.region[subcells:]


Literal = int
"""``+n`` or ``-n``: variable n (from 1) is true, or false."""


def zeros_fit(cells: Sequence[GraphCell], schemes: Sequence[CellScheme]) -> bool:
    """Whether the runs of zeros can be divided so that no edge in state 0 could be joined.

    No live edge connects the cells to others.
    """
    clauses: list[tuple[Literal, Literal]] = []
    shows: dict[DartName, list[tuple[int, Literal]]] = {}
    variables = 0
    for cell, scheme in zip(cells, schemes, strict=True):
        painted = [side[1] if side and side[0] == 1 else None for side in scheme.sides]
        shown = zero_colors(painted, scheme.subcells[0][0])
        variable_at: dict[int, int] = {}
        for i, colors in enumerate(shown):
            if colors is None:
                continue
            before, after = colors
            if before == after:
                shows[cell.darts[i]] = [(before, 0)]
                continue
            variables += 1
            variable_at[i] = variables  # true: it lies in the sub-cell after the gap
            shows[cell.darts[i]] = [(before, -variables), (after, variables)]
        for i, variable in variable_at.items():
            following = variable_at.get((i + 1) % len(painted))
            if following is not None:  # once the run has changed sub-cells it stays there
                clauses.append((-variable, following))
    joinable = {d: j for cell in cells for d, j in zip(cell.darts, cell.joinable, strict=True)}
    for dart, choices in shows.items():
        for color, literal in choices:
            for other_color, other in shows[twin(dart)]:
                if color != other_color or color not in joinable[dart]:
                    continue
                if literal == 0 and other == 0:
                    return False
                clauses.append((-literal or -other, -other or -literal))
    return _satisfiable(variables, clauses)


def _satisfiable(variables: int, clauses: Sequence[tuple[Literal, Literal]]) -> bool:
    """2-SAT: what one value implies without contradiction can be kept for good."""
    implied: dict[Literal, list[Literal]] = {}
    for a, b in clauses:
        implied.setdefault(-a, []).append(b)
        implied.setdefault(-b, []).append(a)
    chosen: set[Literal] = set()
    for variable in range(1, variables + 1):
        if variable in chosen or -variable in chosen:
            continue
        for literal in (variable, -variable):
            reached = {literal}
            stack = [literal]
            while stack:
                for following in implied.get(stack.pop(), ()):
                    if following not in reached:
                        reached.add(following)
                        stack.append(following)
            if not any(-literal in reached for literal in reached):
                chosen |= reached
                break
        else:
            return False
    return True
