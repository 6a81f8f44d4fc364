"""Fewer and larger cells for lower bounds: cells merged where nothing separates them, as polygons.

The polygons are glued along edges; curves on the surface are compared up to homology.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.union_find import UnionFind


@dataclass(frozen=True, slots=True)
class MergedCells:
    """Cells merged where nothing separates them, each under the id of one of its parts.

    Attributes:
        loops: the live darts around each merged cell.
        sides: the merged cells to the left and to the right of each remaining edge.
        joinable: the joinable colors of each remaining edge.
        merged_cell_of: the merged cell of each cell.
    """

    loops: dict[int, list[list[int]]]
    sides: dict[int, tuple[int, int]]
    joinable: dict[int, frozenset[int]]
    merged_cell_of: dict[int, int]

    def cells(self) -> dict[int, frozenset[int]]:
        """The cells that each merged cell consists of."""
        members: dict[int, list[int]] = {}
        for cell, merged_cell in self.merged_cell_of.items():
            members.setdefault(merged_cell, []).append(cell)
        return {merged_cell: frozenset(cells) for merged_cell, cells in members.items()}


def merge_cells(instance: Instance, colors: Mapping[int, frozenset[int]]) -> MergedCells:
    """Merge neighboring cells where nothing separates them.

    Two cells with the same set of colors, and an edge between them that is joinable for the whole
    set, are one area in which any division can be drawn, so the edge is removed. An edge with one
    merged cell on both sides is removed as well, which may leave a hole. An edge between two loops
    of one merged cell stays, because it is a handle. Dead darts are left out.

    Args:
        colors: the colors that each cell may be painted in, of the cells that are looked at.
    """
    loops = {cell: [list(loop) for loop in instance.cells[cell].loops] for cell in colors}
    sides: dict[int, tuple[int, int]] = {}
    joinable: dict[int, frozenset[int]] = {}
    for edge_id in {abs(dart) for own in loops.values() for loop in own for dart in loop}:
        edge = instance.edge(edge_id)
        sides[edge_id] = edge.left, edge.right
        joinable[edge_id] = frozenset(instance.joinable(edge_id))
    return _merged(MergedCells(loops, sides, joinable, {}), colors)


def _merged(merged: MergedCells, colors: Mapping[int, frozenset[int]]) -> MergedCells:
    sides = merged.sides
    none = frozenset[int]()
    live: dict[int, frozenset[int]] = {}
    rings = _Rings()
    for cell in colors:
        for loop in merged.loops[cell]:
            kept: list[int] = []
            for dart in loop:
                edge = abs(dart)
                if edge not in live:
                    left, right = sides[edge]
                    live[edge] = (
                        merged.joinable[edge] & colors.get(left, none) & colors.get(right, none)
                    )
                if live[edge]:
                    kept.append(dart)
            rings.add(kept)
    live = {edge: shared for edge, shared in live.items() if shared}
    names: UnionFind[int] = UnionFind(colors)
    for edge in sorted(live):
        left, right = sides[edge]
        if colors[left] != live[edge] or colors[right] != live[edge]:
            continue
        if names[left] == names[right] and not rings.same(edge, -edge):
            continue  # two loops of one cell: a handle, and without the edge it was not planar
        names.union(left, right)
        rings.remove(edge)
        del live[edge]
    merged_cell_of = {cell: names[cell] for cell in colors}
    found: dict[int, list[list[int]]] = {name: [] for name in merged_cell_of.values()}
    ends = {edge: (merged_cell_of[sides[edge][0]], merged_cell_of[sides[edge][1]]) for edge in live}
    for darts in rings.loops():
        left, right = ends[abs(darts[0])]
        found[left if darts[0] > 0 else right].append(darts)
    return MergedCells(found, ends, live, merged_cell_of)


class _Rings:
    """Loops of darts from which edges are taken out, one after the other."""

    def __init__(self) -> None:
        self._next: dict[int, int] = {}
        self._before: dict[int, int] = {}

    def add(self, loop: list[int]) -> None:
        for dart, following in zip(loop, loop[1:] + loop[:1], strict=True):
            self._link(dart, following)

    def same(self, one: int, other: int) -> bool:
        """Whether two darts are on one loop; walks both ways at a time, as far as the nearer."""
        ahead, behind = self._next[one], self._before[one]
        while ahead != one and behind != one:
            if other in (ahead, behind):
                return True
            ahead, behind = self._next[ahead], self._before[behind]
        return False

    def remove(self, edge: int) -> None:
        """Open an edge: two loops become one, or a loop walked on both of its sides two."""
        for dart in (edge, -edge):
            # Where a walk came to the edge it goes on behind the other side.
            self._link(self._before[dart], self._next[-dart])
        for dart in (edge, -edge):
            del self._next[dart], self._before[dart]

    def loops(self) -> list[list[int]]:
        found = []
        seen: set[int] = set()
        for first in self._next:
            if first in seen:
                continue
            loop = [first]
            while self._next[loop[-1]] != first:
                loop.append(self._next[loop[-1]])
            seen.update(loop)
            found.append(loop)
        return found

    def _link(self, one: int, following: int) -> None:
        self._next[one] = following
        self._before[following] = one


class PolygonSurface:
    """What two regions cover, and its borders.

    Attributes:
        polygons: each merged cell cut open along seams, which connect its first loop to its others:
            the darts around it, those of the seams among them, in cyclic order.
        sides: the merged cells to the left and to the right of each edge and of each seam.
        seams: the seams of each merged cell.
    """

    def __init__(self, merged: MergedCells) -> None:
        self.merged = merged
        self.cells = merged.cells()
        self.before: dict[int, int] = {}
        self.polygons: dict[int, list[int]] = {}
        self.sides = dict(merged.sides)
        self.seams: dict[int, list[int]] = {}
        highest = max(self.sides, default=0)
        for merged_cell, loops in merged.loops.items():
            self.polygons[merged_cell] = [*loops[0]] if loops else []
            self.seams[merged_cell] = []
            for loop in loops:
                self.before |= zip(loop[1:] + loop[:1], loop, strict=True)
            for loop in loops[1:]:
                highest += 1
                self.polygons[merged_cell] += [highest, *loop, -highest]
                self.sides[highest] = merged_cell, merged_cell
                self.seams[merged_cell].append(highest)
        self._borders: UnionFind[int] = UnionFind(self.before)
        for dart in self.before:
            # Where a dart ends, the border continues to what lies before the dart's other side.
            self._borders.union(dart, self.before[-dart])

    def borders(self) -> UnionFind[int]:
        """The border curves, each as the darts after which it runs."""
        return self._borders.copy()

    def turns(self, crossed: Mapping[int, int]) -> dict[int, int]:
        """Which of some curves lie between the beginnings of two polygons with a common edge.

        Args:
            crossed: for each edge and seam the curves that cross it an odd number of times, as the
                bits of a number.

        Returns:
            For each edge and seam the curves that a way crosses an odd number of times which leads
            from where the polygon on the left begins, across the edge, to where the one on the
            right begins. It does not matter where on the edge: a crossing of the edge itself
            lies before that place in just one of the two polygons' lists.
        """
        passed: dict[int, int] = {}
        for polygon in self.polygons.values():
            curves = 0
            for dart in polygon:
                # As far as where the edge begins: that is where its other side ends.
                passed[dart] = curves if dart > 0 else curves ^ crossed.get(-dart, 0)
                curves ^= crossed.get(abs(dart), 0)
        return {edge: passed[edge] ^ passed[-edge] for edge in self.sides}

    def independent(self, turns: Mapping[int, int]) -> list[int]:
        """A largest set of given closed curves of which no combination is homologous to zero.

        A curve is homologous to zero (modulo 2, borders filled with discs) if every closed curve
        crosses it an even number of times. It is enough to test the fundamental cycles of the graph
        of polygons. The curves are given by their :meth:`turns`.
        """
        tree = spanning_tree(self.sides, self.polygons)
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


def spanning_tree(
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
