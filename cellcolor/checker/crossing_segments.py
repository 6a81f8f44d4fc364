"""Verifies on the graph, by parity, that two segments would have to cross.

Suppose that two disjoint segments exist: P in color region A touches the cells u and u', which are
not in B; Q in color region B touches v and v', which are not in A. Take the closed surface that the
cells of A and B make when their borders are filled with discs (``filled_surface``). The **wall** is
all of it where B cannot be.

1. Choose any curve q in B from v to v'. Q contains a curve q' from v to v' as well. Together they
   make a closed curve in B. It is homologous to a sum c of cycles of B. There are finitely many
   such sums; on a sphere the only one is empty.
2. A closed curve in P and the wall does not meet Q. So it crosses q + c an even number of times.
3. Let w be a cell of A alone in u's component of the wall. P's way from u to w closes to a curve as
   in (2) by a way back through the wall, which crosses neither q nor c. So P's way from u to w has
   even parity: it crosses q + c an even number of times.
4. It is not known which sum c is. But if u' is in u's component of the wall, and for no c the color
   of A connects u with u' in even parity, then P and Q cannot be disjoint.

The test joins pairs (cell, parity) across the edges of A. By (3) it leaves out the pairs of a cell
in u's component of the wall with odd parity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

from cellcolor.checker.filled_surface import WORK, Domain, FilledSurface
from cellcolor.checker.groups import Groups
from cellcolor.data.instance import Instance

MOST_CIRCLES = 10
"""If a region has more independent closed curves, nothing is concluded: n of them have 2^n sums."""


@dataclass(frozen=True)
class TwoRegions:
    """Two color regions on the surface that their cells make.

    Attributes:
        count: called with the amount of work about to be done; raises if that is too much.
    """

    instance: Instance
    colors: tuple[int, int]
    cells: tuple[frozenset[int], frozenset[int]]
    count: Callable[[int], None]
    _known: dict[object, list[dict[int, int]]] = field(init=False, default_factory=dict)
    """The last result of ``_connected``."""

    def must_cross(self, one: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether it is proved that segments of the two regions would cross.

        Args:
            one: two cells of the first region alone; the first segment touches both.
            other: the same for the second segment.
        """
        first, second = self.cells
        if not set(one) <= first - second or not set(other) <= second - first:
            return False
        return self._parted(0, one, other) or self._parted(1, other, one)

    def _parted(self, side: int, pair: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether no segment of a side, 0 or 1, connects a pair of cells of its region beside a
        segment of the other region that connects two others.
        """
        own, theirs = self._domains[side], self._domains[1 - side]
        if not set(pair) <= own.tree.keys() or not set(other) <= theirs.tree.keys():
            return False
        # A cell without loops is a closed surface by itself and in no wall.
        walls = [theirs.wall.get(cell) for cell in pair]
        if None in walls or walls[0] != walls[1] or self._circles[1 - side] is None:
            return False
        key = side, other, walls[0]
        if key not in self._known:
            # A certificate lists all conflicts beside one curve in succession: keep one entry.
            self._known.clear()
            self._known[key] = self._connected(*key)
        return all(root[pair[0]] != root[pair[1]] for root in self._known[key])

    @cached_property
    def _surface(self) -> FilledSurface:
        rooms = list(zip(self.colors, self.cells, strict=True))
        return FilledSurface(self.instance, rooms, self.count)

    @cached_property
    def _domains(self) -> tuple[Domain, Domain]:
        """Where segments of the two regions can be."""
        first, second = (
            self._surface.domain(color, cells, min(cells))
            for color, cells in zip(self.colors, self.cells, strict=True)
        )
        return first, second

    @cached_property
    def _circles(self) -> tuple[list[set[int]] | None, list[set[int]] | None]:
        """Independent closed curves of each region; None if there are too many."""
        self.count(1 + 2 * self._surface.size // WORK)
        found = [self._surface.circles(domain, MOST_CIRCLES) for domain in self._domains]
        return found[0], found[1]

    def _connected(self, side: int, other: tuple[int, int], wall: object) -> list[dict[int, int]]:
        """Which cells in one component of the wall a side's color connects in even parity.

        The other region's segment connects two cells. For each sum of cycles of that region there
        is a dictionary that maps the component's cells to numbers, the same if they are connected.
        """
        own, theirs = self._domains[side], self._domains[1 - side]
        way = self._surface.way(theirs, other[0]) ^ self._surface.way(theirs, other[1])
        curves = [way, *(self._circles[1 - side] or ())]
        self.count(1 + (self._surface.size << len(curves)) // WORK)
        crossed: dict[int, int] = {}
        for number, curve in enumerate(curves):
            for edge in curve:
                crossed[edge] = crossed.get(edge, 0) | 1 << number
        turns = self._surface.turns(crossed)
        alone = [cell for cell in own.tree if theirs.wall.get(cell) == wall]
        shut = {2 * cell + 1 for cell in alone}
        found = []
        for chosen in range(1, 1 << len(curves), 2):
            together: Groups[int] = Groups()
            for edge, cell, beyond in own.crossings:
                turn = (turns[edge] & chosen).bit_count() % 2
                for near, far in (
                    (2 * cell, 2 * beyond + turn),
                    (2 * cell + 1, 2 * beyond + 1 - turn),
                ):
                    if near not in shut and far not in shut:
                        together.join(near, far)
            found.append({cell: together.find(2 * cell) for cell in alone})
        return found
