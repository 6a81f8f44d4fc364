"""Normals of a faceted surface, rounded over a radius: they belong to the part, not to the mesh.

The normal at a point x is the mean of the faces' normals around it, where each point y of the
surface has the weight 1 - (d / r)^2. Here d is the radius of the smallest ball around x in which
the surface connects y with x. That is their distance, and more on the other side of a thin wall.
How the faces are divided into triangles does not matter (``docs/semantics.md``, section 1).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask, numbered, unit
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.parts.surface import SHARP, Surface
from cellcolor.mesh.triangle_mesh import TriangleMesh

_MOST_AROUND = 200_000_000  # faces around vertices; some microseconds each
_ROWS = 1000  # vertices that are rounded together
_AROUND = 25_000  # faces around vertices that are looked at together
_SAME = 1e-9  # of the radius; a ball that is smaller by less is no smaller
_BENT = 1e-6  # between the normals of two faces; less is a plane


def rounded(surface: Surface, radius: float, deadline: Deadline = NEVER) -> Surface:
    """A faceted surface with its normals rounded over a radius, m.

    A vertex whose own faces fill its ball keeps its normal: there the mean is that of the faces,
    weighted with their angles. So does one that has a plane around it.

    Args:
        surface: with the normals of its faces, weighted with their angles.
        radius: m.

    Raises:
        InputError: the radius holds too many triangles; names the key.
    """
    if not radius:
        return surface
    around = _Around.of(surface)
    asked = np.flatnonzero((_rims(surface) < radius) & around.is_bent(radius))
    size = float(around.mesh.areas.mean())
    within = min(np.pi * radius**2 / size, len(around.mesh.corners))
    if len(asked) * within > _MOST_AROUND:
        message = (
            f"holds about {within:,.0f} triangles, for each of {len(asked):,} vertices; at most "
            f"{_MOST_AROUND:,} are looked at: a smaller radius, or larger triangles"
        )
        raise InputError(None, "task.edge_radius_m", message)
    normals = surface.normals.copy()
    parts = [asked[first : first + _ROWS] for first in range(0, len(asked), _ROWS)]
    while parts:
        deadline.check()
        rows = parts.pop()
        found = around.means(rows, radius)
        if found is None:
            parts += np.array_split(rows, 2)
        else:
            normals[rows] = found
    return replace(surface, normals=normals, divided=None)


def note_on_triangles(surface: Surface, radius: float) -> tuple[str, ...]:
    """A sentence if triangles beside sharp edges are too long for normals rounded over a radius, m.

    Normals are known at vertices, and the tool turns evenly over the whole of a triangle between
    them, however it is rounded.
    """
    mesh = surface.mesh
    sharp = mesh.sharp_edges(SHARP)
    on = np.zeros(len(mesh.points), dtype=bool)
    on[mesh.edges[sharp]] = True
    beside = np.asarray(on[mesh.edges].any(axis=1))
    beside[sharp] = False
    longest = float(mesh.lengths[beside].max(initial=0.0))
    if longest <= radius / 2:
        return ()
    return (
        f"the minimum belongs to this mesh: beside sharp edges triangles are up to "
        f"{1e3 * longest:.2g} mm long, and normals are rounded over {1e3 * radius:g} mm; edges of "
        f"{500 * radius:g} mm (max_edge_m = {radius / 2:g} under [object]) may give another one",
    )


def _rims(surface: Surface) -> Array:
    """How near to each vertex (n,) the far side of one of its faces is."""
    points, faces = surface.vertices, surface.faces
    rims = np.full(len(points), np.inf)
    for corner in range(3):
        a, b, c = (faces[:, (corner + k) % 3] for k in range(3))
        np.minimum.at(rims, a, _distance(points[a], points[b], points[c]))
    return rims


@dataclass(frozen=True)
class _Around:
    """The vertices of a surface on its mesh before edges were halved.

    Halving an edge divides a face into triangles of one plane, so what counts are the whole faces.

    Attributes:
        points: (n, 3) the vertices, m.
        own: (p, 2) each vertex with each face of the mesh that it lies in, in order.
        mesh: the whole faces.
    """

    points: Array
    own: Index
    mesh: TriangleMesh

    @classmethod
    def of(cls, surface: Surface) -> _Around:
        mesh, lies_in = surface.divided or (surface.mesh, np.arange(len(surface.faces)))
        count = len(mesh.corners)
        own = np.unique(surface.faces * count + lies_in[:, None])
        return cls(surface.vertices, np.column_stack(np.divmod(own, count)), mesh)

    def is_bent(self, radius: float) -> Mask:
        """Which vertices (n,) may have another plane than their own faces' within a radius."""
        mesh, unit = self.mesh, self.mesh.triangle_normals
        edges, sides = mesh.pairs
        chord = unit[sides[:, 0] // 3] - unit[sides[:, 1] // 3]
        ends = mesh.points[mesh.edges[edges[np.linalg.norm(chord, axis=1) > _BENT]]]
        # Points on the edges, none of them farther than half the radius from the next.
        steps = np.ceil(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / radius * 2).astype(int)
        edge, step = numbered(steps + 1)
        at = (step / steps[edge])[:, None]
        points = (1 - at) * ends[edge, 0] + at * ends[edge, 1]
        if not len(points):
            return np.zeros(len(self.points), dtype=bool)
        return np.asarray(cKDTree(points).query(self.points)[0] < 1.25 * radius)

    def means(self, rows: Index, radius: float) -> Array | None:
        """Unit normals (k, 3) at some vertices, rounded over a radius; None: they are too many."""
        reached = self._reached(rows, radius)
        if reached is None:
            return None
        which, face, ball = reached
        corners = self.mesh.points[self.mesh.corners[face]] - self.points[rows[which]][:, None]
        normals = self.mesh.triangle_normals[face]
        weights = _weights(corners, normals, ball, radius)
        sums = np.zeros((len(rows), 3))
        np.add.at(sums, which, weights[:, None] * normals)
        return unit(sums)

    def _reached(self, rows: Index, radius: float) -> tuple[Index, Index, Array] | None:
        """The faces that balls around vertices reach, in them, from the vertices' own faces.

        Returns:
            Numbers (p,) of rows, a face of each, and the radius of the smallest ball in which they
            are connected; 0 of a vertex's own faces. None if that is too much.
        """
        faces, points, count = self.mesh.corners, self.mesh.points, len(self.mesh.corners)
        beyond = self.mesh.beyond
        begin, end = (np.searchsorted(self.own[:, 0], rows, side) for side in ("left", "right"))
        which, number = numbered(end - begin)
        face = self.own[begin[which] + number, 1]
        known = which * count + face
        ball = its_ball = np.zeros(len(known))
        while len(which):
            at_points, corners = self.points[rows[which]], faces[face]
            sides = [points[corners[:, side]] for side in (0, 1, 2, 0)]
            pairs = []
            for side in range(3):
                across = beyond[face, side]
                least = np.maximum(its_ball, _distance(at_points, *sides[side : side + 2]))
                going = (across >= 0) & (least < radius)
                pairs.append((which[going], across[going], least[going]))
            which, face, its_ball = map(np.concatenate, zip(*pairs, strict=True))
            new, first, its_ball = _least(which * count + face, its_ball)
            which, face = which[first], face[first]
            at = np.minimum(np.searchsorted(known, new), len(known) - 1)
            there = known[at] == new
            better = ~there | (its_ball < ball[at] - _SAME * radius)
            ball[at[there & better]] = its_ball[there & better]
            at = np.searchsorted(known, new[~there])
            known, ball = np.insert(known, at, new[~there]), np.insert(ball, at, its_ball[~there])
            which, face, its_ball = which[better], face[better], its_ball[better]
            if len(known) > _AROUND and len(rows) > 1:
                return None
        which, face = np.divmod(known, count)
        return which, face, ball


def _least(keys: Index, values: Array) -> tuple[Index, Index, Array]:
    """Each key once, in order, with a place where it stands, and its least value."""
    if not len(keys):
        return keys, keys, values
    order = np.argsort(keys)
    begins = np.flatnonzero(np.diff(keys[order], prepend=-1) > 0)
    first = order[begins]
    return keys[first], first, np.minimum.reduceat(values[order], begins)


def _distance(points: Array, a: Array, b: Array) -> Array:
    """How far points (k, 3) are from the segments between a and b."""
    way = b - a
    at = np.einsum("ij,ij->i", points - a, way) / np.einsum("ij,ij->i", way, way)
    return np.asarray(np.linalg.norm(a + np.clip(at, 0.0, 1.0)[:, None] * way - points, axis=1))


def _weights(corners: Array, unit: Array, ball: Array, radius: float) -> Array:
    """Integrals (p,) of 1 - (max(d, ball) / radius)^2, while positive, over triangles.

    Args:
        corners: (p, 3, 3) of the triangles, seen from the point that distances d are taken from.
        unit: (p, 3) normals of the triangles.
        ball: (p,) see above.
    """
    height = np.einsum("ij,ij->i", corners[:, 0], unit)
    flat = corners - height[:, None, None] * unit[:, None]

    def within(reach: Array) -> tuple[Array, Array]:
        return _disc(flat, unit, np.sqrt(np.maximum(reach**2 - height**2, 0.0)))

    area, second = within(np.full(len(ball), radius))
    whole = area - (height**2 * area + second) / radius**2
    area, second = within(ball)
    return np.asarray(whole - (ball**2 * area - height**2 * area - second) / radius**2)


def _disc(corners: Array, unit: Array, size: Array) -> tuple[Array, Array]:
    """What triangles have in common with discs (p,) around the origin of their planes.

    Returns:
        Area, and the integral of the squared distance from the origin.
    """
    area, second = np.zeros((2, len(corners)))
    for side in range(3):
        a, b = corners[:, side], corners[:, (side + 1) % 3]
        way = b - a
        square = np.einsum("ij,ij->i", way, way)
        half = np.einsum("ij,ij->i", a, way) / square
        under = half**2 - (np.einsum("ij,ij->i", a, a) - size**2) / square
        root = np.sqrt(np.maximum(under, 0.0))
        enter, leave = np.clip(-half - root, 0.0, 1.0), np.clip(-half + root, 0.0, 1.0)
        # Where a side ends inside, no rounding may make an angle out of its end.
        p, q = a + enter[:, None] * way, np.where(leave[:, None] < 1, a + leave[:, None] * way, b)
        for u, v in ((a, p), (q, b)):
            angle = np.arctan2(_cross(u, v, unit), np.einsum("ij,ij->i", u, v))
            area += size**2 * angle / 2
            second += size**4 * angle / 4
        doubled = _cross(p, q, unit)
        area += doubled / 2
        products = [np.einsum("ij,ij->i", *pair) for pair in ((p, p), (p, q), (q, q))]
        second += doubled / 12 * sum(products)
    return area, second


def _cross(u: Array, v: Array, unit: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", np.cross(u, v), unit))
