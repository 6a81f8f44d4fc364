"""The same search with a bound beside the paper's cost: a set cover of the cells left.

No segment reaches beyond its **region**, the part of its color's domain that joinable edges
connect. So the segments still growing, and all to come, are at least as many as the fewest regions
that hold the growing ones and touch every unsolved cell. This cover is the search's own; the bounds
of the CP-SAT solver and the checker have theirs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.dfs.graph import Graph, GraphCell
from cellcolor.solvers.dfs.search import Painting, DepthFirstSearch


class CoverSearch(DepthFirstSearch):
    """The depth-first search in which a branch ends where a cover says so."""

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


def _bits(of: int) -> Iterator[int]:
    """The places of the bits of a number."""
    while of:
        bit = of & -of
        of ^= bit
        yield bit.bit_length() - 1


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
    for place in _bits(smallest):
        yield frozenset(s for s in sets if not s >> place & 1)
