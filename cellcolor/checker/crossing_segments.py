"""Verifies on the graph, by parity, that two segments would have to cross.

Suppose that two disjoint segments exist: P in color region A touches the cells u and u', which are
not in B; Q in color region B touches v and v', which are not in A. The **wall** is all of the
surface, its borders filled with discs, where B cannot be. Choose any curve q in B from v to v'.
With one of finitely many sums c of cycles of B (on a sphere only the empty one), P's way between
two cells of A alone in one component of the wall crosses q + c an even number of times
(docs/bounds.md, "Conflicts"). It is not known which sum c is. But if u' is in u's component of the
wall, and for no c the color of A connects u with u' in even parity, P and Q cannot be disjoint.

The test joins pairs (cell, parity) across the edges of A. It leaves out the pairs of a cell in u's
component of the wall with odd parity.

Each cell is cut open along seams from its first loop to its others, so that it is a polygon with
one list of darts. A curve is the set of the edges and seams that it crosses an odd number of times,
and all is counted modulo 2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance

Corner = tuple[int, bool]
"""The corner before a dart, or after it."""

WORK = 2_000
"""Darts that are walked over for what counts as one choice."""

MOST_CIRCLES = 10
"""If a region has more independent closed curves, nothing is concluded: n of them have 2^n sums."""


@dataclass(frozen=True, slots=True)
class Domain:
    """Where a segment can be: cells that a color connects.

    Attributes:
        tree: the dart across which each cell is first reached, in that order; 0 at first.
        wall: of each other cell with darts, the component of what the domain is not.
        crossings: the edges and seams within it, each with the cells on both sides.
    """

    tree: Mapping[int, int]
    wall: Mapping[int, Corner]
    crossings: Sequence[tuple[int, int, int]]


class TwoRegions:
    """Two color regions on the surface that their cells make: polygons, glued along the edges
    across which one of the colors goes on.

    Args:
        count: called with the amount of work about to be done; raises if that is too much.
    """

    def __init__(
        self,
        instance: Instance,
        colors: tuple[int, int],
        cells: tuple[frozenset[int], frozenset[int]],
        count: Callable[[int], None],
    ) -> None:
        self._instance, self.cells, self._count = instance, cells, count
        count(1 + sum(map(len, cells)) // WORK)
        self._last_edge = seam = max((edge.id for edge in instance.edges), default=0)
        self._polygons: dict[int, list[int]] = {}
        for cell in sorted(cells[0] | cells[1]):
            first, *others = instance.cells[cell].loops or ((),)
            self._polygons[cell] = list(first)
            for loop in others:
                seam += 1
                self._polygons[cell] += [seam, *loop, -seam]
        self._cell_of = {dart: cell for cell, own in self._polygons.items() for dart in own}
        rooms = list(zip(colors, cells, strict=True))
        count(1 + len(rooms) * len(self._cell_of) // WORK)
        self._inner = [
            (dart, self._cell_of[dart], self._cell_of[-dart])
            for dart in sorted(self._cell_of)
            if dart > 0 and any(self._goes_on(dart, *room) for room in rooms)
        ]
        """The edges and seams that two polygons, or one and itself, are glued along."""
        self._places = self._glued_corners()
        self._domains = [self._domain(*room) for room in rooms]
        # The last result of ``_connected``: a certificate lists all conflicts beside one curve in
        # succession.
        self._key: object = None
        self._known: list[dict[int, int]] = []

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
        if None in walls or walls[0] != walls[1] or len(self._circles[1 - side]) > MOST_CIRCLES:
            return False
        key = side, other, walls[0]
        if key != self._key:
            self._known = self._connected(*key)
            self._key = key
        return all(root[pair[0]] != root[pair[1]] for root in self._known)

    def _connected(self, side: int, other: tuple[int, int], wall: object) -> list[dict[int, int]]:
        """Which cells in one component of the wall a side's color connects in even parity.

        For each sum of cycles of the other region, whose segment connects two cells, there is a
        number for each cell of the component, the same if they are connected.
        """
        own, theirs = self._domains[side], self._domains[1 - side]
        way = self._way(theirs, other[0]) ^ self._way(theirs, other[1])
        curves = [way, *self._circles[1 - side]]
        self._count(1 + (len(self._cell_of) << len(curves)) // WORK)
        turns = self._turns(curves)
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

    @cached_property
    def _circles(self) -> list[list[set[int]]]:
        """Closed curves of each region; every other one is homologous to a sum of some of them."""
        self._count(1 + 4 * len(self._cell_of) // WORK)
        return [self._independent(domain) for domain in self._domains]

    def _independent(self, domain: Domain) -> list[set[int]]:
        """A largest set of fundamental cycles of a domain no sum of which is homologous to zero.

        A closed curve is homologous to zero if every closed curve crosses it an even number of
        times; it is enough to look at the fundamental cycles of the whole surface.
        """
        used = {abs(dart) for dart in domain.tree.values()}
        circles = [
            {edge} ^ self._way(domain, cell) ^ self._way(domain, beyond)
            for edge, cell, beyond in domain.crossings
            if edge not in used
        ]
        turns = self._turns(circles)
        passed: dict[int, int] = {}
        for start in self._polygons:
            if start not in passed:
                tree = self._tree(start, lambda dart: abs(dart) in turns)
                for cell, dart in tree.items():
                    passed[cell] = passed[self._cell_of[dart]] ^ turns[abs(dart)] if dart else 0
        reduced: dict[int, int] = {}
        for edge, cell, beyond in self._inner:
            row = turns[edge] ^ passed[cell] ^ passed[beyond]
            while row and row.bit_length() in reduced:
                row ^= reduced[row.bit_length()]
            if row:
                reduced[row.bit_length()] = row
        return [circles[number - 1] for number in reduced]

    def _domain(self, color: int, cells: frozenset[int]) -> Domain:
        """What a color connects with the first of some cells, among these."""
        self._count(1 + len(self._cell_of) // WORK)
        tree = self._tree(min(cells), lambda dart: self._goes_on(dart, color, cells))
        # What the color connects goes on across all edges within the room that it goes on across.
        crossings = [
            inner
            for inner in self._inner
            if inner[1] in tree and self._goes_on(inner[0], color, cells)
        ]
        return Domain(tree, self._wall(tree, {edge for edge, _, _ in crossings}), crossings)

    def _tree(self, start: int, goes_on: Callable[[int], bool]) -> dict[int, int]:
        """The cells that some darts lead to, each with the dart across which it is reached."""
        tree = {start: 0}
        order = [start]
        for cell in order:
            for dart in self._polygons[cell]:
                if goes_on(dart) and self._cell_of[-dart] not in tree:
                    tree[self._cell_of[-dart]] = dart
                    order.append(self._cell_of[-dart])
        return tree

    def _way(self, domain: Domain, cell: int) -> set[int]:
        """The edges on the way in a domain's tree from its first cell to another."""
        edges = set()
        while dart := domain.tree[cell]:
            edges.add(abs(dart))
            cell = self._cell_of[dart]
        return edges

    def _turns(self, curves: Iterable[set[int]]) -> dict[int, int]:
        """Which of some curves a way across each edge crosses oddly, as the bits of a number.

        The way leads from where the polygon on one side begins to where the other one does. It
        crosses what crosses the two borders before the edge; crossings with the edge itself are
        before the way in one of the two polygons.
        """
        crossed: dict[int, int] = {}
        for number, curve in enumerate(curves):
            for edge in curve:
                crossed[edge] = crossed.get(edge, 0) | 1 << number
        before: dict[int, int] = {}
        for polygon in self._polygons.values():
            passed = 0
            for dart in polygon:
                before[dart] = passed
                passed ^= crossed.get(abs(dart), 0)
        return {
            edge: before[edge] ^ before[-edge] ^ crossed.get(edge, 0) for edge, _, _ in self._inner
        }

    def _goes_on(self, dart: int, color: int, cells: frozenset[int]) -> bool:
        """Whether a color goes on across a dart from one of some cells to one of them."""
        beyond = self._cell_of.get(-dart, OUTSIDE)
        if self._cell_of[dart] not in cells or beyond not in cells:
            return False
        return abs(dart) > self._last_edge or color in self._instance.joinable(abs(dart))

    def _glued_corners(self) -> Groups[Corner]:
        """Corners of the polygons that are one point, or lie on one border that a disc fills."""
        places: Groups[Corner] = Groups()
        glued = {edge for edge, _, _ in self._inner}
        for polygon in self._polygons.values():
            for dart, following in zip(polygon, polygon[1:] + polygon[:1], strict=True):
                places.join((dart, True), (following, False))
                # Where a dart begins on one side of the edge, its twin ends on the other.
                twin = -dart if abs(dart) in glued else dart
                places.join((dart, False), (twin, True))
        return places

    def _wall(self, domain: Mapping[int, int], crossed: set[int]) -> dict[int, Corner]:
        """For each cell outside a domain, its component of everything outside the domain.

        That is the other cells, the edges that are not crossed, corners, and discs.
        """
        wall: Groups[Corner] = Groups()
        for cell, polygon in self._polygons.items():
            for dart in polygon:
                before, after = (self._places.find((dart, end)) for end in (False, True))
                if cell not in domain:
                    wall.join(before, self._places.find((polygon[0], False)))
                if abs(dart) not in crossed:
                    wall.join(before, after)
        return {
            cell: wall.find(self._places.find((polygon[0], False)))
            for cell, polygon in self._polygons.items()
            if polygon and cell not in domain
        }
