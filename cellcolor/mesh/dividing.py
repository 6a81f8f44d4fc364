"""Triangles cut at new points on their sides, on both sides of an edge alike.

Beside that, the six small triangles that every triangle of a mesh falls into. They lie between each
of its corners, the middles of its sides and its centroid. Numbers 6 t + 2 k and 6 t + 2 k + 1 are
those at the corner k of the triangle t (``docs/motion.md``).
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask, unit
from cellcolor.mesh.triangle_mesh import TriangleMesh

_PIECES = {
    (False, False, False): [(0, 1, 2)],
    (True, False, False): [(0, 3, 2), (3, 1, 2)],
    (True, True, False): [(3, 1, 4), (0, 3, 6), (7, 4, 2)],
    (True, True, True): [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
}
"""By which of the sides ab, bc, ca are cut: the corners of the pieces. 0, 1, 2 are a, b, c, and 3,
4, 5 the new points on ab, bc, ca. A diagonal goes from 7 to 6."""


def new_points(mesh: TriangleMesh, marked: Mask) -> Index:
    """The number of the new point on each marked edge (k,), after the old ones; -1 on others."""
    number = np.full(len(marked), -1, dtype=np.int64)
    number[marked] = len(mesh.points) + np.arange(np.count_nonzero(marked))
    return number


def cut(
    mesh: TriangleMesh, new: Index, first: Index | None = None, points: Array | None = None
) -> tuple[Index, Index]:
    """The pieces of all triangles that are cut at once at new points on their sides.

    Args:
        new: (k,) see :func:`new_points`.
        first: (m,) the side that the pieces of each triangle begin with, which must be cut if any
            is, and followed by a second one if two are; None takes the first such side.
        points: old and new; what is left of a triangle with two sides cut is then parted along
            its shorter diagonal. None takes the one from the corner before the sides.

    Returns:
        The corners (p, 3) of the pieces, and the triangle (p,) that each is a piece of.
    """
    middle = new[mesh.edge_of_side]
    is_cut = middle >= 0
    if first is None:
        after_whole = (is_cut.argmin(axis=1) + 1) % 3
        first = np.where(is_cut.sum(axis=1) == 2, after_whole, is_cut.argmax(axis=1))
    order = (first[:, None] + np.arange(3)) % 3
    names = np.hstack([np.take_along_axis(x, order, 1) for x in (mesh.corners, middle)])
    names = np.concatenate([names, names[:, [4, 0]]], axis=1)
    if points is not None:
        two = np.flatnonzero(is_cut.sum(axis=1) == 2)
        a, c, ab, bc = (points[names[two, corner]] for corner in (0, 2, 3, 4))
        other = ~(np.linalg.norm(a - bc, axis=1) < np.linalg.norm(ab - c, axis=1))
        names[two[other], 6:] = names[two[other]][:, [2, 3]]
    found, of = [], []
    for sides, parts in _PIECES.items():
        rows = np.flatnonzero(((names[:, 3:6] >= 0) == sides).all(axis=1))
        found += [names[rows][:, part] for part in parts]
        of += [rows] * len(parts)
    return np.concatenate(found), np.concatenate(of)


def halved(mesh: TriangleMesh, marked: Mask) -> tuple[TriangleMesh, Index]:
    """A mesh with marked edges (k,) cut in the middle; new points last, in the order of edges.

    Returns:
        The finer mesh, and the triangle of the mesh that each of its triangles is a piece of.
    """
    corners, of = cut(mesh, new_points(mesh, marked))
    middles = mesh.points[mesh.edges[marked]].mean(axis=1)
    return TriangleMesh(np.concatenate([mesh.points, middles]), corners), of


def with_longest_sides(mesh: TriangleMesh, marked: Mask) -> Mask:
    """Marked edges (k,), and the longest side of every triangle that has a marked one.

    Of equally long sides the edge that comes first is the longest.
    """
    order = np.lexsort((-np.arange(len(marked)), mesh.lengths))
    rank = np.empty(len(marked), dtype=np.int64)
    rank[order] = np.arange(len(marked))
    longest = order[rank[mesh.edge_of_side].max(axis=1)]
    marked = marked.copy()
    while True:
        missing = longest[marked[mesh.edge_of_side].any(axis=1) & ~marked[longest]]
        if not len(missing):
            return marked
        marked[missing] = True


def small_triangles(mesh: TriangleMesh) -> tuple[TriangleMesh, Index]:
    """The mesh of small triangles, and the edge (6 m,) of the mesh that each of them touches.

    Its points are those of the mesh, the middles of its k edges and its m centroids, in this
    order; the first corner of each small triangle is a point of the mesh.
    """
    corners, side = mesh.corners, mesh.edge_of_side
    middles = len(mesh.points) + side
    centroids = len(mesh.points) + len(mesh.edges) + np.arange(len(corners))
    centers = np.repeat(centroids[:, None], 3, axis=1)
    after = np.stack([corners, middles, centers], axis=2)
    before = np.stack([corners, centers, np.roll(middles, 1, axis=1)], axis=2)
    small = np.stack([after, before], axis=2).reshape(-1, 3)
    touched = np.stack([side, np.roll(side, 1, axis=1)], axis=2)
    return TriangleMesh(everywhere(mesh, mesh.points), small), touched.ravel()


def everywhere(mesh: TriangleMesh, values: Array) -> Array:
    """Values (n, ...) at points, then their means at middles of edges and at centroids."""
    middles, centroids = values[mesh.edges].mean(axis=1), values[mesh.corners].mean(axis=1)
    return np.concatenate([values, middles, centroids])


def unit_everywhere(mesh: TriangleMesh, normals: Array) -> Array:
    """Unit normals (n, 3) at points, and so at middles and centroids; 0 where they cancel out."""
    return unit(everywhere(mesh, normals))


def small_areas(mesh: TriangleMesh) -> Array:
    """The areas (6 m,) of the small triangles: a sixth of their triangle each."""
    return np.repeat(mesh.areas / 6, 6)
