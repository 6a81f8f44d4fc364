"""Shortest ways along mesh edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, diags
from scipy.sparse.csgraph import dijkstra
from scipy.sparse.linalg import cg

from cellcolor.arrays import Array, Index
from cellcolor.tool_paths.triangles import Triangles, split_at

_ROUNDS = 300
_TOUCHING = 1000.0  # the factor of edges that touch the border
_SLIVER = 1e-6  # of a length squared; triangles and parts of vertices count as no smaller


@dataclass(frozen=True, eq=False)
class Ways:
    """The shortest way to each vertex from the nearest of several sources.

    Attributes:
        lengths: (n,) in the weights of the graph; infinite if there is no way.
        before: (n,) the vertex before each on its way; negative at sources and if there is no way.
        source: (n,) where the way begins; negative if there is no way.
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


def ways_from(graph: csr_matrix, sources: Index, longest: float = np.inf) -> Ways:
    """Dijkstra's algorithm from all sources at once; there are no ways longer than the longest."""
    lengths, before, source = dijkstra(
        graph, indices=sources, min_only=True, return_predecessors=True, limit=longest
    )
    return Ways(lengths, before.astype(np.int64), source.astype(np.int64))


def evened(mesh: Triangles, values: Array, length: float) -> Array:
    """A field (n,) near to another one whose level lines bend less.

    Distances are found with errors as long as the edges of the mesh, and lines tremble with them.
    Minimized are the squares of what is changed, and of the Laplacian times the length squared;
    fields whose lines are straight and evenly apart stay as they are. The Laplacian at the border
    is not asked about.

    Args:
        length: waves of six times that length are made half as high, m.
    """
    from potpourri3d import cotan_laplacian  # only where a path is laid

    laplacian = cotan_laplacian(mesh.points, mesh.corners, denom_eps=_SLIVER * length**2)
    mass = np.maximum(mesh.vertex_areas, _SLIVER * length**2)
    bends = diags(np.where(mesh.border, 0.0, length**2 / np.sqrt(mass))) @ laplacian
    system = (diags(mass) + bends.T @ bends).tocsr()
    # Jacobi's preconditioner; a few rounds do, since only short waves are damped.
    first = diags(1.0 / system.diagonal())
    found = cg(system, mass * values, values, rtol=1e-8, maxiter=_ROUNDS, M=first)[0]
    # On triangles without area the weights are so uneven that it may not come near.
    found = np.where(np.isfinite(found), found, values)
    return np.asarray(np.clip(found, values - length, values + length))


def with_room_inside(mesh: Triangles) -> Triangles:
    """The same mesh with a way off the border through each triangle.

    An edge that leads from border to border through the inside gets a vertex in its middle, old
    vertices first. On the border itself rounding decides on which side of a crack a point lies.
    """
    return split_at(mesh, mesh.border[mesh.edges].all(axis=1) & (mesh.triangles_at > 1), 0.5)[0]


def off_border(mesh: Triangles, room: float) -> Array:
    """Weights (e,) of edges, m: their lengths, up to tripled near the border of the mesh.

    With these weights shortest ways stay in the middle of narrow places. At the distance ``room``
    from the border, m, and beyond, weights are lengths. No way touches the border that can do
    without.
    """
    if not mesh.border.any():
        return mesh.lengths
    near = 1.0 - np.minimum(mesh.from_border / room, 1.0)
    touching = np.where(mesh.border[mesh.edges].any(axis=1), _TOUCHING, 1.0)
    return np.asarray(mesh.lengths * touching * (1.0 + 2.0 * near[mesh.edges].mean(axis=1)))
