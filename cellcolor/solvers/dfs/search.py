"""The iterative solver of the whole graph (paper, section V).

Depth first, cell by cell: each scheme of a cell that agrees with its solved neighbors is a branch,
and the cost is carried along (section V-A). The paper does not say what ends a branch early. The
cost so far alone cannot: a later cell that joins j segments changes it by 1 - j. Here a branch ends
where the part of the cost that no later cell can take back exceeds what is asked for.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain

from cellcolor.data.cells_and_edges import DartName, twin
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.dfs.cell_schemes import CellScheme, Side, cell_schemes, zero_colors
from cellcolor.solvers.dfs.graph import Graph, GraphCell

Segment = tuple[int, DartName]
"""Its color, and one of its darts, which no other segment has."""

Literal = int
"""``+n`` or ``-n``: zero n (from 1) shows the color of the sub-cell after it, or of that before."""


@dataclass(frozen=True, slots=True)
class Painting:
    """A graph whose first cells are solved.

    Attributes:
        schemes: of the solved cells.
        cost: "the number of color segments in the current portion of the graph".
        sides: what is shown at each dart that faces an unsolved cell.
        growing: the segment of each of these that is in state 1.
    """

    schemes: tuple[CellScheme, ...] = ()
    cost: int = 0
    sides: dict[DartName, Side] = field(default_factory=dict)
    growing: dict[DartName, Segment] = field(default_factory=dict)


class DepthFirstSearch:
    """The depth-first search of one connected part of the graph.

    Args:
        cells: those of the part, in the order in which they are solved.

    Attributes:
        budget: the most that a painting may cost; lower it while the search runs to prune.
    """

    def __init__(self, graph: Graph, cells: Sequence[GraphCell], deadline: Deadline) -> None:
        self.graph, self.cells, self.deadline = graph, cells, deadline
        self.budget: float = math.inf

    def paintings(self) -> Iterator[Painting]:
        """Every complete painting within the budget."""
        trail = [(0, iter([Painting()]))]
        while trail:
            self.deadline.check()
            least, branches = trail[-1]
            painting = next(branches, None) if least <= self.budget else None
            if painting is None:
                trail.pop()
            elif (least := self.least(painting)) > self.budget:
                continue
            elif len(painting.schemes) < len(self.cells):
                trail.append((least, self.branches(painting)))
            elif zeros_fit(self.cells, painting.schemes):
                yield painting

    def least(self, painting: Painting) -> int:
        """No completion of the painting costs less.

        Segments that cannot continue into an unsolved cell are complete. Of the others, at best
        all of one color will be joined.
        """
        growing = set(painting.growing.values())
        if not growing:
            return painting.cost + (len(painting.schemes) < len(self.cells))
        return painting.cost - len(growing) + len({color for color, _ in growing})

    def branches(self, painting: Painting) -> Iterator[Painting]:
        """The next cell solved in every way."""
        cell = self.cells[len(painting.schemes)]
        known = [painting.sides.get(dart) for dart in cell.twins]
        for scheme in cell_schemes(cell, known, self.deadline):
            yield self._solved(painting, cell, scheme)

    def _solved(self, before: Painting, cell: GraphCell, scheme: CellScheme) -> Painting:
        """The painting with one cell more, and Δcost = 1 - j for each of its sub-cells.

        Of the neighbors that a sub-cell joins, j counts the distinct *segments*; the paper's rule
        counts distinct cells (docs/paper.md, Errata).
        """
        cost, growing = before.cost, dict(before.growing)
        for color, darts in scheme.subcells:
            joined = {growing[t] for i in darts if (t := cell.twins[i]) in growing}
            cost += 1 - len(joined)
            if darts:
                segment = color, cell.darts[darts[0]]
                growing |= {dart: segment for dart, own in growing.items() if own in joined}
                growing |= {cell.darts[i]: segment for i in darts}
        sides = before.sides | dict(zip(cell.darts, scheme.sides, strict=True))
        inner = [pair for pair in zip(cell.darts, cell.twins, strict=True) if pair[1] in sides]
        for dart in chain.from_iterable(inner):  # both sides of these edges are solved
            sides.pop(dart, None)
            growing.pop(dart, None)
        return Painting((*before.schemes, scheme), cost, sides, growing)


def zeros_fit(cells: Sequence[GraphCell], schemes: Sequence[CellScheme]) -> bool:
    """Whether the runs of zeros can be divided so that no edge in state 0 could be joined (rule 5).

    "The 0s can be freely moved outside the bracket" (paper, section IV-C).

    No live edge connects the cells to others.
    """
    clauses: list[tuple[Literal, Literal]] = []
    shows: dict[DartName, tuple[tuple[int, Literal], tuple[int, Literal]]] = {}
    joinable: dict[DartName, frozenset[int]] = {}
    for cell, scheme in zip(cells, schemes, strict=True):
        joinable |= zip(cell.darts, cell.joinable, strict=True)
        painted = [color if state == 1 else None for state, color in scheme.sides]
        zero_at: dict[int, int] = {}
        for i, (before, after) in enumerate(zero_colors(painted, scheme.subcells[0][0])):
            if painted[i] is None:
                zero_at[i] = zero = len(shows) + 1
                shows[cell.darts[i]] = (before, -zero), (after, zero)
        for i, zero in zero_at.items():
            following = zero_at.get((i + 1) % len(painted))
            if following is not None:  # once the run has changed sub-cells it stays there
                clauses.append((-zero, following))
    for dart, choices in shows.items():
        for color, literal in choices:
            for other_color, other in shows[twin(dart)]:
                if color == other_color and color in joinable[dart]:
                    clauses.append((-literal, -other))
    return _satisfiable(len(shows), clauses)


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


class CoverSearch(DepthFirstSearch):
    """The same search in which a branch ends where a set cover of the cells left says so.

    No segment reaches beyond its **region**, the part of its color's domain that joinable edges
    connect. So the segments still growing, and all to come, are at least as many as the fewest
    regions that hold the growing ones and touch every unsolved cell. This cover is the search's
    own; the bounds of the CP-SAT solver and the checker have theirs.
    """

    def __init__(self, graph: Graph, cells: Sequence[GraphCell], deadline: Deadline) -> None:
        super().__init__(graph, cells, deadline)
        self._region = _regions(graph.instance, [cell.id for cell in cells])
        self._cell_of = {dart: cell.id for cell in cells for dart in cell.darts}
        self._covers: dict[tuple[int, int], int] = {}

    def least(self, painting: Painting) -> int:
        growing, held = set(painting.growing.values()), 0
        for color, dart in growing:
            held |= 1 << self._region[self._cell_of[dart], color]
        return painting.cost - len(growing) + self._cover(len(painting.schemes), held)

    def _cover(self, depth: int, held: int) -> int:
        """The fewest regions, those held (bits) among them, that touch all cells left."""
        if (depth, held) not in self._covers:
            touching = (
                sum(1 << self._region[cell.id, color] for color in cell.colors)
                for cell in self.cells[depth:]
            )
            needed = frozenset(regions for regions in touching if not regions & held)
            self._covers[depth, held] = held.bit_count() + _hitting(needed, self.deadline)
        return self._covers[depth, held]


def _regions(instance: Instance, part: Sequence[int]) -> dict[tuple[int, int], int]:
    """The number of the region of each (cell, color) of a connected part of the graph."""
    region: dict[tuple[int, int], int] = {}
    starts = [(cell, color) for cell in part for color in instance.cells[cell].colors]
    for number, (start, color) in enumerate(starts):
        stack = [start]
        while stack:
            cell = stack.pop()
            if (cell, color) not in region:
                region[cell, color] = number
                darts = (dart for loop in instance.live_loops[cell] for dart in loop)
                stack += [instance.across(d) for d in darts if color in instance.joinable(d)]
    return region


def _hitting(sets: frozenset[int], deadline: Deadline) -> int:
    """The size of a smallest hitting set, one bit or more of each bit set, by branch and bound."""
    best = len(sets)
    trail = [iter([sets])]
    while trail:
        deadline.check()
        left = next(trail[-1], None)
        if left is None:
            trail.pop()
        elif not left:
            best = min(best, len(trail) - 1)
        elif len(trail) < best:
            trail.append(_hits(left))
    return best


def _hits(sets: frozenset[int]) -> Iterator[frozenset[int]]:
    """For each bit of the smallest set, the sets that it does not hit."""
    sets = frozenset(s for s in sets if not any(t != s and t & s == t for t in sets))
    smallest = min(sets, key=lambda s: (s.bit_count(), s))
    for place in range(smallest.bit_length()):
        if smallest >> place & 1:
            yield frozenset(s for s in sets if not s >> place & 1)
