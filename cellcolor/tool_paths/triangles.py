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

from cellcolor.arrays import Array, Index, Mask

__all__ = ["Triangles", "mesh_edges", "split_at"]


def mesh_edges(corners: Index) -> tuple[Index, Index]:
    """The edges (e, 2) with ascending ends, and which of them each side (k, k + 1) is: (m, 3)."""
    sides = np.sort(corners[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    # One number for a pair is much quicker to sort than a row of two.
    base = int(corners.max()) + 1 if len(corners) else 1
    keys, number = np.unique(sides[:, 0] * base + sides[:, 1], return_inverse=True)
    return np.stack([keys // base, keys % base], axis=1), number.reshape(-1, 3).astype(np.int64)


@dataclass(frozen=True, eq=False)
class Triangles:
    """A mesh that lies on a surface.

    Attributes:
        points: (n, 3) m.
        normals: (n, 3) outward unit normals.
        corners: (m, 3) vertices of each triangle, counter-clockwise seen from outside.
        faces: (m,) the triangle of the surface that each triangle lies in.
    """

    points: Array
    normals: Array
    corners: Index
    faces: Index

    @cached_property
    def _numbered_edges(self) -> tuple[Index, Index]:
        return mesh_edges(self.corners)

    @property
    def edges(self) -> Index:
        """(e, 2) the ends of each edge, ascending."""
        return self._numbered_edges[0]

    @property
    def edge_of_side(self) -> Index:
        """(m, 3) the edge from each corner to the next."""
        return self._numbered_edges[1]

    @cached_property
    def lengths(self) -> Array:
        """(e,) of the edges, m."""
        ends = self.points[self.edges]
        return np.asarray(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1))

    @cached_property
    def areas(self) -> Array:
        """(m,) of the triangles, square metres."""
        at = self.points[self.corners]
        doubled = np.cross(at[:, 1] - at[:, 0], at[:, 2] - at[:, 0])
        return np.asarray(np.linalg.norm(doubled, axis=1) / 2.0)

    @cached_property
    def vertex_areas(self) -> Array:
        """(n,) a third of the triangles around each vertex, square metres."""
        return np.bincount(
            self.corners.ravel(), np.repeat(self.areas / 3.0, 3), len(self.points)
        ).astype(np.float64)

    @cached_property
    def border(self) -> Mask:
        """(n,) whether a vertex is on the border."""
        alone = np.bincount(self.edge_of_side.ravel(), minlength=len(self.edges)) == 1
        on_border = np.zeros(len(self.points), dtype=bool)
        on_border[self.edges[alone]] = True
        return on_border

    @cached_property
    def _marching(self) -> Any:
        from potpourri3d import MeshFastMarchingDistanceSolver  # only where a path is laid

        return MeshFastMarchingDistanceSolver(self.points, self.corners)

    def distances_from(self, sources: Index) -> Array:
        """(n,) distance of each vertex from the nearest source along the mesh, m.

        By fast marching (Kimmel and Sethian 1998): first order in the length of edges. A vertex
        that is no source has a neighbor that is nearer, so nothing but sources is a lowest place.
        """
        found = self._marching.compute_distance(
            [[(vertex, [])] for vertex in sources.tolist()], [[0.0]] * len(sources)
        )
        distances = np.asarray(found, dtype=np.float64)
        if not np.isfinite(distances).all():  # needle-like triangles may defeat it
            distances = np.asarray(dijkstra(self.graph(), indices=sources, min_only=True))
        return distances

    @cached_property
    def from_border(self) -> Array:
        """(n,) distance of each vertex from the border along the mesh, m; there must be one."""
        return self.distances_from(np.flatnonzero(self.border))

    def graph(self, weights: Array | None = None, edges: Mask | None = None) -> csr_matrix:
        """The edges as a symmetric matrix of weights, their lengths if none are given.

        Args:
            weights: (e,) of all edges.
            edges: (e,) which edges to have; all if it is None.
        """
        ends = self.edges
        values = np.maximum(self.lengths if weights is None else weights, 1e-12)
        if edges is not None:
            ends, values = ends[edges], values[edges]
        n = len(self.points)
        return csr_matrix(
            (np.concatenate([values, values]), (ends.T.ravel(), ends[:, ::-1].T.ravel())), (n, n)
        )

    def faces_of_walk(self, walk: Index) -> Index:
        """A triangle of the surface that each step of a path lies in."""
        faces = np.empty(len(self.edges), dtype=np.int64)
        faces[self.edge_of_side.ravel()] = np.repeat(self.faces, 3)
        count = len(self.points)
        steps = np.sort(np.stack([walk[:-1], walk[1:]], axis=1), axis=1)
        keys = self.edges[:, 0] * count + self.edges[:, 1]  # ascending, as the edges are
        return faces[np.searchsorted(keys, steps[:, 0] * count + steps[:, 1])]

    def refined(self, longest: float) -> Triangles:
        """Halve edges until none is longer, m; triangles stay conforming."""
        mesh = self
        while True:
            halved = mesh.lengths > longest
            if not halved.any():
                return mesh
            mesh, _ = split_at(mesh, halved, np.full(len(mesh.edges), 0.5))


def split_at(mesh: Triangles, split: Mask, shares: Array) -> tuple[Triangles, Index]:
    """A new vertex on each of some edges, and the triangles cut between them.

    Args:
        mesh: what to cut.
        split: (e,) which edges get a new vertex.
        shares: (e,) where on each edge, 0 at its first end and 1 at its second.

    Returns:
        The finer mesh, old vertices first, and the edge that each new vertex lies on.
    """
    on = np.flatnonzero(split)
    share = shares[on][:, None]
    ends = mesh.edges[on]
    points, normals = [
        np.vstack([rows, (1 - share) * rows[ends[:, 0]] + share * rows[ends[:, 1]]])
        for rows in (mesh.points, mesh.normals)
    ]
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = normals / np.where(lengths > 0, lengths, 1.0)
    number = np.full(len(mesh.edges), -1, dtype=np.int64)
    number[on] = len(mesh.points) + np.arange(len(on))
    middle = number[mesh.edge_of_side]
    count = (middle >= 0).sum(axis=1)
    pieces, faces = [mesh.corners[count == 0]], [mesh.faces[count == 0]]
    for cuts in (1, 2, 3):
        rows = np.flatnonzero(count == cuts)
        if not len(rows):
            continue
        corners, new, face = mesh.corners[rows], middle[rows], mesh.faces[rows]
        # Turn each triangle so that its cut sides come in a fixed place.
        first = (new >= 0).argmax(axis=1) if cuts == 1 else ((new < 0).argmax(axis=1) + 1) % 3
        turn = (first[:, None] + np.arange(3)) % 3
        corners, new = np.take_along_axis(corners, turn, 1), np.take_along_axis(new, turn, 1)
        a, b, c = corners.T
        ab, bc, ca = new.T
        if cuts == 1:  # on ab
            own = [(a, ab, c), (ab, b, c)]
        elif cuts == 2:  # on ab and bc; what is left is a quadrilateral, cut at its shorter way
            shorter = np.linalg.norm(points[a] - points[bc], axis=1) < np.linalg.norm(
                points[ab] - points[c], axis=1
            )
            own = [
                (ab, b, bc),
                (a, ab, np.where(shorter, bc, c)),
                (np.where(shorter, a, ab), bc, c),
            ]
        else:
            own = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        pieces += [np.stack(piece, axis=1) for piece in own]
        faces += [face] * len(own)
    return Triangles(points, normals, np.vstack(pieces), np.concatenate(faces)), on
