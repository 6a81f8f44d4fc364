"""Pairs of segments that would have to cross: lower bounds for any division of the surface.

Two color regions (``cover``) are looked at by themselves, their cells merged where nothing
separates them (``merged_cells``). Around a hub, a cell of all colors with a ring of one-colored
cells, the petals, two petals of one color and two of another that follow in turn are in conflict:
whoever connects the first two parts the others. The proof is in docs/solver.md, "Conflicts".
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass
from itertools import combinations, product

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_cells import MergedCells, merge_cells
from cellcolor.union_find import UnionFind

__all__ = ["Conflict", "MergedCell", "Parting", "RegionPair", "Side", "conflicts"]

MergedCell = frozenset[int]
"""The cells that a merged cell consists of; a segment touches it where it touches one of them."""


@dataclass(frozen=True, slots=True)
class Parting:
    """What a segment of one color region does to those of another.

    A segment of the one region that touches both merged cells ``ends`` leaves merged cells of the
    other region in ``groups``: no segment of that one touches two merged cells of different groups
    without crossing the first, however often cutting paths cross the edges.

    Attributes:
        ends: two merged cells that belong to the one region and not to the other.
        groups: merged cells that belong to the other region and not to the one, two groups or more.
    """

    ends: tuple[MergedCell, MergedCell]
    groups: tuple[tuple[MergedCell, ...], ...]


@dataclass(frozen=True, slots=True)
class Conflict:
    """What two segments cannot do side by side.

    A segment in the first region that touches both merged cells ``one``, and a segment in the
    second that touches both merged cells ``other``, would cross each other, however often cutting
    paths cross the edges.

    Attributes:
        one: two merged cells that belong to the first region and not to the second.
        other: two merged cells that belong to the second region and not to the first.
    """

    one: tuple[MergedCell, MergedCell]
    other: tuple[MergedCell, MergedCell]


def conflicts(instance: Instance, first: Region, second: Region) -> list[Conflict]:
    """All that is known of what segments in two color regions cannot do side by side.

    All conflicts that are returned are true ones, but not all there are: none where the two
    regions together cover a handle.

    Args:
        instance: the topological graph.
        first: a color region.
        second: another one.
    """
    found: dict[frozenset[frozenset[MergedCell]], Conflict] = {}
    pair = RegionPair(instance, first, second)
    for side in (pair.first, pair.second):
        for near, far in combinations(side.merged_cells, 2):
            for parting in side.partings(near, far):
                for group, further in combinations(parting.groups, 2):
                    for merged_cells in product(group, further):
                        sides = (parting.ends, merged_cells)
                        conflict = Conflict(*(sides if side is pair.first else sides[::-1]))
                        found[frozenset(map(frozenset, sides))] = conflict
    return list(found.values())


class RegionPair:
    """The surface as two color regions see it: merged cells with one color, the other or both.

    Cells of both colors are merged as far as both colors can go on, so that apart from cracks edges
    are left between merged cells of one color and merged cells of both only.

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
            sorted({self._merged.merged_cell_of[cell] for cell in cells})
            for cells in (near - far, far - near)
        ]
        # An edge that merging left between two loops of one merged cell is a handle.
        usable = color != other and not ways[0] & ways[1] and surface.is_planar()
        self.first = Side(surface, alone[0], alone[1], ways[0], ways[1], usable)
        self.second = Side(surface, alone[1], alone[0], ways[1], ways[0], usable)

    def merged_cell_of(self, cell: int) -> int:
        """The merged cell that a cell is part of; -1 for one of neither region."""
        return self._merged.merged_cell_of.get(cell, -1)


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

    def merged_cell(self, dart: int) -> int:
        """The merged cell on whose border a dart is."""
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

        By Euler's formula: a merged cell with so many live loops, a sphere with holes, has the
        characteristic 2 - loops, each edge across which merged cells are glued lowers it by one,
        and with its border curves filled each component has to be a sphere, of characteristic 2.
        """
        component: UnionFind[int] = UnionFind(self.merged.loops)
        for left, right in self.merged.sides.values():
            component.union(left, right)
        characteristic: Counter[int] = Counter()
        for merged_cell, loops in self.merged.loops.items():
            if loops:
                characteristic[component[merged_cell]] += 2 - len(loops)
        for left, _ in self.merged.sides.values():
            characteristic[component[left]] -= 1
        borders = self.borders()
        for dart in {borders[dart]: dart for dart in self.following}.values():
            characteristic[component[self.merged_cell(dart)]] += 1
        return all(found == 2 for found in characteristic.values())


class Side:
    """What segments of one region do to those of the other.

    Attributes:
        merged_cells: the merged cells that belong to the one region and not to the other.
        parted: the merged cells that belong to the other region and not to the one.
    """

    def __init__(
        self,
        surface: _Surface,
        merged_cells: list[int],
        parted: list[int],
        own: set[int],
        other: set[int],
        usable: bool,
    ) -> None:
        self.merged_cells = merged_cells
        self.parted = parted
        self._surface = surface
        self._own = own
        self._number = {
            merged_cell: number for number, merged_cell in enumerate(surface.merged.loops)
        }
        self._ways = [
            (edge, *(self._number[merged_cell] for merged_cell in surface.merged.sides[edge]))
            for edge in sorted(other)
        ]
        self._wall: list[tuple[list[int], frozenset[int]]] = []
        self._trees: dict[int, dict[int, int]] = {}
        if usable and len(merged_cells) > 1 and len(parted) > 1:
            self._wall = self._components(parted, other)

    def partings(self, near: int, far: int) -> list[Parting]:
        """What a segment that touches two merged cells of its own region does to the other region.

        Args:
            near: a merged cell of the one region alone.
            far: another one.

        Returns:
            One for each component of the wall (docs/solver.md, "Conflicts") of whose merged cells
            some are parted; none at all if the two regions cover a handle.
        """
        if not self._wall or far not in self._tree(near):
            return []
        far_side, free = self._sides(near, far)
        cells = self._surface.cells
        found = []
        for merged_cells, numbers in self._wall:
            groups: dict[int, list[MergedCell]] = {}
            roots = self._reached(numbers, far_side, free)
            for merged_cell in merged_cells:
                groups.setdefault(roots[2 * self._number[merged_cell]], []).append(
                    cells[merged_cell]
                )
            if len(groups) > 1:
                found.append(Parting((cells[near], cells[far]), tuple(map(tuple, groups.values()))))
        return found

    def _reached(self, wall: frozenset[int], far_side: set[int], free: set[int]) -> list[int]:
        """For twice a merged cell's number, plus a parity, what of the kind is connected with it.

        Ways of the other region are followed, with the parity of their crossings with a curve of
        the one region; merged cells of the wall may be passed in even parity only.
        """
        # By hand rather than by networkx: this runs for every two merged cells of every two
        # regions, and is five times as quick.
        parent = list(range(2 * len(self._number)))

        def root(node: int) -> int:
            while parent[node] != node:
                parent[node] = parent[parent[node]]
                node = parent[node]
            return node

        for merged_cell in free:
            parent[2 * self._number[merged_cell] + 1] = 2 * self._number[merged_cell]
        for edge, left, right in self._ways:
            turn = (edge in far_side) ^ (-edge in far_side)
            for parity in (0, 1):
                across = parity ^ turn
                if (parity and left in wall) or (across and right in wall):
                    continue
                parent[root(2 * left + parity)] = root(2 * right + across)
        return [root(node) for node in range(len(parent))]

    def _sides(self, near: int, far: int) -> tuple[set[int], set[int]]:
        """How a curve from one merged cell to another cuts the merged cells that it passes through.

        Returns:
            The darts on the far side of the curve; and the merged cells in which it runs from one
            loop to another, so that both of its sides are connected within the merged cell.
        """
        surface, tree = self._surface, self._tree(near)
        beyond: set[int] = set()
        free: set[int] = set()
        merged_cell, left_by = far, 0
        while merged_cell != near:
            entered = tree[merged_cell]
            if left_by:
                if surface.loop_of[entered] == surface.loop_of[left_by]:
                    dart = surface.following[entered]
                    while dart != left_by:
                        beyond.add(dart)
                        dart = surface.following[dart]
                else:
                    free.add(merged_cell)
            left_by = -entered
            merged_cell = surface.merged_cell(left_by)
        return beyond, free

    def _tree(self, root: int) -> dict[int, int]:
        """Shortest ways of the one region: the dart by which each merged cell is entered, inside
        it."""
        if root not in self._trees:
            tree: dict[int, int] = {root: 0}
            queue = deque([root])
            while queue:
                for loop in self._surface.merged.loops[queue.popleft()]:
                    for dart in loop:
                        if abs(dart) in self._own:
                            beyond = self._surface.merged_cell(-dart)
                            if beyond not in tree:
                                tree[beyond] = -dart
                                queue.append(beyond)
            self._trees[root] = tree
        return self._trees[root]

    def _components(
        self, parted: list[int], other: set[int]
    ) -> list[tuple[list[int], frozenset[int]]]:
        """The components with two merged cells or more of all that the one region cannot pass.

        That is the merged cells of the other region alone, every edge that is not joinable for the
        one, corners, and the border curves. Each component comes as its merged cells and their
        numbers.
        """
        wall = self._surface.borders()
        for edge in other:
            wall.union(edge, self._surface.before[edge])
        loops = self._surface.merged.loops
        found: dict[int, list[int]] = {}
        for merged_cell in parted:
            wall.union(*(dart for loop in loops[merged_cell] for dart in loop))
        for merged_cell in parted:
            if loops[merged_cell]:
                found.setdefault(wall[loops[merged_cell][0][0]], []).append(merged_cell)
        return [
            (merged_cells, frozenset(self._number[merged_cell] for merged_cell in merged_cells))
            for merged_cells in found.values()
            if len(merged_cells) > 1
        ]
