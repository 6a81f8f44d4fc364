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
from scipy.sparse import csr_matrix, diags
from scipy.sparse.csgraph import dijkstra
from scipy.sparse.linalg import cg

from cellcolor.arrays import Array, Index, Mask, unit
from cellcolor.mesh.dividing import cut, new_points
from cellcolor.mesh.triangle_mesh import TriangleMesh, grouped


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

    def places(self, of: Mask) -> list[Index]:
        """Vertices (n,) of which something holds: those of each connected place."""
        place = grouped(len(of), self.edges[of[self.edges].all(axis=1)])
        vertices = np.flatnonzero(of)
        return [vertices[place[vertices] == number] for number in np.unique(place[vertices])]

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


_NEAR = 0.02  # of the distance between levels: vertices this close to a level are moved off it


@dataclass(frozen=True, eq=False)
class Sliced:
    """A mesh with the level lines of a field among its edges.

    Attributes:
        mesh: the finer mesh.
        values: (n,) the field at its vertices.
        level: (n,) the number of the level that a vertex was put on, -1 for all other vertices.
    """

    mesh: Triangles
    values: Array
    level: Index


Row = tuple[list[int], bool]
"""Vertices in order, and whether the row closes; the first is not repeated at the end then."""


def slice_along(mesh: Triangles, values: Array, levels: Array) -> Sliced:
    """Cut triangles along the level lines of a field that is linear in each.

    Levels ascend. A value (n,) on one or just beside it is moved off, so that lines run through no
    vertex and never touch each other.
    """
    if not len(levels):
        return Sliced(mesh, values, np.full(len(mesh.points), -1, dtype=np.int64))
    values = _off(values, levels)
    # Edges that several levels cross are halved until each is crossed by one at most.
    while True:
        at = np.sort(np.searchsorted(levels, values[mesh.edges]), axis=1)
        crossed = at[:, 1] - at[:, 0]
        several = crossed > 1
        if not several.any():
            break
        middles = values[mesh.edges[several]].mean(axis=1)
        mesh, _ = split_at(mesh, several, 0.5)
        values = _off(np.concatenate([values, middles]), levels)
    ends = values[mesh.edges]
    split = crossed == 1
    number = np.minimum(at[:, 0], len(levels) - 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = (levels[number] - ends[:, 0]) / (ends[:, 1] - ends[:, 0])
    finer, on = split_at(mesh, split, shares)
    level = np.concatenate([np.full(len(mesh.points), -1, dtype=np.int64), number[on]])
    return Sliced(finer, np.concatenate([values, levels[number[on]]]), level)


def level_lines(sliced: Sliced) -> list[Row]:
    """All connected level lines, by their lowest vertex; one that is open ends at the border."""
    edges = sliced.mesh.edges
    own = edges[(sliced.level[edges] >= 0).all(axis=1)]
    beside: dict[int, list[int]] = {}
    for a, b in own.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    done: set[int] = set()
    lines = []
    # Lines with ends first, each from an end; what is left is closed.
    for start in sorted(beside, key=lambda vertex: (len(beside[vertex]), vertex)):
        if start in done:
            continue
        row = [start]
        done.add(start)
        while True:
            onward = [other for other in beside[row[-1]] if other not in done]
            if not onward:
                break
            row.append(onward[0])
            done.add(onward[0])
        lines.append((row, len(beside[start]) == 2))
    return lines


def _off(values: Array, levels: Array) -> Array:
    """The values, those on a level or just beside it moved a little above it."""
    apart = float(np.diff(levels).min()) if len(levels) > 1 else float(np.ptp(values)) or 1.0
    at = np.searchsorted(levels, values)
    bounds = np.concatenate([[-np.inf], levels, [np.inf]])
    below, above = bounds[at], bounds[at + 1]
    nearest = np.where(values - below < above - values, below, above)
    near = np.abs(values - nearest) < _NEAR * apart
    return np.where(near, nearest + _NEAR * apart, values)


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
