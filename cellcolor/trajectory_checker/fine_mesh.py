"""The surface in triangles much smaller than the tool, to measure on and to find points on.

Edges, areas, bisecting and locating are the judge's own on purpose, beside ``cellcolor.mesh``:
shared with what plans and paints, a mistake in them would be made and approved alike.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge
from cellcolor.frontend.parts.surface import Surface
from cellcolor.memory import chunks

_MOST = 2_000_000  # small triangles; some hundred bytes each
_NEIGHBORS = 8  # how many small triangles are compared at first to find the nearest to a point
_PAIR = 1_024  # bytes that a point and a small triangle take
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
        vertices: (n, 3) in m; those of the given surface come first.
        triangles: (m, 3).
        face: (m,) which face of the given surface each small triangle is a part of.
        corners: (m, 3, 3) barycentric coordinates, in that face, of each of its corners.
        away: a triangle that faces away from the tool counts as so much farther, m, while others do
            not; infinite where the tool is held against the normal.
    """

    surface: Surface
    vertices: Array
    triangles: Index
    face: Index
    corners: Array
    away: float = np.inf

    @cached_property
    def areas(self) -> Array:
        """(m,) in m²."""
        doubled: Array = np.linalg.norm(self._doubled_normals, axis=1)
        return doubled / 2

    @property
    def _doubled_normals(self) -> Array:
        a, b, c = (self.vertices[self.triangles[:, corner]] for corner in range(3))
        return np.cross(b - a, c - a)

    @cached_property
    def owner(self) -> Index:
        """(m,) the vertex of the given surface in whose barycentric part its centroid is."""
        return self._owners(self.face, self.corners.mean(axis=1))

    @cached_property
    def normals(self) -> Array:
        """(n, 3) the given surface's interpolated unit normals."""
        normals = np.empty_like(self.vertices)
        given = self.surface.normals[self.surface.faces[self.face]]
        for corner in range(3):
            mixed = np.einsum("kc,kcd->kd", self.corners[:, corner], given)
            normals[self.triangles[:, corner]] = mixed
        return _unit(normals)

    @cached_property
    def near(self) -> csr_array:
        """(n, n) distances of vertices that an edge or two join, m.

        A way along these is longer than the shortest one on the surface, by some percent: with
        single edges alone it would be up to a sixth.
        """
        edges, n = _edges(self.triangles), len(self.vertices)
        one = csr_array((np.ones(len(edges), dtype=np.int8), tuple(edges.T)), shape=(n, n))
        one = one + one.T
        both = (one + one @ one).tocsr()
        i, j = np.repeat(np.arange(n), np.diff(both.indptr)), both.indices
        apart = np.sqrt(sum((x[i] - x[j]) ** 2 for x in self.vertices.T))
        return csr_array((apart, both.indices, both.indptr), shape=(n, n))

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.vertices[self.triangles].mean(axis=1))

    @cached_property
    def _radius(self) -> float:
        """No point of a small triangle is farther from its centroid, m."""
        corners = self.vertices[self.triangles]
        apart = np.linalg.norm(corners - corners.mean(axis=1, keepdims=True), axis=2)
        return float(apart.max())

    @cached_property
    def _facing(self) -> Array:
        return _unit(self._doubled_normals)

    def locate(self, points: Array, outward: Array, deadline: Deadline = NEVER) -> Located:
        """The nearest points of the surface.

        Of a thin sheet, the side whose normals are less than 90 degrees off is meant, if one is
        (``away`` says how much farther off it may be).
        Points farther off than 20 mm may get one that is only nearly the nearest.

        Args:
            points: (k, 3) in m.
            outward: (k, 3) against the tool's axis.
        """
        triangle = np.zeros(len(points), dtype=np.int64)
        weights = np.zeros((len(points), 3))
        rows, asked = np.arange(len(points)), min(_NEIGHBORS, len(self.triangles))
        while len(rows):
            unsure = []
            for some in chunks(len(rows), asked * _PAIR):
                deadline.check()
                part = rows[some]
                apart, farthest, found, inside = self._nearest_of(
                    points[part], outward[part], asked
                )
                triangle[part], weights[part] = found, inside
                # A triangle that was not asked has its centroid farther off than all that were.
                open_ = (apart > farthest - self._radius) & (apart < _NEAR)
                unsure.append(part[open_])
            rows = np.concatenate(unsure)
            if asked == len(self.triangles):
                break
            asked = min(4 * asked, len(self.triangles))
        at = np.einsum("kc,kcd->kd", weights, self.vertices[self.triangles[triangle]])
        within = np.einsum("kc,kcd->kd", weights, self.corners[triangle])
        faces = self.face[triangle]
        given = self.surface.normals[self.surface.faces[faces]]
        normals = _unit(np.einsum("kc,kcd->kd", within, given))
        return Located(triangle, at, normals, self._owners(faces, within))

    def may_be_near(self, points: Array, distance: float) -> Mask:
        """Which points (k, 3) may be within a distance (m) of the surface; no other one is."""
        # Sums are rounded, so a hair more.
        far = self._tree.query(points, distance_upper_bound=1.001 * (self._radius + distance))[0]
        return np.asarray(np.isfinite(far))

    def _nearest_of(
        self, points: Array, outward: Array, asked: int
    ) -> tuple[Array, Array, Index, Array]:
        """For each point (k,): its distance, that of the last centroid tried, triangle, weights."""
        far, candidates = self._tree.query(points, k=asked)
        far, candidates = far.reshape(-1, asked), candidates.reshape(-1, asked)
        corners = self.vertices[self.triangles[candidates]]
        weights = _closest_weights(points[:, None], corners)
        nearest = np.einsum("kqc,kqcd->kqd", weights, corners)
        apart = np.linalg.norm(nearest - points[:, None], axis=2)
        facing = np.einsum("kqd,kd->kq", self._facing[candidates], outward) > 0
        # Where none of those asked faces this way, the nearest one will do.
        apart = np.where(facing | ~facing.any(axis=1, keepdims=True), apart, apart + self.away)
        best = np.argmin(apart, axis=1)
        k = np.arange(len(points))
        return apart[k, best], far[:, -1], candidates[k, best], weights[k, best]

    def _owners(self, faces: Index, within: Array) -> Index:
        owners: Index = self.surface.faces[faces, np.argmax(within, axis=1)]
        return owners


def refined(surface: Surface, longest: float, deadline: Deadline) -> FineMesh:
    """A surface with every edge longer than ``longest`` (m) bisected until none is left.

    Raises:
        TooLarge: there would be millions of small triangles.
    """
    vertices, triangles = surface.vertices, np.array(surface.faces, dtype=np.int64)
    face = np.arange(len(triangles))
    corners = np.tile(np.eye(3), (len(triangles), 1, 1))
    while True:
        deadline.check()
        edges = _edges(triangles)
        lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
        split = edges[lengths > longest]
        if not len(split):
            return FineMesh(surface, vertices, triangles, face, corners)
        if len(triangles) + 2 * len(split) > _MOST:
            message = f"more than {_MOST} triangles with edges of {1000 * longest:.3g} mm"
            raise TooLarge(f"the surface is too large to be judged at this spacing: {message}")
        middle = np.arange(len(vertices), len(vertices) + len(split))
        vertices = np.concatenate([vertices, vertices[split].mean(axis=1)])
        triangles, face, corners = _bisected(triangles, face, corners, split, middle)


def _edges(triangles: Index) -> Index:
    """Every edge (k, 2) once, smaller vertex first, in lexicographic order."""
    size = int(triangles.max()) + 1
    one, other = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    # One number a side sorts many times faster than pairs do.
    keys = np.sort(np.minimum(one, other) * size + np.maximum(one, other))
    return np.column_stack(np.divmod(keys[np.diff(keys, prepend=-1) > 0], size))


def _bisected(
    triangles: Index, face: Index, corners: Array, split: Index, middle: Index
) -> tuple[Index, Index, Array]:
    """Triangles with the middles of some of their edges as new corners.

    Args:
        split: (s, 2) the edges, smaller vertex first, in lexicographic order.
        middle: (s,) the vertex in the middle of each.
    """
    size = int(triangles.max()) + 1
    keys = split[:, 0] * size + split[:, 1]
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    wanted = sides[..., 0] * size + sides[..., 1]
    place = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    is_split = keys[place] == wanted
    # Turned so that split edges come first: edge c leads from corner c to corner c + 1.
    count = is_split.sum(axis=1)
    turn = np.where(count == 1, np.argmax(is_split, axis=1), 0)
    turn = np.where(count == 2, (np.argmin(is_split, axis=1) + 1) % 3, turn)
    order = (turn[:, None] + np.arange(3)) % 3
    row = np.arange(len(triangles))[:, None]
    mids = middle[place][row, order]
    at, own = triangles[row, order], corners[row, order]
    half = (own + np.roll(own, -1, axis=1)) / 2
    names = np.concatenate([at, mids], axis=1)
    places = np.concatenate([own, half], axis=1)
    # Corners 0 1 2, middles 3 (of 0-1), 4 (of 1-2), 5 (of 2-0).
    patterns = {
        0: [(0, 1, 2)],
        1: [(0, 3, 2), (3, 1, 2)],
        2: [(3, 1, 4), (0, 3, 4), (0, 4, 2)],
        3: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    }
    parts = [
        (names[rows][:, list(three)], face[rows], places[rows][:, list(three)])
        for number, pattern in patterns.items()
        for rows in [np.flatnonzero(count == number)]
        for three in pattern
    ]
    new_triangles, new_face, new_corners = zip(*parts, strict=True)
    return np.concatenate(new_triangles), np.concatenate(new_face), np.concatenate(new_corners)


def _closest_weights(points: Array, corners: Array) -> Array:
    """Barycentric coordinates (..., 3) of the nearest points of triangles (..., 3, 3)."""
    a, b, c = (corners[..., k, :] for k in range(3))
    ab, ac, ap = b - a, c - a, points - a
    d00, d01, d11 = _dot(ab, ab), _dot(ab, ac), _dot(ac, ac)
    d20, d21 = _dot(ap, ab), _dot(ap, ac)
    scale = d00 * d11 - d01 * d01
    safe = np.where(scale > 0, scale, 1.0)
    v, w = (d11 * d20 - d01 * d21) / safe, (d00 * d21 - d01 * d20) / safe
    weights = np.stack([1 - v - w, v, w], axis=-1)
    outside = (weights < 0).any(axis=-1) | (scale <= 0)
    # Outside, the nearest point is on one of the edges.
    best = np.full(outside.shape, np.inf)
    for first, second in ((0, 1), (1, 2), (2, 0)):
        start, along = corners[..., first, :], corners[..., second, :] - corners[..., first, :]
        squared = _dot(along, along)
        way = _dot(points - start, along) / np.where(squared > 0, squared, 1.0)
        way = np.clip(way, 0.0, 1.0)
        apart = points - start - way[..., None] * along
        closer = outside & (_dot(apart, apart) < best)
        best = np.where(closer, _dot(apart, apart), best)
        on_edge = np.zeros_like(weights)
        on_edge[..., first], on_edge[..., second] = 1 - way, way
        weights = np.where(closer[..., None], on_edge, weights)
    return weights


def _dot(one: Array, other: Array) -> Array:
    return np.asarray((one * other).sum(axis=-1))


def _unit(vectors: Array) -> Array:
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0, lengths, 1.0))
