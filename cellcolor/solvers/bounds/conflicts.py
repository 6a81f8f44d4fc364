"""Pairs of segments that would have to cross: lower bounds for any division of the surface.

The method looks at two color regions (``cover``) alone and merges their cells where nothing
separates them (``merged_surface``). A hub is a cell of all colors with a ring of one-colored cells,
the leaf cells. Around it, two leaf cells of one color that alternate with two of another are in
conflict: a segment that connects the first two separates the others. The proof is in
docs/bounds.md.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import PolygonSurface, merge_cells, spanning_tree
from cellcolor.union_find import UnionFind

MergedCell = frozenset[int]
"""The cells that a merged cell consists of; a segment touches it where it touches one of them."""

MOST_CIRCLES = 6
"""With more independent closed curves than this (three handles have six), nothing is concluded:
for k of them, 2^k sums have to be examined."""


@dataclass(frozen=True, slots=True)
class Separation:
    """What a segment of one color region does to those of another.

    A segment of one region that touches both merged cells ``ends`` divides merged cells of the
    other region into ``groups``: no segment of the other region touches two merged cells of
    different groups without crossing the first, however often cutting paths cross the edges.

    Attributes:
        ends: two merged cells that belong to the one region and not to the other.
        groups: merged cells that belong to the other region and not to the one, two groups or more.
    """

    ends: tuple[MergedCell, MergedCell]
    groups: tuple[tuple[MergedCell, ...], ...]


class RegionPair:
    """The surface for two color regions: merged cells with one color, the other or both.

    The two colors differ. Cells of both colors are merged as far as both colors continue. So, apart
    from cracks, edges remain only between merged cells of one color and merged cells of both.

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
        surface = PolygonSurface(self._merged)
        ways = [
            {edge for edge, shared in self._merged.joinable.items() if own in shared}
            for own in (color, other)
        ]
        alone = [
            sorted({self._merged.merged_cell_of[cell] for cell in cells})
            for cells in (near - far, far - near)
        ]
        self.first = Side(surface, alone[0], alone[1], ways[0], ways[1])
        self.second = Side(surface, alone[1], alone[0], ways[1], ways[0])

    def merged_cell_of(self, cell: int) -> int:
        """The merged cell that a cell is part of; -1 for one of neither region."""
        return self._merged.merged_cell_of.get(cell, -1)


class Side:
    """What segments of one region do to those of the other.

    Attributes:
        merged_cells: the merged cells that belong to the one region and not to the other.

    Args:
        parted: the merged cells that belong to the other region and not to the one.
        own: the edges across which the one region goes on.
        other: the same for the other region.
    """

    def __init__(
        self,
        surface: PolygonSurface,
        merged_cells: list[int],
        parted: list[int],
        own: set[int],
        other: set[int],
    ) -> None:
        self.merged_cells = merged_cells
        self._surface = surface
        self._own = self._with_seams(own, set(parted))
        self._ways = sorted(self._with_seams(other, set(merged_cells)).items())
        self._wall: list[list[int]] = []
        self._around: list[set[int]] = []
        self._tree: dict[int, tuple[int, int]] = {}
        self._known: dict[tuple[int, int], list[Separation]] = {}
        if len(merged_cells) > 1 and len(parted) > 1:
            self._tree = spanning_tree(self._own, merged_cells[:1])
            self._around = self._circles()
            if len(self._around) <= MOST_CIRCLES:
                self._wall = self._components(parted, other)

    def separations(self, near: int, far: int) -> list[Separation]:
        """What a segment that touches two merged cells of its own separates of the other region.

        Each component of the wall (docs/bounds.md) gives one, if the segment separates
        some of its merged cells.
        """
        if not self._wall or not {near, far} <= self._tree.keys():
            return []
        if (near, far) not in self._known:
            self._known[near, far] = self._separations(near, far)
        return self._known[near, far]

    def _separations(self, near: int, far: int) -> list[Separation]:
        curves = [self._path(near) ^ self._path(far), *self._around]
        turns = self._turns(curves)
        cells = self._surface.cells
        found = []
        for merged_cells in self._wall:
            # The segment's own class is not known: what any class connects may be connected.
            together: UnionFind[int] = UnionFind(merged_cells)
            for chosen in range(1, 1 << len(curves), 2):
                connected = self._connected(set(merged_cells), turns, chosen)
                first: dict[int, int] = {}
                for merged_cell in merged_cells:
                    root = connected[2 * merged_cell]
                    together.union(merged_cell, first.setdefault(root, merged_cell))
            if len(groups := together.sets()) > 1:
                found.append(
                    Separation(
                        (cells[near], cells[far]),
                        tuple(tuple(cells[m] for m in sorted(group)) for group in groups),
                    )
                )
        return found

    def _with_seams(self, edges: set[int], without: set[int]) -> dict[int, tuple[int, int]]:
        """The sides of some edges, and of the seams of all merged cells but some."""
        surface = self._surface
        seams = [s for m, own in surface.seams.items() if m not in without for s in own]
        return {edge: surface.sides[edge] for edge in (*sorted(edges), *seams)}

    def _path(self, merged_cell: int) -> set[int]:
        """The edges on the way from the root of the one region's tree."""
        edges = set()
        edge, nearer = self._tree[merged_cell]
        while edge:
            edges.add(edge)
            edge, nearer = self._tree[nearer]
        return edges

    def _circles(self) -> list[set[int]]:
        """Closed curves of the one region in as many independent classes as it has.

        Classes are those of homology modulo 2 in the surface with its borders filled: there are
        none in a planar one. Each curve comes as the edges that it crosses.
        """
        used = {edge for edge, _ in self._tree.values()}
        circles = [
            {edge} ^ self._path(left) ^ self._path(right)
            for edge, (left, right) in self._own.items()
            if edge not in used and left in self._tree
        ]
        turns = self._turns(circles)
        return [circles[number] for number in self._surface.independent(turns)]

    def _turns(self, curves: Sequence[set[int]]) -> dict[int, int]:
        """Which of some curves a way crosses oddly over each edge, as the bits of a number."""
        crossed: dict[int, int] = {}
        for number, curve in enumerate(curves):
            for edge in curve:
                crossed[edge] = crossed.get(edge, 0) | 1 << number
        return self._surface.turns(crossed)

    def _connected(self, wall: set[int], turns: Mapping[int, int], chosen: int) -> UnionFind[int]:
        """What ways connect, each merged cell in either parity: its name twice, plus the parity.

        The parity of a way of the other region counts its crossings with the chosen curves of the
        one region. By the proof it meets all merged cells of the wall in one parity, here even.
        """
        connected: UnionFind[int] = UnionFind()
        for edge, (left, right) in self._ways:
            turn = (turns[edge] & chosen).bit_count() % 2
            for parity in (0, 1):
                across = parity ^ turn
                if (parity and left in wall) or (across and right in wall):
                    continue
                connected.union(2 * left + parity, 2 * right + across)
        return connected

    def _components(self, parted: list[int], other: set[int]) -> list[list[int]]:
        """The components of the wall that have two merged cells or more, each as its merged cells.

        The wall is all that the one region cannot pass: the merged cells of the other region alone,
        every edge that is not joinable for the one, corners, and the border curves.
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
        return [merged_cells for merged_cells in found.values() if len(merged_cells) > 1]
