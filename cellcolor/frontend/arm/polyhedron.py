"""Solids with flat faces: meshes and boxes as collision shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, QhullError

from cellcolor.arrays import Array, Index, Mask
from cellcolor.memory import chunks
from cellcolor.mesh.triangle_mesh import grouped

_OUTSIDE = 1e-9  # of its size; so far before a plane a point is not behind it
_BEHIND = 24  # bytes that a point and a plane take
_PAIR = 256  # bytes that a point and a face take


@dataclass(frozen=True, eq=False)
class Polyhedron:
    """All points on the faces and inside them; an open mesh has no inside to speak of.

    Attributes:
        vertices: (n, 3) in m, in the frame of the joint that carries it.
        faces: (m, 3) vertex indices, counter-clockwise seen from outside.
    """

    vertices: Array
    faces: Index

    @cached_property
    def corners(self) -> Array:
        """(8, 3) of a box around it: none of its points moves farther than one of these, m."""
        to_box, extents = trimesh.bounds.oriented_bounds(self.vertices)
        signs = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        from_box = np.linalg.inv(to_box)
        return np.asarray((signs * extents) @ from_box[:3, :3].T + from_box[:3, 3])

    @cached_property
    def outline(self) -> Array:
        """(h, 3) the vertices of its convex hull, m; all of them if it lies in a plane."""
        hull = convex_hull(self.vertices)
        return self.vertices if hull is None else hull.vertices

    @cached_property
    def one_of_each_part(self) -> Array:
        """(parts, 3) a vertex of each of its parts that do not hang together, m."""
        return one_of_each_part(self.vertices, self.faces)

    @cached_property
    def _planes(self) -> Array:
        """(s, 4) unit normals and offsets of planes that it is behind; none if it lies in one."""
        try:
            return np.asarray(ConvexHull(self.vertices).equations)
        except (QhullError, ValueError):
            return np.empty((0, 4))

    def contains(self, points: Array) -> Mask:
        """Whether points (k, 3) are inside, (k,), by how often the faces go round them.

        After Jacobson, Kavan and Sorkine-Hornung, Robust inside-outside segmentation using
        generalized winding numbers, 2013: half a turn or more counts, either way round, so that
        small holes do no harm and a mesh may be inside out. Solid angles by Van Oosterom and
        Strackee, 1983.
        """
        low, high = self.vertices.min(axis=0), self.vertices.max(axis=0)
        near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=1))
        # From outside the convex hull, all faces are in one half of what is seen.
        normals, offsets = self._planes[:, :3], self._planes[:, 3]
        slack = _OUTSIDE * float((high - low).max(initial=0.0))
        for some in chunks(len(near), _BEHIND * len(offsets) + 1):
            ahead = np.einsum("ij,kj->ik", points[near[some]], normals) + offsets
            near[some] = np.where((ahead <= slack).all(axis=1), near[some], -1)
        near = near[near >= 0]
        corners = self.vertices[self.faces]
        turns = np.zeros(len(near))
        for some, part in product(
            chunks(len(near), _PAIR * len(corners)), chunks(len(corners), _PAIR)
        ):
            rows = near[some]
            a, b, c = (corners[None, part, k] - points[rows, None] for k in range(3))
            la, lb, lc = (np.sqrt(np.einsum("ijk,ijk->ij", v, v)) for v in (a, b, c))
            volume = np.einsum("ijk,ijk->ij", a, np.cross(b, c))
            rest = (
                la * lb * lc
                + np.einsum("ijk,ijk->ij", a, b) * lc
                + np.einsum("ijk,ijk->ij", b, c) * la
                + np.einsum("ijk,ijk->ij", c, a) * lb
            )
            turns[some] += np.arctan2(volume, rest).sum(axis=1)
        inside = np.zeros(len(points), dtype=bool)
        inside[near] = np.abs(turns) >= np.pi
        return inside


def one_of_each_part(vertices: Array, faces: Index) -> Array:
    """A vertex (parts, 3) of each part of a mesh whose faces hang together."""
    pairs = np.concatenate([faces[:, :2], faces[:, 1:]])
    part = grouped(len(vertices), pairs)
    used = np.unique(faces)
    return np.asarray(vertices[used[np.unique(part[used], return_index=True)[1]]])


def longest_side_first(triangles: Array) -> Array:
    """Corners (3, m, 3) of triangles (m, 3, 3), the longest side from the first to the second."""
    sides = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
    order = (np.argmax(sides, axis=1)[:, None] + np.arange(3)) % 3
    return np.take_along_axis(triangles, order[:, :, None], axis=1).swapaxes(0, 1)


def convex_hull(points: Array) -> Polyhedron | None:
    """The convex hull of points (n, 3); None if they lie in a plane."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    faces = hull.simplices.astype(np.int64)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    kept, faces = np.unique(faces, return_inverse=True)
    return Polyhedron(points[kept], faces.reshape(-1, 3))


def box(size: Sequence[float]) -> tuple[Array, Index]:
    """Vertices (8, 3) and faces (12, 3) of a box centered on the origin, sizes in m."""
    mesh = trimesh.creation.box(size)
    return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)
