"""Two segments that would have to cross: verified on the graph, by parity.

Let P be a connected set in color region A that touches the cells u and u', and Q one in color
region B that touches v and v'; u and u' are not in B, v and v' not in A. Look at the cells of A and
B alone, each border of their union filled with a disc, and suppose that this is a sphere. Suppose
further that

1. v and v' lie in one component of what A is not: the cells that are not in A, the edges across
   which A's color does not continue, corners and discs;
2. u and u' lie in one component of what B is not.

Then all curves from u to u' in A cross all curves from v to v' in B equally often modulo 2. For let
p and p' be two of the former and q one of the latter. By (1) q can be closed without meeting A, and
two closed curves on a sphere cross evenly, so p and p' together cross q evenly. The same holds for
two curves in B, by (2). If that number is odd for one pair of curves, P and Q cannot be disjoint.

If it is even, there may be other cells w of A alone in the component of (2) that all curves from u
to w reach with an odd number. By the same argument P touches none of them. So P and Q cannot be
disjoint either if all curves from u to u' in A pass through such cells.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from cellcolor.checker.groups import Groups
from cellcolor.data.instance import OUTSIDE, Instance

__all__ = ["TwoRegions"]

Corner = tuple[int, bool]
"""The corner before a dart, or after it."""


@dataclass(frozen=True)
class TwoRegions:
    """Two color regions on the surface that their cells make.

    Attributes:
        instance: the topological graph.
        colors: the two colors.
        cells: the cells of each of the two color regions.
    """

    instance: Instance
    colors: tuple[int, int]
    cells: tuple[frozenset[int], frozenset[int]]

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
        if not all(self._lists[cell] for cell in (*one, *other)):
            return False  # a cell without loops is a surface by itself: nothing leads out of it
        walls = self._same_wall(other, 0) and self._same_wall(one, 1)
        if not walls or not self._on_a_sphere[one[0]]:
            return False
        return self._parted(0, one, other) or self._parted(1, other, one)

    def _parted(self, side: int, pair: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether a segment of one side cannot connect two cells beside one of the other side.

        Args:
            side: 0 or 1.
            pair: two cells of the side's region, to be connected.
            other: two cells of the other region, which the other segment connects.
        """
        theirs = self._way(1 - side, *other)
        if theirs is None:
            return False
        odd = self._oddly_reached(side, pair[0], theirs)
        alone = self.cells[side] - self.cells[1 - side]
        shut = {cell for cell in odd & alone if self._same_wall((pair[0], cell), 1 - side)}
        return bool(shut) and (
            pair[1] in shut or self._way(side, *pair, shut=frozenset(shut)) is None
        )

    @cached_property
    def _union(self) -> frozenset[int]:
        return self.cells[0] | self.cells[1]

    @cached_property
    def _lists(self) -> dict[int, list[int]]:
        """The darts of each cell, its loops one after the other.

        That is the border of the polygon that the cell is when it is cut open from the beginning of
        its first loop to those of the others; no curve here crosses such a cut.
        """
        return {
            cell: [dart for loop in self.instance.cells[cell].loops for dart in loop]
            for cell in self._union
        }

    def _beyond(self, dart: int) -> int:
        """The cell of the union on the other side of a dart, ``OUTSIDE`` if there is none."""
        edge = self.instance.edge(abs(dart))
        cell = edge.right if dart > 0 else edge.left
        return cell if cell in self._union else OUTSIDE

    @cached_property
    def _places(self) -> Groups[Corner]:
        """Corners of the cells that are one point, or lie on one border that a disc fills."""
        places: Groups[Corner] = Groups()
        for cell in self._union:
            for loop in self.instance.cells[cell].loops:
                for dart, following in zip(loop, loop[1:] + loop[:1], strict=True):
                    places.join((dart, True), (following, False))
                    if self._beyond(dart) == OUTSIDE:
                        places.join((dart, False), (dart, True))
                    else:
                        # Where a dart begins on one side of the edge, its twin ends on the other.
                        places.join((dart, False), (-dart, True))
        return places

    @cached_property
    def _on_a_sphere(self) -> dict[int, bool]:
        """Whether each cell's component, its borders filled with discs, is a sphere (Euler)."""
        spheres: dict[int, bool] = {}
        for cell in self._union:
            if cell in spheres:
                continue
            reached = [cell]
            spheres[cell] = False
            for place in reached:
                for dart in self._lists[place]:
                    beyond = self._beyond(dart)
                    if beyond != OUTSIDE and beyond not in spheres:
                        spheres[beyond] = False
                        reached.append(beyond)
            darts = [dart for own in reached for dart in self._lists[own]]
            points = {self._places.find((dart, False)) for dart in darts}
            edges = {abs(dart) for dart in darts if self._beyond(dart) != OUTSIDE}
            faces = sum(2 - len(self.instance.cells[own].loops) for own in reached)
            spheres |= dict.fromkeys(reached, len(points) - len(edges) + faces == 2)
        return spheres

    def _continues(self, side: int, dart: int) -> bool:
        """Whether a region goes on across a dart of one of its cells."""
        beyond, color = self._beyond(dart), self.colors[side]
        return beyond in self.cells[side] and color in self.instance.joinable(abs(dart))

    def _same_wall(self, pair: tuple[int, int], side: int) -> bool:
        """Whether two cells lie in one component of what a region is not."""
        wall = self._walls[side]
        one, other = (self._places.find((self._lists[cell][0], False)) for cell in pair)
        return wall.find(one) == wall.find(other)

    @cached_property
    def _walls(self) -> tuple[Groups[Corner], Groups[Corner]]:
        """Of each region what it is not, as groups of places."""
        return self._wall(0), self._wall(1)

    def _wall(self, side: int) -> Groups[Corner]:
        wall: Groups[Corner] = Groups()
        inside = self.cells[side]
        for cell in self._union:
            darts = self._lists[cell]
            for dart in darts:
                before, after = (self._places.find((dart, end)) for end in (False, True))
                if cell not in inside:
                    wall.join(before, self._places.find((darts[0], False)))
                if cell not in inside or not self._continues(side, dart):
                    wall.join(before, after)
        return wall

    def _way(
        self, side: int, start: int, end: int, shut: frozenset[int] = frozenset()
    ) -> list[int] | None:
        """Darts across which a curve leaves cell after cell, from one cell to another.

        None if there is no curve, or none that passes through no cell of ``shut``.
        """
        came = self._tree(side, start, shut)
        if end not in came:
            return None
        way: list[int] = []
        cell = end
        while cell != start:
            way.append(came[cell])
            cell = self._beyond(-came[cell])
        return way[::-1]

    def _tree(self, side: int, start: int, shut: frozenset[int] = frozenset()) -> dict[int, int]:
        """The dart across which each cell of a region is first reached, in that order; 0 at first.

        Cells of ``shut`` are not passed.
        """
        key = side, start, shut
        if key not in self._trees:
            came = self._trees[key] = {start: 0}
            todo = deque([start])
            while todo:
                for dart in self._lists[todo.popleft()]:
                    beyond = self._beyond(dart)
                    if beyond not in came and beyond not in shut and self._continues(side, dart):
                        came[beyond] = dart
                        todo.append(beyond)
        return self._trees[key]

    @cached_property
    def _trees(self) -> dict[tuple[int, int, frozenset[int]], dict[int, int]]:
        """What ``_tree`` has found."""
        return {}

    def _oddly_reached(self, side: int, start: int, theirs: Sequence[int]) -> set[int]:
        """The cells to which a side's ways in the tree from a cell cross a way of the other oddly.

        Ways are drawn as straight chords of the cells' polygons, and end in the middle of cells
        that the other side has not.
        """
        passed = {
            self._beyond(theirs[k]): (-theirs[k], theirs[k + 1]) for k in range(len(theirs) - 1)
        }
        came = self._tree(side, start)
        odd: set[int] = set()
        for cell, dart in came.items():
            before = self._beyond(-dart) if dart else start
            crossed = before in odd
            if before != start and before in passed:
                chord = (-came[before], dart)
                ways = (chord, passed[before])
                crossed ^= self._cross(before, *(ways if side == 0 else ways[::-1]))
            if crossed:
                odd.add(cell)
        return odd

    def _cross(self, cell: int, one: tuple[int, int], other: tuple[int, int]) -> bool:
        """Whether two chords of a cell's polygon cross, each from one dart to another."""
        place = self._number[cell]
        # Where both cross an edge, the first does so nearer to the edge's beginning.
        low, high = sorted(place[d] + (0.25 if d > 0 else 0.75) for d in one)
        between = [low < place[d] + (0.75 if d > 0 else 0.25) < high for d in other]
        return between[0] != between[1]

    @cached_property
    def _number(self) -> dict[int, dict[int, int]]:
        """Where each dart stands in its cell's list."""
        return {
            cell: {dart: number for number, dart in enumerate(darts)}
            for cell, darts in self._lists.items()
        }
