"""The six small triangles that every triangle of a mesh falls into.

They lie between each of its corners, the middles of its sides and its centroid. Numbers 6 t + 2 k
and 6 t + 2 k + 1 are those at the corner k of the triangle t (``docs/motion.md``).
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.mesh.triangle_mesh import TriangleMesh


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
    turned = everywhere(mesh, normals)
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    return np.asarray(turned / np.where(lengths > 0, lengths, 1.0))


def small_areas(mesh: TriangleMesh) -> Array:
    """The areas (6 m,) of the small triangles: a sixth of their triangle each."""
    return np.repeat(mesh.areas / 6, 6)


def small_triangle_at(mesh: TriangleMesh, triangle: int, point: Array) -> int:
    """The number of the small triangle of a triangle that a point (3,) on it lies in."""
    (shares,) = mesh.shares(np.array([triangle]), point[None])
    corner = int(np.argmax(shares))
    return 6 * triangle + 2 * corner + int(shares[corner - 1] > shares[(corner + 1) % 3])
