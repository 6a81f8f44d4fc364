"""Two segments that would have to cross: verified on the graph, by parity.

Let Q be a connected set in color region B that touches the cells v and v', and P one in color
region A that touches u and u'; v and v' are not in A, u and u' not in B, and P and Q are disjoint.
Look at the surface that the cells of A and B make, their borders filled with discs
(``filled_surface``).

1. Let q be any curve in B from v to v'. Within Q there is one too. The two close to a curve in B,
   which is homologous to a sum c of cycles of B: one of finitely many, on a sphere none.
2. A closed curve in P and in what B is not does not meet Q, so that it crosses q + c evenly.
3. So P comes in even parity to all cells of A alone that are connected with u outside B: the
   way back to u in there crosses neither q nor c. "In even parity" is counted from u, by crossings
   with q + c.
4. If u' is one of these cells, and the color of A does not connect u and u' in this way for any c,
   P and Q cannot be disjoint.

A walk over pairs of a cell and a parity tells what is connected. It leaves out the cells of (3) in
odd parity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

from cellcolor.checker.filled_surface import WORK, Domain, FilledSurface
from cellcolor.checker.groups import Groups
from cellcolor.data.instance import Instance

MOST_CIRCLES = 10
"""With more independent closed curves in a region nothing is concluded: for n of them 2^n sums have
to be looked at."""


def _nothing(_choices: int) -> None:
    """Counts nothing."""


@dataclass(frozen=True)
class TwoRegions:
    """Two color regions on the surface that their cells make.

    Attributes:
        instance: the topological graph.
        colors: the two colors.
        cells: the cells of each of the two color regions.
        count: called with the amount of work about to be done; raises if that is too much.
    """

    instance: Instance
    colors: tuple[int, int]
    cells: tuple[frozenset[int], frozenset[int]]
    count: Callable[[int], None] = _nothing

    def must_cross(self, one: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether it is proved that segments of the two regions would cross.

        Args:
            one: two cells of the first region that are not in the second; the first segment
                touches both.
            other: two cells of the second region that are not in the first, for the second segment.
        """
        first, second = self.cells
        if not set(one) <= first - second or not set(other) <= second - first:
            return False
        return self._parted(0, one, other) or self._parted(1, other, one)

    def _parted(self, side: int, pair: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether a segment of one side cannot connect two cells beside one of the other side.

        Args:
            side: 0 or 1.
            pair: two cells of the side's region, to be connected.
            other: two cells of the other region, which the other segment connects.
        """
        own, theirs = self._domains[side], self._domains[1 - side]
        if not set(pair) <= own.tree.keys() or not set(other) <= theirs.tree.keys():
            return False
        # A cell without loops has no place in a wall: it is a surface by itself.
        walls = [theirs.wall.get(cell) for cell in pair]
        if None in walls or walls[0] != walls[1] or self._circles[1 - side] is None:
            return False
        key = side, other, walls[0]
        if key not in self._known:
            # A certificate names all conflicts beside one curve in turn.
            self._known.clear()
            self._known[key] = self._connected(*key)
        return all(root[pair[0]] != root[pair[1]] for root in self._known[key])

    @cached_property
    def _known(self) -> dict[tuple[int, tuple[int, int], object], list[dict[int, int]]]:
        """What ``_connected`` has found last."""
        return {}

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
        """Independent closed curves of both regions; None if they are too many."""
        self.count(1 + 2 * self._surface.size // WORK)
        found = [self._surface.circles(domain, MOST_CIRCLES) for domain in self._domains]
        return found[0], found[1]

    def _connected(self, side: int, other: tuple[int, int], wall: object) -> list[dict[int, int]]:
        """What a side's color connects in even parity, of the cells in one wall of the other side.

        There is one answer for each sum of cycles of the other side. Cells with the same number
        are connected.

        Args:
            side: 0 or 1.
            other: two cells of the other region, which the other segment connects.
            wall: a component of what the other region is not.
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
