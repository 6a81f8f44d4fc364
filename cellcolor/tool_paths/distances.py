"""Distances along a mesh: fast marching for smooth fields, shortest paths for ways."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index
from cellcolor.tool_paths.triangles import Triangles

__all__ = ["Ways", "distance_along", "off_border", "ways_from"]


def distance_along(mesh: Triangles, sources: Index) -> Array:
    """(n,) distance of each vertex from the nearest source along the mesh, m.

    By fast marching (Kimmel and Sethian 1998): first order in the length of edges. A vertex that
    is no source has a neighbor that is nearer, so nothing but sources is a lowest place.
    """
    from potpourri3d import MeshFastMarchingDistanceSolver

    solver = MeshFastMarchingDistanceSolver(mesh.points, mesh.corners)
    found = solver.compute_distance(
        [[(int(vertex), [])] for vertex in sources], [[0.0] for _ in sources]
    )
    distances = np.asarray(found, dtype=np.float64)
    if not np.isfinite(distances).all():  # needle-like triangles may defeat it
        distances = np.asarray(dijkstra(mesh.graph(), indices=sources, min_only=True))
    return distances


@dataclass(frozen=True, eq=False)
class Ways:
    """Shortest ways along edges from the nearest of several sources.

    Attributes:
        lengths: (n,) by the weights that were given; infinite where no way leads.
        before: (n,) the vertex before each on its way; negative at sources and out of reach.
        source: (n,) where the way begins; negative out of reach.
    """

    lengths: Array
    before: Index
    source: Index

    def back_from(self, vertex: int) -> list[int]:
        """The way from a vertex back to its source, both included."""
        way = [vertex]
        while self.before[way[-1]] >= 0:
            way.append(int(self.before[way[-1]]))
        return way


def ways_from(graph: csr_matrix, sources: Index) -> Ways:
    """Dijkstra's algorithm from all sources at once."""
    lengths, before, source = dijkstra(
        graph, indices=sources, min_only=True, return_predecessors=True
    )
    return Ways(lengths, before.astype(np.int64), source.astype(np.int64))


def off_border(mesh: Triangles, room: float) -> Array:
    """(e,) lengths of edges, up to three times as much where they are near the border.

    Shortest ways by these lengths keep to the middle where it is narrow.

    Args:
        mesh: the mesh.
        room: from which distance on a border does not matter, m.
    """
    border = np.flatnonzero(mesh.border)
    if not len(border):
        return mesh.lengths
    near = 1.0 - np.minimum(distance_along(mesh, border) / room, 1.0)
    return np.asarray(mesh.lengths * (1.0 + 2.0 * near[mesh.edges].mean(axis=1)))
