"""Pairs of segments that would have to cross: lower bounds for any division of the surface."""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass
from itertools import combinations, product

from networkx.utils import UnionFind

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_cells import MergedCells, merge_cells

__all__ = ["Area", "Conflict", "Parting", "RegionPair", "Side", "conflicts"]

Area = frozenset[int]
"""The cells of an area that a segment is to touch somewhere."""


@dataclass(frozen=True, slots=True)
class Parting:
    """What a segment of one color region does to those of another.

    A segment of the one region that touches both areas ``ends`` leaves areas of the other region
    in ``groups``: no segment of that one touches two areas of different groups without crossing
    the first, however often cutting paths cross the edges.

    Attributes:
        ends: two areas that belong to the one region and not to the other.
        groups: areas that belong to the other region and not to the one, two groups or more.
    """

    ends: tuple[Area, Area]
    groups: tuple[tuple[Area, ...], ...]


@dataclass(frozen=True, slots=True)
class Conflict:
    """What two segments cannot do side by side.

    A segment in the first region that touches both areas ``one``, and a segment in the second
    that touches both areas ``other``, would cross each other, however often cutting paths cross
    the edges.

    Attributes:
        one: two areas that belong to the first region and not to the second.
        other: two areas that belong to the second region and not to the first.
    """

    one: tuple[Area, Area]
    other: tuple[Area, Area]


def conflicts(instance: Instance, first: Region, second: Region) -> list[Conflict]:
    """All that is known of what segments in two color regions cannot do side by side.

    All conflicts that are returned are true ones, but not all there are: none where the two
    regions together cover a handle.

    Args:
        instance: the topological graph.
        first: a color region.
        second: another one.
    """
    found: dict[frozenset[frozenset[Area]], Conflict] = {}
    pair = RegionPair(instance, first, second)
    for side in (pair.first, pair.second):
        for near, far in combinations(side.areas, 2):
            for parting in side.partings(near, far):
                for group, further in combinations(parting.groups, 2):
                    for areas in product(group, further):
                        sides = (parting.ends, areas)
                        conflict = Conflict(*(sides if side is pair.first else sides[::-1]))
                        found[frozenset(map(frozenset, sides))] = conflict
    return list(found.values())


class RegionPair:
    """The surface as two color regions see it: areas with one color, the other or both.

    Areas of both colors are merged as far as both can go on, so that apart from cracks edges are
    left between areas of one color and areas of both only.

    Args:
        instance: the topological graph.
        first: a color region.
        second: another one.

    Attributes:
        first: what segments of the first region do to those of the second.
        second: what segments of the second region do to those of the first.
    """

    def __init__(self, instance: Instance, first: Region, second: Region) -> None:
        (color, near), (other, far) = first, second
        both = frozenset((color, other))
        colors = dict.fromkeys(near - far, frozenset((color,)))
        colors |= dict.fromkeys(far - near, frozenset((other,)))
        colors |= dict.fromkeys(near & far, both)
        self._merged = merge_cells(instance, colors)
        surface = _Surface(self._merged)
        ways = [
            {edge for edge, shared in self._merged.joinable.items() if own in shared}
            for own in (color, other)
        ]
        alone = [
            sorted({self._merged.part_of[cell] for cell in cells})
            for cells in (near - far, far - near)
        ]
        # An edge that merging left between two loops of one area is a handle.
        usable = color != other and not ways[0] & ways[1] and surface.is_planar()
        self.first = Side(surface, alone[0], alone[1], ways[0], ways[1], usable)
        self.second = Side(surface, alone[1], alone[0], ways[1], ways[0], usable)

    def area_of(self, cell: int) -> int:
        """The area that a cell is part of; -1 for one of neither region."""
        return self._merged.part_of.get(cell, -1)


class _Surface:
    """What two regions cover, and its borders."""

    def __init__(self, merged: MergedCells) -> None:
        self.merged = merged
        self.cells = merged.cells()
        self.following: dict[int, int] = {}
        self.loop_of: dict[int, int] = {}
        count = 0
        for loops in merged.loops.values():
            for loop in loops:
                self.following |= zip(loop, loop[1:] + loop[:1], strict=True)
                self.loop_of |= dict.fromkeys(loop, count)
                count += 1
        self.before = {following: dart for dart, following in self.following.items()}

    def area(self, dart: int) -> int:
        """The area on whose border a dart is."""
        left, right = self.merged.sides[abs(dart)]
        return left if dart > 0 else right

    def borders(self) -> UnionFind[int]:
        """The border curves, each as the darts after which it runs.

        Behind a dart, at the corner where it ends, the border goes on to what lies before the
        dart's other side.
        """
        borders: UnionFind[int] = UnionFind(self.following)
        for dart in self.following:
            borders.union(dart, self.before[-dart])
        return borders

    def is_planar(self) -> bool:
        """Whether every closed curve parts the component that it lies in.

        By Euler's formula: an area with so many live loops, a sphere with holes, has the
        characteristic 2 - loops, each edge across which areas are glued lowers it by one, and with
        its border curves filled each component has to be a sphere, of characteristic 2.
        """
        component: UnionFind[int] = UnionFind(self.merged.loops)
        for left, right in self.merged.sides.values():
            component.union(left, right)
        characteristic: Counter[int] = Counter()
        for area, loops in self.merged.loops.items():
            if loops:
                characteristic[component[area]] += 2 - len(loops)
        for left, _ in self.merged.sides.values():
            characteristic[component[left]] -= 1
        borders = self.borders()
        for dart in {borders[dart]: dart for dart in self.following}.values():
            characteristic[component[self.area(dart)]] += 1
        return all(found == 2 for found in characteristic.values())


class Side:
    """What segments of one region do to those of the other.

    Attributes:
        areas: the areas that belong to the one region and not to the other.
        parted: the areas that belong to the other region and not to the one.
    """

    def __init__(
        self,
        surface: _Surface,
        areas: list[int],
        parted: list[int],
        own: set[int],
        other: set[int],
        usable: bool,
    ) -> None:
        self.areas = areas
        self.parted = parted
        self._surface = surface
        self._own = own
        self._number = {area: number for number, area in enumerate(surface.merged.loops)}
        self._ways = [
            (edge, *(self._number[area] for area in surface.merged.sides[edge]))
            for edge in sorted(other)
        ]
        self._wall: list[tuple[list[int], frozenset[int]]] = []
        self._trees: dict[int, dict[int, int]] = {}
        if usable and len(areas) > 1 and len(parted) > 1:
            self._wall = self._components(parted, other)

    def partings(self, near: int, far: int) -> list[Parting]:
        """What a segment that touches two areas of its own region does to the other region.

        Args:
            near: an area of the one region alone.
            far: another one.

        Returns:
            One for each component of the wall (docs/solver.md, "Conflicts") of whose areas some
            are parted; none at all if the two regions cover a handle.
        """
        if not self._wall or far not in self._tree(near):
            return []
        far_side, free = self._sides(near, far)
        cells = self._surface.cells
        found = []
        for areas, numbers in self._wall:
            groups: dict[int, list[Area]] = {}
            roots = self._reached(numbers, far_side, free)
            for area in areas:
                groups.setdefault(roots[2 * self._number[area]], []).append(cells[area])
            if len(groups) > 1:
                found.append(Parting((cells[near], cells[far]), tuple(map(tuple, groups.values()))))
        return found

    def _reached(self, wall: frozenset[int], far_side: set[int], free: set[int]) -> list[int]:
        """For twice an area's number, plus a parity, what of the kind is connected with it.

        Ways of the other region are followed, with the parity of their crossings with a curve of
        the one region; areas of the wall may be passed in even parity only.
        """
        parent = list(range(2 * len(self._number)))

        def root(node: int) -> int:
            while parent[node] != node:
                parent[node] = parent[parent[node]]
                node = parent[node]
            return node

        for area in free:
            parent[2 * self._number[area] + 1] = 2 * self._number[area]
        for edge, left, right in self._ways:
            turn = (edge in far_side) ^ (-edge in far_side)
            for parity in (0, 1):
                across = parity ^ turn
                if (parity and left in wall) or (across and right in wall):
                    continue
                parent[root(2 * left + parity)] = root(2 * right + across)
        return [root(node) for node in range(len(parent))]

    def _sides(self, near: int, far: int) -> tuple[set[int], set[int]]:
        """How a curve from one area to another cuts the areas that it passes through.

        Returns:
            The darts on the far side of the curve; and the areas in which it runs from one loop to
            another, so that both of its sides are connected within the area.
        """
        surface, tree = self._surface, self._tree(near)
        beyond: set[int] = set()
        free: set[int] = set()
        area, left_by = far, 0
        while area != near:
            entered = tree[area]
            if left_by:
                if surface.loop_of[entered] == surface.loop_of[left_by]:
                    dart = surface.following[entered]
                    while dart != left_by:
                        beyond.add(dart)
                        dart = surface.following[dart]
                else:
                    free.add(area)
            left_by = -entered
            area = surface.area(left_by)
        return beyond, free

    def _tree(self, root: int) -> dict[int, int]:
        """Shortest ways of the one region: the dart by which each area is entered, inside it."""
        if root not in self._trees:
            tree: dict[int, int] = {root: 0}
            queue = deque([root])
            while queue:
                for loop in self._surface.merged.loops[queue.popleft()]:
                    for dart in loop:
                        if abs(dart) in self._own:
                            beyond = self._surface.area(-dart)
                            if beyond not in tree:
                                tree[beyond] = -dart
                                queue.append(beyond)
            self._trees[root] = tree
        return self._trees[root]

    def _components(
        self, parted: list[int], other: set[int]
    ) -> list[tuple[list[int], frozenset[int]]]:
        """The components with two areas or more of all that the one region cannot pass.

        That is the areas of the other region alone, every edge that is not joinable for the one,
        corners, and the border curves. Each component comes as its areas and their numbers.
        """
        wall = self._surface.borders()
        for edge in other:
            wall.union(edge, self._surface.before[edge])
        loops = self._surface.merged.loops
        found: dict[int, list[int]] = {}
        for area in parted:
            wall.union(*(dart for loop in loops[area] for dart in loop))
        for area in parted:
            if loops[area]:
                found.setdefault(wall[loops[area][0][0]], []).append(area)
        return [
            (areas, frozenset(self._number[area] for area in areas))
            for areas in found.values()
            if len(areas) > 1
        ]
