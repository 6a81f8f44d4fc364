"""Whether tool paths stay on their segments, found out from the painted surface alone.

A vertex has the part of each of its triangles where its barycentric coordinate is the greatest.
Each step is cut where two coordinates are equal; from piece to piece a path may go from one
vertex's part to that of another one over an edge between them that is open. Nothing of
``cellcolor.tool_paths`` is used.
"""

from __future__ import annotations

from collections.abc import Collection
from itertools import combinations, pairwise

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
        self.segment_of = segment_of.tolist()
        self.surface = surface
        self.walls = {frozenset(wall) for wall in walls}

    def problems(self, path: ToolPath) -> list[str]:
        """What is wrong with a path; one entry at most, since the rest follows from it."""
        before: set[int] | None = None
        for number, face in enumerate(path.faces.tolist()):
            ends = [self.coordinates(face, path.points[number + end]) for end in (0, 1)]
            if any(end is None for end in ends):
                return [f"step {number} is not in triangle {face}"]
            for at, middle in self.pieces(*ends):
                now = self.owners(face, middle, path)
                if before is not None:
                    joined = self.joined(before | now, self.owners(face, at, path), path)
                    now = {
                        vertex
                        for vertex in now
                        if any(nx.has_path(joined, old, vertex) for old in before)
                    }
                if not now:
                    return [f"step {number} leaves what it may touch, in triangle {face}"]
                before = now
        return []

    def coordinates(self, face: int, point: np.ndarray) -> np.ndarray | None:
        """Barycentric coordinates of a point in a triangle; None if it is not there."""
        corners = self.surface.vertices[self.faces[face]]
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
        for i, j in combinations(range(3), 2):
            start, stop = a[i] - a[j], b[i] - b[j]
            if abs(start) > EPSILON and abs(stop) > EPSILON and start * stop < 0:
                cuts.append(start / (start - stop))
        return [
            (a + first * (b - a), a + (first + second) / 2 * (b - a))
            for first, second in pairwise(sorted(cuts))
        ]

    def owners(self, face: int, at: np.ndarray, path: ToolPath) -> set[int]:
        """The vertices of the path's segment that have a point of a triangle, most often one."""
        pairs = zip(self.faces[face], at, strict=True)
        own = {vertex for vertex, share in pairs if share >= at.max() - EPSILON}
        return {vertex for vertex in own if self.segment_of[vertex] == path.segment}

    def joined(self, vertices: set[int], there: set[int], path: ToolPath) -> nx.Graph:
        """Vertices whose parts meet in a point, joined where the path may cross."""
        graph: nx.Graph = nx.Graph()
        graph.add_nodes_from(vertices)
        for a, b in combinations(vertices | there, 2):
            edge = (a, b) in self.surface.left_of or (b, a) in self.surface.left_of
            walled = {a, b} in self.walls or path.color in self.surface.cracked(a, b)
            if edge and not walled:
                graph.add_edge(a, b)
        return graph
