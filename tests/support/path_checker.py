"""Whether tool paths stay on their segments, found out from the painted surface alone.

In a triangle the part of corner k is where its barycentric coordinate is the greatest, and the six
small triangles are the orders of the three coordinates. Each step is cut where two of them are
equal; from piece to piece the small triangle may change only to one that is joined to it around
the point between. Nothing of ``cellcolor.tool_paths`` is used.
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import pairwise

import networkx as nx
import numpy as np

from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPath

EPSILON = 1e-7  # in barycentric coordinates


class PathChecker:
    """Knows a painted surface."""

    def __init__(
        self,
        surface: LabelledSurface,
        segment_of: np.ndarray,
        walls: Collection[tuple[int, int]] = (),
    ) -> None:
        self.faces = surface.faces.tolist()
        self.places = surface.vertices
        self.segment_of = segment_of.tolist()
        self.surface = surface
        self.walls = {frozenset(wall) for wall in walls}
        self.faces_at: dict[int, set[int]] = {}
        for number, face in enumerate(self.faces):
            for vertex in face:
                self.faces_at.setdefault(vertex, set()).add(number)

    def problems(self, path: ToolPath) -> list[str]:
        """What is wrong with a path; one entry at most, since the rest follows from it."""
        before: set[int] | None = None
        for number, face in enumerate(path.faces.tolist()):
            ends = [self.coordinates(face, path.points[number + end]) for end in (0, 1)]
            if any(end is None for end in ends):
                return [f"step {number} is not in triangle {face}"]
            for at, piece in self.pieces(*ends):
                now = {
                    small
                    for small in self.small_triangles(face, piece)
                    if self.segment_of[self.corner(small)] == path.segment
                }
                if before is not None:
                    joined = self.around(face, at, path)
                    now = {
                        small
                        for small in now
                        if any(old == small or self.linked(joined, old, small) for old in before)
                    }
                if not now:
                    return [f"step {number} leaves what it may touch, in triangle {face}"]
                before = now
        return []

    def coordinates(self, face: int, point: np.ndarray) -> np.ndarray | None:
        """Barycentric coordinates of a point in a triangle; None if it is not there."""
        corners = self.places[self.faces[face]]
        sides = (corners[1:] - corners[0]).T
        shares, *_ = np.linalg.lstsq(sides, point - corners[0], rcond=None)
        found = np.array([1 - shares.sum(), *shares])
        size = np.abs(sides).max()
        if np.linalg.norm(found @ corners - point) > EPSILON * size or found.min() < -EPSILON:
            return None
        return found

    def pieces(self, a: np.ndarray, b: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
        """Where each piece of a step begins, and its middle."""
        cuts = [0.0, 1.0]
        for i, j in ((0, 1), (1, 2), (2, 0)):
            start, stop = a[i] - a[j], b[i] - b[j]
            if abs(start) > EPSILON and abs(stop) > EPSILON and start * stop < 0:
                cuts.append(start / (start - stop))
        cuts.sort()
        found = []
        for first, second in pairwise(cuts):
            middle = (first + second) / 2
            found.append((a + first * (b - a), a + middle * (b - a)))
        return found

    def small_triangles(self, face: int, at: np.ndarray) -> list[int]:
        """The small triangles of a triangle that hold a point of it."""
        found = []
        for k in range(3):
            this, after, before = at[k], at[(k + 1) % 3], at[(k + 2) % 3]
            for parity, (second, third) in enumerate(((after, before), (before, after))):
                if this >= second - EPSILON and second >= third - EPSILON:
                    found.append(6 * face + 2 * k + parity)
        return found

    def corner(self, small: int) -> int:
        """The vertex that a small triangle belongs to."""
        return self.faces[small // 6][small % 6 // 2]

    def around(self, face: int, at: np.ndarray, path: ToolPath) -> nx.Graph:
        """The small triangles at a point that the path may touch, joined where it may cross."""
        corners = self.faces[face]
        on = [corner for corner, share in zip(corners, at, strict=True) if share > EPSILON]
        faces = set.intersection(*(self.faces_at[corner] for corner in on))
        share_of = dict(zip(corners, at.tolist(), strict=True))
        graph = nx.Graph()
        sides: dict[frozenset, int] = {}
        for other in faces:
            here = np.array([share_of.get(corner, 0.0) for corner in self.faces[other]])
            for small in self.small_triangles(other, here):
                if self.segment_of[self.corner(small)] != path.segment:
                    continue
                graph.add_node(small)
                for side in self.sides(small):
                    if self.on_side(side, here, self.faces[other]) and self.open(side, path):
                        if side in sides:
                            graph.add_edge(small, sides[side])
                        sides[side] = small
        return graph

    def sides(self, small: int) -> list[frozenset]:
        """Its three sides: each the two points at its ends, a point being a set of vertices."""
        face = self.faces[small // 6]
        k, parity = divmod(small % 6, 2)
        second = face[(k + 1) % 3] if parity == 0 else face[(k + 2) % 3]
        points = [
            frozenset([face[k]]), frozenset([face[k], second]), frozenset([*face, -1 - small // 6])
        ]  # fmt: skip
        return [frozenset(points) - {points[n]} for n in range(3)]

    def on_side(self, side: frozenset, at: np.ndarray, face: list[int]) -> bool:
        """Whether a point is on a side of a small triangle; both are in the given triangle."""
        ends = [
            np.array([1 / len(set(end) & set(face)) if corner in end else 0.0 for corner in face])
            for end in side
        ]
        way = ends[1] - ends[0]
        share = np.clip((at - ends[0]) @ way / (way @ way), 0, 1)
        return bool(np.abs(ends[0] + share * way - at).max() <= 2 * EPSILON)

    def open(self, side: frozenset, path: ToolPath) -> bool:
        """Whether a path may cross a side."""
        if any(len(end) == 1 for end in side):
            return True  # from a vertex: within its own part
        (edge,) = [end for end in side if len(end) == 2]
        a, b = edge
        if self.segment_of[a] != self.segment_of[b] or edge in self.walls:
            return False
        return path.color not in self.surface.cracked(a, b)

    def linked(self, graph: nx.Graph, one: int, other: int) -> bool:
        """Whether two small triangles are joined around a point."""
        return one in graph and other in graph and nx.has_path(graph, one, other)
