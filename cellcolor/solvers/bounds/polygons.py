"""A surface of merged cells as polygons glued along edges, and curves on it up to homology."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping

from cellcolor.solvers.bounds.merged_cells import MergedCells
from cellcolor.union_find import UnionFind


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
        self.following: dict[int, int] = {}
        self.polygons: dict[int, list[int]] = {}
        self.sides = dict(merged.sides)
        self.seams: dict[int, list[int]] = {}
        highest = max(self.sides, default=0)
        for merged_cell, loops in merged.loops.items():
            self.polygons[merged_cell] = [*loops[0]] if loops else []
            self.seams[merged_cell] = []
            for loop in loops:
                self.following |= zip(loop, loop[1:] + loop[:1], strict=True)
            for loop in loops[1:]:
                highest += 1
                self.polygons[merged_cell] += [highest, *loop, -highest]
                self.sides[highest] = merged_cell, merged_cell
                self.seams[merged_cell].append(highest)
        self.before = {following: dart for dart, following in self.following.items()}

    def borders(self) -> UnionFind[int]:
        """The border curves, each as the darts after which it runs.

        At the corner where a dart ends, the border continues to what lies before the dart's
        other side.
        """
        borders: UnionFind[int] = UnionFind(self.following)
        for dart in self.following:
            borders.union(dart, self.before[-dart])
        return borders

    @property
    def is_spheres(self) -> bool:
        """Whether each component, its borders filled with discs, is a sphere (Euler)."""
        polygons = [merged_cell for merged_cell, darts in self.polygons.items() if darts]
        connected: UnionFind[int] = UnionFind(polygons)
        for left, right in self.sides.values():
            connected.union(left, right)
        points, lines = len(self.borders().sets()), len(self.sides)
        return points - lines + len(polygons) == 2 * len(connected.sets())

    def turns(self, crossed: Mapping[int, int]) -> dict[int, int]:
        """Which of some curves lie between the beginnings of two polygons with a common edge.

        Args:
            crossed: for each edge and seam the curves that cross it an odd number of times, as the
                bits of a number.

        Returns:
            For each edge and seam the curves that a way crosses an odd number of times which leads
            from where the polygon on the left begins, across the edge, to where the one on the
            right begins. It does not matter where on the edge, for there a curve has passed
            either on both sides or on none.
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
        of polygons.

        Args:
            turns: the curves between polygons, see above.
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
    """The edge by which each node is first reached, and the node before; 0 and itself for a root.

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
        queue = deque([root])
        while queue:
            node = queue.popleft()
            for edge, beyond in near.get(node, ()):
                if beyond not in tree:
                    tree[beyond] = edge, node
                    queue.append(beyond)
    return tree
