"""The surface in triangles much smaller than the tool, to measure on and to find points on.

Bisecting, areas, edges and nearest points are trimesh's, not those of ``cellcolor.mesh``: shared
with what plans and paints, a mistake in them would be made and approved alike.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
import trimesh
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask, unit
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge
from cellcolor.frontend.parts.surface import Surface
from cellcolor.memory import chunks

_MOST = 2_000_000  # small triangles; some hundred bytes each
_NEIGHBORS = 8  # how many small triangles are compared at first to find the nearest to a point
_UNIT = 1e-6  # m; sides much shorter than one unit are nothing to trimesh
_NEAR = 0.02  # m; for points farther off, a triangle that is nearly the nearest will do


@dataclass(frozen=True)
class Located:
    """Where points are on a fine mesh: on the nearest small triangle that faces their way.

    Attributes:
        triangle: (k,) the small triangle.
        points: (k, 3) the nearest point of it, m.
        normals: (k, 3) the surface's interpolated unit normal there.
        owner: (k,) the vertex of the given surface whose barycentric part it is in.
    """

    triangle: Index
    points: Array
    normals: Array
    owner: Index

    def take(self, which: Mask) -> Located:
        """Some of them."""
        return Located(*(getattr(self, field.name)[which] for field in fields(self)))


@dataclass(frozen=True)
class FineMesh:
    """A surface refined.

    Attributes:
        surface: the given surface.
        mesh: the small triangles; its vertices (n, 3), m, begin with those of the given surface.
        normals: (n, 3) the given surface's interpolated unit normals at the vertices.
        face: (m,) which face of the given surface each small triangle is a part of.
        away: a triangle that faces away from the tool counts as so much farther, m, while others do
            not; infinite where the tool is held against the normal.
    """

    surface: Surface
    mesh: trimesh.Trimesh
    normals: Array
    face: Index
    away: float = np.inf

    @cached_property
    def vertices(self) -> Array:
        """(n, 3), m."""
        return np.asarray(self.mesh.vertices)

    @cached_property
    def triangles(self) -> Index:
        """(m, 3) the vertices of each small triangle."""
        return np.asarray(self.mesh.faces)

    @cached_property
    def owner(self) -> Index:
        """(m,) the vertex of the given surface in whose barycentric part its centroid is."""
        return self._owners(self.face, self.mesh.triangles_center)

    @cached_property
    def near(self) -> csr_array:
        """(n, n) distances of vertices that an edge or two join, m.

        A way along these is longer than the shortest one on the surface, by some percent: with
        single edges alone it would be up to a sixth.
        """
        edges, n = self.mesh.edges_unique, len(self.vertices)
        one = csr_array((np.ones(len(edges), dtype=np.int8), tuple(edges.T)), shape=(n, n))
        one = one + one.T
        both = (one + one @ one).tocsr()
        i, j = np.repeat(np.arange(n), np.diff(both.indptr)), both.indices
        apart = np.sqrt(sum((x[i] - x[j]) ** 2 for x in self.vertices.T))
        return csr_array((apart, both.indices, both.indptr), shape=(n, n))

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.mesh.triangles_center)

    @cached_property
    def _radius(self) -> float:
        """No point of a small triangle is farther from its centroid, m."""
        apart = np.linalg.norm(self.mesh.triangles - self.mesh.triangles_center[:, None], axis=2)
        return float(apart.max())

    def locate(self, points: Array, outward: Array, deadline: Deadline = NEVER) -> Located:
        """The nearest points of the surface.

        Of a thin sheet, the side whose normals are less than 90 degrees off is meant, if one is
        (``away`` says how much farther off it may be).
        Points farther off than 20 mm may get one that is only nearly the nearest.

        Args:
            points: (k, 3) in m.
            outward: (k, 3) against the tool's axis.
        """
        triangle, at = np.zeros(len(points), dtype=np.int64), np.zeros((len(points), 3))
        rows, asked = np.arange(len(points)), min(_NEIGHBORS, len(self.triangles))
        while len(rows):
            unsure = []
            for some in chunks(len(rows), asked // 4):
                deadline.check()
                part = rows[some]
                apart, farthest, triangle[part], at[part] = self._nearest_of(
                    points[part], outward[part], asked
                )
                # A triangle that was not asked has its centroid farther off than all that were.
                open_ = (apart > farthest - self._radius) & (apart < _NEAR)
                unsure.append(part[open_])
            rows = np.concatenate(unsure)
            if asked == len(self.triangles):
                break
            asked = min(4 * asked, len(self.triangles))
        faces = self.face[triangle]
        given = self.surface.normals[self.surface.faces[faces]]
        normals = unit(np.einsum("kc,kcd->kd", self._shares(faces, at), given))
        return Located(triangle, at, normals, self._owners(faces, at))

    def may_be_near(self, points: Array, distance: float) -> Mask:
        """Which points (k, 3) may be within a distance (m) of the surface; no other one is."""
        # Sums are rounded, so a hair more.
        far = self._tree.query(points, distance_upper_bound=1.001 * (self._radius + distance))[0]
        return np.asarray(np.isfinite(far))

    def _nearest_of(
        self, points: Array, outward: Array, asked: int
    ) -> tuple[Array, Array, Index, Array]:
        """For each point (k,): its distance, that of the last centroid tried, triangle, place."""
        far, candidates = self._tree.query(points, k=asked)
        far, candidates = far.reshape(-1, asked), candidates.reshape(-1, asked)
        corners = self.mesh.triangles[candidates.ravel()] / _UNIT
        nearest = trimesh.triangles.closest_point(corners, np.repeat(points, asked, 0) / _UNIT)
        nearest = _UNIT * nearest.reshape(-1, asked, 3)
        apart = np.linalg.norm(nearest - points[:, None], axis=2)
        facing = np.einsum("kqd,kd->kq", self.mesh.face_normals[candidates], outward) > 0
        # Where none of those asked faces this way, the nearest one will do.
        apart = np.where(facing | ~facing.any(axis=1, keepdims=True), apart, apart + self.away)
        k, best = np.arange(len(points)), np.argmin(apart, axis=1)
        return apart[k, best], far[:, -1], candidates[k, best], nearest[k, best]

    def _shares(self, faces: Index, places: Array) -> Array:
        """Barycentric coordinates (k, 3) of places (k, 3) in faces (k,) of the given surface."""
        corners = self.surface.vertices[self.surface.faces[faces]]
        with np.errstate(divide="ignore", invalid="ignore"):  # faces without any area
            shares = trimesh.triangles.points_to_barycentric(corners, places)
        return np.where(np.isfinite(shares).all(axis=1, keepdims=True), shares, 1 / 3)

    def _owners(self, faces: Index, places: Array) -> Index:
        nearest = np.argmax(self._shares(faces, places), axis=1)
        return np.asarray(self.surface.faces[faces, nearest])


def refined(surface: Surface, longest: float, deadline: Deadline) -> FineMesh:
    """A surface with every edge longer than ``longest`` (m) bisected until none is left.

    Raises:
        TooLarge: there would be millions of small triangles.
    """
    # Normals are interpolated like points. Edges are shortened to half and half again, so that what
    # would not fit into memory is seen early: each side that is halved makes one triangle more.
    rows, faces = np.hstack([surface.vertices, surface.normals]), surface.faces
    face, limit = np.arange(len(faces)), np.inf
    while limit > longest:
        deadline.check()
        sides = np.linalg.norm(np.diff(rows[faces[:, [0, 1, 2, 0]], :3], axis=1), axis=2)
        limit = max(longest, float(sides.max()) / 2)
        if len(faces) + int((sides > limit).sum()) > _MOST:
            message = f"more than {_MOST} triangles with edges of {1000 * longest:.3g} mm"
            raise TooLarge(f"the surface is too large to be judged at this spacing: {message}")
        rows, faces, part = trimesh.remesh.subdivide_to_size(rows, faces, limit, return_index=True)
        face = face[part]
    mesh = trimesh.Trimesh(rows[:, :3], faces, process=False, validate=False)
    return FineMesh(surface, mesh, unit(rows[:, 3:]), face)
