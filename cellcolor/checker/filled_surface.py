"""The closed surface that some cells make when their borders are filled with discs.

Each cell is cut open along seams from its first loop to its others, so that it is a polygon with
one list of darts. A curve is the set of the edges and seams that it crosses an odd number of times,
and all is counted modulo 2.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance

Corner = tuple[int, bool]
"""The corner before a dart, or after it."""

WORK = 2_000
"""Darts that are walked over for what counts as one choice."""

MOST_CLASSES = 1_000
"""With more classes of closed curves (two a handle) nothing is concluded."""


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


class FilledSurface:
    """Cells as polygons, glued along the edges across which some color goes on.

    Args:
        rooms: where segments can be: each a color, and cells in which it is available.
        count: called with the amount of work about to be done; raises if that is too much.
    """

    def __init__(
        self,
        instance: Instance,
        rooms: Sequence[tuple[int, frozenset[int]]],
        count: Callable[[int], None],
    ) -> None:
        count(1 + sum(len(cells) for _, cells in rooms) // WORK)
        self._instance = instance
        self._count = count
        self._last_edge = seam = max((edge.id for edge in instance.edges), default=0)
        self.polygons: dict[int, list[int]] = {}
        for cell in sorted(frozenset[int]().union(*(cells for _, cells in rooms))):
            first, *others = instance.cells[cell].loops or ((),)
            polygon = list(first)
            for loop in others:
                seam += 1
                polygon += [seam, *loop, -seam]
            self.polygons[cell] = polygon
        self._cell_of = {dart: cell for cell, darts in self.polygons.items() for dart in darts}
        count(1 + len(rooms) * self.size // WORK)
        self._inner = [
            (dart, self._cell_of[dart], self._cell_of[-dart])
            for dart in sorted(self._cell_of)
            if dart > 0 and any(self._goes_on(dart, *room) for room in rooms)
        ]
        """The edges and seams that two polygons, or one and itself, are glued along."""
        self._glued = {edge for edge, _, _ in self._inner}

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
        self._count(1 + self.size // WORK)
        polygons: Groups[int] = Groups()
        corners: Groups[Corner] = Groups()
        near: dict[Corner, list[tuple[Corner, int]]] = defaultdict(list)
        bits: dict[Corner, int] = defaultdict(int)
        labels: dict[int, int] = {}
        number = 0
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
            if number == MOST_CLASSES:
                return None
            labels[edge] = 1 << number
            for end in ends:
                bits[end] ^= 1 << number
            number += 1
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

    def domain(self, color: int, cells: frozenset[int], start: int) -> Domain:
        """What a color connects with a cell, among the cells of a room."""
        self._count(1 + self.size // WORK)
        tree = {start: 0}
        order = [start]
        for cell in order:
            for dart in self.polygons[cell]:
                if self._goes_on(dart, color, cells) and self._cell_of[-dart] not in tree:
                    tree[self._cell_of[-dart]] = dart
                    order.append(self._cell_of[-dart])
        # What the color connects goes on across all edges within the room that it goes on across.
        crossings = [
            inner
            for inner in self._inner
            if inner[1] in tree and self._goes_on(inner[0], color, cells)
        ]
        return Domain(tree, self._wall(tree, {edge for edge, _, _ in crossings}), crossings)

    def way(self, domain: Domain, cell: int) -> set[int]:
        """The edges on the way in a domain's tree from its first cell to another."""
        edges = set()
        while dart := domain.tree[cell]:
            edges.add(abs(dart))
            cell = self._cell_of[dart]
        return edges

    def circles(self, domain: Domain, most: int) -> list[set[int]] | None:
        """Closed curves in a domain; every other one is homologous to a sum of some of them.

        None if there are more than ``most``, or too many classes of curves to tell.
        """
        labels = self.classes
        if labels is None:
            return None
        at: dict[int, int] = {}
        for cell, dart in domain.tree.items():
            at[cell] = at[self._cell_of[dart]] ^ labels[abs(dart)] if dart else 0
        reduced: dict[int, int] = {}
        found: list[set[int]] = []
        for edge, cell, beyond in domain.crossings:
            row = labels[edge] ^ at[cell] ^ at[beyond]
            while row and row.bit_length() in reduced:
                row ^= reduced[row.bit_length()]
            if row:
                if len(found) == most:
                    return None
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

    def _goes_on(self, dart: int, color: int, cells: frozenset[int]) -> bool:
        """Whether a color goes on across a dart from one of some cells to one of them."""
        beyond = self._cell_of.get(-dart, OUTSIDE)
        if self._cell_of[dart] not in cells or beyond not in cells:
            return False
        return abs(dart) > self._last_edge or color in self._instance.joinable(abs(dart))

    @cached_property
    def _places(self) -> Groups[Corner]:
        """Corners of the polygons that are one point, or lie on one border that a disc fills."""
        places: Groups[Corner] = Groups()
        for polygon in self.polygons.values():
            for dart, following in zip(polygon, polygon[1:] + polygon[:1], strict=True):
                places.join((dart, True), (following, False))
                # Where a dart begins on one side of the edge, its twin ends on the other.
                twin = -dart if abs(dart) in self._glued else dart
                places.join((dart, False), (twin, True))
        return places

    def _wall(self, domain: Mapping[int, int], crossed: set[int]) -> dict[int, Corner]:
        """For each cell outside a domain, its component of everything outside the domain.

        That is the other cells, the edges that are not crossed, corners, and discs.
        """
        wall: Groups[Corner] = Groups()
        for cell, polygon in self.polygons.items():
            for dart in polygon:
                before, after = (self._places.find((dart, end)) for end in (False, True))
                if cell not in domain:
                    wall.join(before, self._places.find((polygon[0], False)))
                if abs(dart) not in crossed:
                    wall.join(before, after)
        return {
            cell: wall.find(self._places.find((polygon[0], False)))
            for cell, polygon in self.polygons.items()
            if polygon and cell not in domain
        }
