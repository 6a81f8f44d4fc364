"""A triangle mesh inside a region, refined and sliced; every triangle lies in one of the surface.

A path on it is a row of its vertices, each joined to the next by a side of a triangle. So each
step lies in one triangle of the surface, and nothing that the region's mesh was cut along is ever
crossed: that holds for whatever is made of these meshes, without further care.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index, Mask, unit
from cellcolor.mesh.dividing import cut, new_points
from cellcolor.mesh.triangle_mesh import TriangleMesh


@dataclass(frozen=True, eq=False)
class Triangles(TriangleMesh):
    """A mesh that lies on a surface, in m; triangles are counter-clockwise seen from outside.

    Attributes:
        normals: (n, 3) outward unit normals at the points.
        faces: (m,) the triangle of the surface that each triangle lies in.
    """

    normals: Array
    faces: Index

    @cached_property
    def _marching(self) -> Any:
        from potpourri3d import MeshFastMarchingDistanceSolver  # only where a path is laid

        return MeshFastMarchingDistanceSolver(self.points, self.corners)

    def distances_from(self, sources: Index, offsets: Array | None = None) -> Array:
        """(n,) distance of each vertex from the nearest source along the mesh, m.

        Sources may have offsets (s,), m, where distances begin instead of 0.

        By fast marching (Kimmel and Sethian 1998): first order in the length of edges. A vertex
        that is no source has a neighbor that is nearer, so nothing but sources is a lowest place.
        """
        offsets = np.zeros(len(sources)) if offsets is None else offsets
        least = float(offsets.min(initial=0.0))
        found = self._marching.compute_distance(
            [[(vertex, [])] for vertex in sources.tolist()],
            [[start] for start in (offsets - least).tolist()],
        )
        distances = np.asarray(found, dtype=np.float64) + least
        if not np.isfinite(distances).all():  # needle-like triangles may defeat it
            distances = np.asarray(dijkstra(self.graph(), indices=sources, min_only=True))
        return distances

    @cached_property
    def from_border(self) -> Array:
        """(n,) distance of each vertex from the border along the mesh, m; there must be one."""
        return self.distances_from(np.flatnonzero(self.border))

    def graph(self, weights: Array | None = None) -> csr_matrix:
        """The edges as a symmetric matrix of weights (e,), their lengths if none are given."""
        ends, n = self.edges, len(self.points)
        values = np.maximum(self.lengths if weights is None else weights, 1e-12)
        return csr_matrix(
            (np.concatenate([values, values]), (ends.T.ravel(), ends[:, ::-1].T.ravel())), (n, n)
        )

    def refined(self, longest: float) -> Triangles:
        """Halve edges until none is longer, m; triangles stay conforming."""
        mesh = self
        while True:
            halved = mesh.lengths > longest
            if not halved.any():
                return mesh
            mesh, _ = split_at(mesh, halved, 0.5)


def split_at(mesh: Triangles, split: Mask, shares: Array | float) -> tuple[Triangles, Index]:
    """A new vertex on each of some edges, and the triangles cut between them.

    Args:
        split: (e,) which edges get a new vertex.
        shares: (e,) where on each edge, 0 at its first end and 1 at its second; or on all of them.

    Returns:
        The finer mesh, old vertices first, and the edge that each new vertex lies on.
    """
    on = np.flatnonzero(split)
    share = np.broadcast_to(shares, split.shape)[on][:, None]
    ends = mesh.edges[on]
    points, normals = [
        np.vstack([rows, (1 - share) * rows[ends[:, 0]] + share * rows[ends[:, 1]]])
        for rows in (mesh.points, mesh.normals)
    ]
    # Of triangles with two sides cut and with three the whole one, or the last, decides the order.
    is_cut = split[mesh.edge_of_side]
    after_whole = (is_cut.argmin(axis=1) + 1) % 3
    first = np.where(is_cut.sum(axis=1) < 2, is_cut.argmax(axis=1), after_whole)
    corners, of = cut(mesh, new_points(mesh, split), first, points)
    return Triangles(points, corners, unit(normals), mesh.faces[of]), on
