"""Where segments can be that avoid some cells, and how often ways within such domains cross."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import MergedCells, PolygonSurface, spanning_tree
from cellcolor.union_find import UnionFind


@dataclass(frozen=True, slots=True)
class Domain:
    """Where a segment can be: merged cells that its color connects.

    Attributes:
        id: of the domain on its surface.
        tree: by which edge each merged cell of the domain is first reached, and from which one.
        number: of each of these merged cells, from 0.
        wall: for each other merged cell, its component outside the domain.
    """

    id: int
    tree: Mapping[int, tuple[int, int]]
    number: Mapping[int, int]
    wall: Mapping[int, int]


class Domains:
    """The domains of segments on one surface, and how often ways within them cross.

    Args:
        merged: its cells, merged where nothing separates them in the colors of the regions.
        regions: some color regions by their numbers, each as its color and its merged cells.
    """

    def __init__(self, merged: MergedCells, regions: Mapping[int, Region]) -> None:
        self.surface = PolygonSurface(merged)
        self._regions = regions
        self._connected: dict[tuple[int, frozenset[int]], dict[int, int]] = {}
        self._known: dict[tuple[int, frozenset[int], int], Domain] = {}
        self._odd: dict[tuple[int, int], dict[int, int]] = {}

    def domain(self, region: int, avoided: frozenset[int], start: int) -> Domain:
        """Where a segment can be that touches a merged cell of its region and not some others."""
        if (region, avoided) not in self._connected:
            self._connected[region, avoided] = self._components(region, avoided)
        connected = self._connected[region, avoided]
        key = region, avoided, connected[start]
        if key not in self._known:
            own = frozenset(c for c, root in connected.items() if root == connected[start])
            self._known[key] = self._domain(region, own)
        return self._known[key]

    def odd_crossings(self, one: Domain, other: Domain) -> dict[int, int]:
        """For each merged cell of a domain its way's odd crossings with those of another domain.

        They are the bits of a number, one for each merged cell of the first domain; the way leads
        to a merged cell of the second.
        """
        if (one.id, other.id) not in self._odd:
            crossed: dict[int, int] = {}
            for cell, number in one.number.items():
                while one.tree[cell][0]:
                    edge, cell = one.tree[cell]
                    crossed[edge] = crossed.get(edge, 0) | 1 << number
            turns = self.surface.turns(crossed)
            odd: dict[int, int] = {}
            # A tree's merged cells come in the order in which they are reached.
            for cell, (edge, nearer) in other.tree.items():
                odd[cell] = odd[nearer] ^ turns[edge] if edge else 0
            self._odd[one.id, other.id] = odd
        return self._odd[one.id, other.id]

    def _sides(self, region: int, own: frozenset[int]) -> dict[int, tuple[int, int]]:
        """The edges between some merged cells that are joinable in a region's color."""
        merged = self.surface.merged
        return {
            edge: ends
            for edge, ends in merged.sides.items()
            if self._regions[region][0] in merged.joinable[edge] and own.issuperset(ends)
        }

    def _components(self, region: int, avoided: frozenset[int]) -> dict[int, int]:
        """For each merged cell of a region one that stands for all that are connected with it."""
        own = self._regions[region][1] - avoided
        connected: UnionFind[int] = UnionFind(sorted(own))
        for ends in self._sides(region, own).values():
            connected.union(*ends)
        return {cell: connected[cell] for cell in sorted(own)}

    def _domain(self, region: int, own: frozenset[int]) -> Domain:
        merged = self.surface.merged
        sides = self._sides(region, own)
        tree = spanning_tree(sides, [min(own)])
        wall = self.surface.borders()
        for edge in merged.sides:
            if edge not in sides:
                wall.union(edge, self.surface.before[edge])
        beyond = {cell: loops for cell, loops in merged.loops.items() if loops and cell not in own}
        for loops in beyond.values():
            wall.union(*(dart for loop in loops for dart in loop))
        return Domain(
            len(self._known),
            tree,
            {cell: number for number, cell in enumerate(tree)},
            {cell: wall[loops[0][0]] for cell, loops in beyond.items()},
        )
