"""Holes of a mesh: its borders, and faces that close them.

A hole is filled with the triangulation of least area among its own vertices, as Barequet and
Sharir do ("Filling gaps in the boundary of a polyhedron", 1995).
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped

__all__ = ["MOST_EDGES", "border_groups", "borders", "filling"]

MOST_EDGES = 250  # of a hole that is filled; the work grows with the third power


def border_groups(mesh: TriangleMesh) -> tuple[Index, Index]:
    """The edges (b,) of one face only, and the group (b,) of each: those that hang together."""
    border = np.flatnonzero(mesh.triangles_at == 1)
    ends = mesh.edges[border]
    group = grouped(len(mesh.points), ends)[ends[:, 0]]
    return border, np.unique(group, return_inverse=True)[1]


def borders(mesh: TriangleMesh) -> int:
    """How many borders there are: groups of edges of one face that hang together."""
    return int(border_groups(mesh)[1].max(initial=-1)) + 1


def filling(vertices: Array, loop: list[int], edges: set[tuple[int, int]]) -> Faces | None:
    """Faces (n - 2, 3) between the vertices of a loop, of least area; None if there are none.

    Args:
        loop: n vertices, in the order in which a face there winds.
        edges: (smaller, greater) of the mesh; none of them may get a third face.
    """
    count = len(loop)
    points, number = vertices[loop], np.array(loop)
    closed = np.zeros((count, count), dtype=bool)
    for i in range(count):
        for j in range(i + 2, count):
            if (i, j) != (0, count - 1):
                pair = (loop[i], loop[j])
                closed[i, j] = (min(pair), max(pair)) in edges
    cost = np.zeros((count, count))
    best = np.zeros((count, count), dtype=np.int64)
    for width in range(2, count):
        for i in range(count - width):
            j = i + width
            k = np.arange(i + 1, j)
            across = np.cross(points[k] - points[i], points[j] - points[i])
            area = np.linalg.norm(across, axis=1) / 2
            sides = np.linalg.norm(points[k] - points[i], axis=1) ** 2
            flat = area <= 1e-6 * np.maximum(sides, np.linalg.norm(points[j] - points[i]) ** 2)
            total = cost[i, k] + cost[k, j] + np.where(flat, np.inf, area)
            at = int(np.argmin(total))
            cost[i, j] = np.inf if closed[i, j] else total[at]
            best[i, j] = k[at]
    if not np.isfinite(cost[0, -1]):
        return None
    found, open_ = [], [(0, count - 1)]
    while open_:
        low, high = open_.pop()
        if high - low >= 2:
            middle = int(best[low, high])
            found.append((number[low], number[middle], number[high]))
            open_ += [(low, middle), (middle, high)]
    return np.array(found, dtype=np.int64)
