"""The closed surface that some cells make when their borders are filled with discs.

Each cell is cut open along seams from its first loop to its others, so that it is a polygon with
one list of darts. A curve is the set of the edges and seams that it crosses an odd number of times,
and all is counted modulo 2.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from cellcolor.checker.groups import Groups
from cellcolor.data.instance import OUTSIDE, Instance

__all__ = ["Domain", "FilledSurface"]

Corner = tuple[int, bool]
"""The corner before a dart, or after it."""

MOST_CLASSES = 1_000
"""With more classes of closed curves (two a handle) nothing is concluded."""


@dataclass(frozen=True, slots=True)
class Domain:
    """Where a segment can be: cells that a color connects.

    Attributes:
        color: the color.
        tree: the dart across which each cell is first reached, in that order; 0 at first.
        wall: of each other cell with darts, the component of what the domain is not.
    """

    color: int
    tree: Mapping[int, int]
    wall: Mapping[int, Corner]


class FilledSurface:
    """The cells as polygons, glued along the edges between them.

    Args:
        instance: the topological graph.
        cells: some of its cells.

    Attributes:
        polygons: the darts of each cell, its seams' among them.
    """

    def __init__(self, instance: Instance, cells: frozenset[int]) -> None:
        self._instance = instance
        self._last_edge = seam = max((edge.id for edge in instance.edges), default=0)
        self.polygons: dict[int, list[int]] = {}
        for cell in sorted(cells):
            first, *others = instance.cells[cell].loops or ((),)
            polygon = list(first)
            for loop in others:
                seam += 1
                polygon += [seam, *loop, -seam]
            self.polygons[cell] = polygon
        self._cell_of = {dart: cell for cell, darts in self.polygons.items() for dart in darts}

    @property
    def size(self) -> int:
        """How many darts all polygons have."""
        return len(self._cell_of)

    @cached_property
    def classes(self) -> Mapping[int, int] | None:
        """For each edge the closed curves along edges that it is part of, as bits of a number.

        These curves are a basis of the homology of the surface: a tree of polygons, a tree of
        corners beside it, and a curve for each edge that is in neither. So two closed curves
        across edges are homologous if they cross each of these equally often. On spheres there are
        none. None if there are too many.
        """
        polygons: Groups[int] = Groups()
        corners: Groups[Corner] = Groups()
        near: dict[Corner, list[tuple[Corner, int]]] = defaultdict(list)
        bits: dict[Corner, int] = defaultdict(int)
        labels: dict[int, int] = {}
        count = 0
        for edge, cell, beyond in self._inner:
            labels[edge] = 0
            if polygons.find(cell) != polygons.find(beyond):
                polygons.join(cell, beyond)
                continue
            ends = [self._places.find((edge, after)) for after in (False, True)]
            if corners.find(ends[0]) != corners.find(ends[1]):
                corners.join(*ends)
                near[ends[0]].append((ends[1], edge))
                near[ends[1]].append((ends[0], edge))
                continue
            if count == MOST_CLASSES:
                return None
            labels[edge] = 1 << count
            for end in ends:
                bits[end] ^= 1 << count
            count += 1
        seen: set[Corner] = set()
        for root in near:
            if root in seen:
                continue
            seen.add(root)
            order = [(root, root, 0)]
            for corner, _, _ in order:
                for other, edge in near[corner]:
                    if other not in seen:
                        seen.add(other)
                        order.append((other, corner, edge))
            for corner, above, edge in reversed(order[1:]):
                labels[edge] = bits[corner]
                bits[above] ^= bits[corner]
        return labels

    @property
    def is_spheres(self) -> bool:
        """Whether each component is a sphere."""
        return self.classes is not None and not any(self.classes.values())

    def domain(self, color: int, cells: frozenset[int], start: int) -> Domain:
        """What a color connects with a cell, among some cells."""
        tree = {start: 0}
        order = [start]
        for cell in order:
            for dart in self.polygons[cell]:
                beyond = self._cell_of.get(-dart, OUTSIDE)
                if beyond in cells and beyond not in tree and self._continues(color, dart):
                    tree[beyond] = dart
                    order.append(beyond)
        return Domain(color, tree, self._wall(color, tree))

    def way(self, domain: Domain, cell: int) -> set[int]:
        """The edges on the way in a domain's tree from its first cell to another."""
        edges = set()
        while dart := domain.tree[cell]:
            edges.add(abs(dart))
            cell = self._cell_of[dart]
        return edges

    def crossings(self, domain: Domain) -> Iterator[tuple[int, int, int]]:
        """The edges and seams within a domain, each with the cells on both sides."""
        for edge, cell, beyond in self._inner:
            if cell in domain.tree and beyond in domain.tree:
                if self._continues(domain.color, edge):
                    yield edge, cell, beyond

    def circles(self, domain: Domain) -> list[set[int]]:
        """Closed curves in a domain; every other one is homologous to a sum of some of them."""
        labels = self.classes
        if labels is None:
            raise ValueError("too many classes of closed curves")
        at: dict[int, int] = {}
        for cell, dart in domain.tree.items():
            at[cell] = at[self._cell_of[dart]] ^ labels[abs(dart)] if dart else 0
        reduced: dict[int, int] = {}
        found = []
        for edge, cell, beyond in self.crossings(domain):
            row = labels[edge] ^ at[cell] ^ at[beyond]
            while row and row.bit_length() in reduced:
                row ^= reduced[row.bit_length()]
            if row:
                reduced[row.bit_length()] = row
                found.append({edge} ^ self.way(domain, cell) ^ self.way(domain, beyond))
        return found

    def turns(self, crossed: Mapping[int, int]) -> dict[int, int]:
        """Which of some curves a way across each edge crosses oddly, as the bits of a number.

        The way leads from where the polygon on one side begins to where the other one does. On
        which side of a curve a place of a polygon's border is, is how often the curve crosses the
        border before it. The curve's crossings with the edge itself are before the way in one of
        the two polygons.

        Args:
            crossed: for each edge the curves that cross it oddly.
        """
        before: dict[int, int] = {}
        for polygon in self.polygons.values():
            passed = 0
            for dart in polygon:
                before[dart] = passed
                passed ^= crossed.get(abs(dart), 0)
        return {
            edge: before[edge] ^ before[-edge] ^ crossed.get(edge, 0) for edge, _, _ in self._inner
        }

    @cached_property
    def _inner(self) -> list[tuple[int, int, int]]:
        """The edges and seams that two polygons, or one and itself, are glued along."""
        cell_of = self._cell_of
        return [(d, cell_of[d], cell_of[-d]) for d in sorted(cell_of) if d > 0 and -d in cell_of]

    def _continues(self, color: int, dart: int) -> bool:
        """Whether a color goes on across a dart."""
        return abs(dart) > self._last_edge or color in self._instance.joinable(abs(dart))

    @cached_property
    def _places(self) -> Groups[Corner]:
        """Corners of the polygons that are one point, or lie on one border that a disc fills."""
        places: Groups[Corner] = Groups()
        for polygon in self.polygons.values():
            for dart, following in zip(polygon, polygon[1:] + polygon[:1], strict=True):
                places.join((dart, True), (following, False))
                # Where a dart begins on one side of the edge, its twin ends on the other.
                twin = -dart if -dart in self._cell_of else dart
                places.join((dart, False), (twin, True))
        return places

    def _wall(self, color: int, domain: Mapping[int, int]) -> dict[int, Corner]:
        """Of each cell outside a domain, the component of what the domain is not.

        That is the other cells, the edges across which the color does not continue, corners, discs.
        """
        wall: Groups[Corner] = Groups()
        for cell, polygon in self.polygons.items():
            for dart in polygon:
                before, after = (self._places.find((dart, end)) for end in (False, True))
                beyond = self._cell_of.get(-dart, OUTSIDE)
                if cell not in domain:
                    wall.join(before, self._places.find((polygon[0], False)))
                    wall.join(before, after)
                elif beyond not in domain or not self._continues(color, dart):
                    wall.join(before, after)
        return {
            cell: wall.find(self._places.find((polygon[0], False)))
            for cell, polygon in self.polygons.items()
            if polygon and cell not in domain
        }
