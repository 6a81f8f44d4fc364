"""Pairs of segments that would have to cross: lower bounds for any division of the surface.

The method looks at two color regions (``cover``) alone and merges their cells where nothing
separates them (``merged_surface``). A hub is a cell of all colors with a ring of one-colored cells,
the leaf cells. Around it, two leaf cells of one color that alternate with two of another are in
conflict: a segment that connects the first two separates the others. The proof is in
docs/bounds.md.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.union_find import UnionFind

MergedCell = frozenset[int]
"""The cells that a merged cell consists of; a segment touches it where it touches one of them."""

MOST_CIRCLES = 6
"""With more independent closed curves than this (three handles have six), nothing is concluded:
for k of them, 2^k sums have to be examined."""


@dataclass(frozen=True, slots=True)
class Separation:
    """What a segment of one color region does to those of another.

    A segment of one region that touches both ``ends``, merged cells of that region alone, divides
    merged cells of the other region alone into ``groups``, two or more: no segment of the other
    region touches two groups without crossing it, however often cutting paths cross the edges.
    """

    ends: tuple[MergedCell, MergedCell]
    groups: tuple[tuple[MergedCell, ...], ...]


class RegionPair:
    """The surface for two color regions: merged cells with one color, the other or both.

    The two colors differ. Apart from cracks, edges remain only between merged cells of one color
    and merged cells of both.

    Attributes:
        first: what segments of the first region do to those of the second; ``second`` the reverse.
        cells: the cells of each merged cell.
        loops: the live darts around each merged cell.
        sides: the merged cells to the left and to the right of each edge and of each seam. Seams
            connect the first loop of a merged cell to its others, so that it is a polygon.
        seams: the seams of each merged cell.
        before: the dart before each dart on its loop.
    """

    def __init__(self, instance: Instance, first: Region, second: Region) -> None:
        (color, near), (other, far) = first, second
        colors = dict.fromkeys(near - far, frozenset((color,)))
        colors |= dict.fromkeys(far - near, frozenset((other,)))
        colors |= dict.fromkeys(near & far, frozenset((color, other)))
        merged = merge_cells(instance, colors)
        self.merged_cell_of, self.loops = merged.merged_cell_of, merged.loops
        self.cells, self.sides = merged.cells(), dict(merged.sides)
        self.before: dict[int, int] = {}
        self.seams: dict[int, list[int]] = {}
        # The darts around each polygon, those of the seams among them, in cyclic order.
        self._polygons: dict[int, list[int]] = {}
        highest = max(self.sides, default=0)
        for merged_cell, loops in self.loops.items():
            self._polygons[merged_cell] = [*loops[0]] if loops else []
            self.seams[merged_cell] = []
            for loop in loops:
                self.before |= zip(loop[1:] + loop[:1], loop, strict=True)
            for loop in loops[1:]:
                highest += 1
                self._polygons[merged_cell] += [highest, *loop, -highest]
                self.sides[highest] = merged_cell, merged_cell
                self.seams[merged_cell].append(highest)
        ways = [{e for e, both in merged.joinable.items() if own in both} for own in (color, other)]
        alone = [sorted({self.merged_cell_of[c] for c in own}) for own in (near - far, far - near)]
        self.first = Side(self, alone[0], alone[1], ways[0], ways[1])
        self.second = Side(self, alone[1], alone[0], ways[1], ways[0])

    def borders(self) -> UnionFind[int]:
        """The border curves, each as the darts after which it runs."""
        borders: UnionFind[int] = UnionFind(self.before)
        for dart in self.before:
            # Where a dart ends, the border continues to what lies before the dart's other side.
            borders.union(dart, self.before[-dart])
        return borders

    def turns(self, curves: Iterable[set[int]]) -> dict[int, int]:
        """Which of some curves lie between the beginnings of two polygons with a common edge.

        Args:
            curves: each the edges and seams that it crosses an odd number of times.

        Returns:
            For each edge and seam the curves, as the bits of a number, that a way crosses an odd
            number of times which leads from where the polygon on the left begins, anywhere across
            the edge, to where the one on the right begins (docs/bounds.md, "The test").
        """
        crossed: dict[int, int] = {}
        for number, curve in enumerate(curves):
            for edge in curve:
                crossed[edge] = crossed.get(edge, 0) | 1 << number
        passed: dict[int, int] = {}
        for polygon in self._polygons.values():
            met = 0
            for dart in polygon:
                # As far as where the edge begins: that is where its other side ends.
                passed[dart] = met if dart > 0 else met ^ crossed.get(-dart, 0)
                met ^= crossed.get(abs(dart), 0)
        return {edge: passed[edge] ^ passed[-edge] for edge in self.sides}

    def independent(self, turns: Mapping[int, int]) -> list[int]:
        """A largest set of given closed curves of which no combination is homologous to zero.

        A curve is homologous to zero (modulo 2, borders filled with discs) if every closed curve
        crosses it an even number of times. It is enough to test the fundamental cycles of the graph
        of polygons. The curves are given by their :meth:`turns`.
        """
        tree = _spanning_tree(self.sides, self._polygons)
        passed: dict[int, int] = {}
        for polygon, (edge, nearer) in tree.items():
            passed[polygon] = passed[nearer] ^ turns[edge] if edge else 0
        used = {edge for edge, _ in tree.values()}
        reduced: dict[int, int] = {}
        for edge, (left, right) in self.sides.items():
            if edge in used:
                continue
            met = turns[edge] ^ passed[left] ^ passed[right]
            for bit, row in reduced.items():
                if met >> bit & 1:
                    met ^= row
            if met:
                reduced[met.bit_length() - 1] = met
        return list(reduced)


class Side:
    """What segments of one region do to those of the other.

    Args:
        merged_cells: those that belong to the one region and not to the other.
        parted: those that belong to the other region and not to the one.
        own: the edges across which the one region goes on.
        other: the same for the other region.
    """

    def __init__(
        self,
        surface: RegionPair,
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
            self._tree = _spanning_tree(self._own, merged_cells[:1])
            self._around = self._circles()
            if len(self._around) <= MOST_CIRCLES:
                self._wall = self._components(parted, other)

    def separations(self, near: int, far: int) -> list[Separation]:
        """What a segment that touches two merged cells of its own separates of the other region.

        Each component of the wall (docs/bounds.md) gives one, if the segment separates
        some of its merged cells.
        """
        if (near, far) not in self._known:
            reached = self._wall and {near, far} <= self._tree.keys()
            self._known[near, far] = self._separations(near, far) if reached else []
        return self._known[near, far]

    def _separations(self, near: int, far: int) -> list[Separation]:
        curves = [self._path(near) ^ self._path(far), *self._around]
        turns = self._surface.turns(curves)
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
            groups = [tuple(cells[m] for m in sorted(group)) for group in together.sets()]
            if len(groups) > 1:
                found.append(Separation((cells[near], cells[far]), tuple(groups)))
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
        turns = self._surface.turns(circles)
        return [circles[number] for number in self._surface.independent(turns)]

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
        """The merged cells of each component of the wall that has two or more.

        The wall is all that the one region cannot pass: the merged cells of the other region alone,
        every edge that is not joinable for the one, corners, and the border curves.
        """
        wall = self._surface.borders()
        for edge in other:
            wall.union(edge, self._surface.before[edge])
        loops = self._surface.loops
        found: dict[int, list[int]] = {}
        for merged_cell in parted:
            wall.union(*(dart for loop in loops[merged_cell] for dart in loop))
        for merged_cell in parted:
            if loops[merged_cell]:
                found.setdefault(wall[loops[merged_cell][0][0]], []).append(merged_cell)
        return [merged_cells for merged_cells in found.values() if len(merged_cells) > 1]


def _spanning_tree(
    sides: Mapping[int, tuple[int, int]], nodes: Iterable[int]
) -> dict[int, tuple[int, int]]:
    """A spanning forest: the edge to each node from its parent, and that; 0 and itself for a root.

    Args:
        sides: the two nodes of each edge.
        nodes: where to begin, one after the other, if not yet reached.
    """
    near: dict[int, list[tuple[int, int]]] = {}
    for edge, (left, right) in sides.items():
        near.setdefault(left, []).append((edge, right))
        near.setdefault(right, []).append((edge, left))
    tree: dict[int, tuple[int, int]] = {}
    for root in nodes:
        if root in tree:
            continue
        tree[root] = 0, root
        order = [root]
        for node in order:
            for edge, beyond in near.get(node, ()):
                if beyond not in tree:
                    tree[beyond] = edge, node
                    order.append(beyond)
    return tree
