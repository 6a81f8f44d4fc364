"""Stationary things: the object and the obstacles, prepared for many queries.

A body is tested by distances of points on its axis, all configurations at once. A slice of the
body is clear if a ball around it is clear. A ball in the body that reaches the solid is a hit.
Anything in between is halved. A grid gives the distance to a mesh. Where the grid's spacing leaves
a doubt, the nearest of many samples of the mesh gives it. Only cases within some tenths of a
millimeter of a contact reach fcl.

The samples are dense enough for their distance to give that of the mesh: the way from a point in
space to the nearest point of a mesh is at right angles to its face or edge. So a sample of the same
face or edge within ``slack`` of that point is hardly farther away. All corners are samples.
"""

from __future__ import annotations

from collections.abc import Callable

import fcl
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask, cuts
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses
from cellcolor.frontend.arm.polyhedron import longest_side_first, one_of_each_part
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.fcl_bodies import (
    Thing,
    body_poses,
    mesh_model,
    points_of,
    touch_thing,
)
from cellcolor.frontend.parts.placement import Placement, rotation_from_rpy
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

_FINEST = 0.002  # m; half a slice that is left to fcl rather than halved again
_FINEST_AROUND = 0.02  # m; the same of the capsule around a solid, which is not close anyway
_CLOSE = 0.025  # m; half a slice from which on the nearest sample is worth its price
_SPACING = 0.003  # m; wanted distance of a mesh's points to the nearest sample
_SAMPLES = 500_000  # about the most; large objects are sampled more coarsely
_PITCH, _PARTS = 0.006, 80  # of the grid: m, or parts of the longest side of a large object
_ROUNDING = 1e-9  # m
_AROUND = 0.06  # m; how far the grid extends beyond the object

Rows = NDArray[np.intp]
Distances = Callable[[Array], tuple[Array, Array]]
"""Points (k, 3) to a lower and an upper bound (k,) of their distance from the solid in m."""
Near = Callable[[Array, float], tuple[Array, Array]]
"""The same with closer bounds, as far as a distance is below a given one; others are infinite."""


class Solid:
    """A stationary thing, for fcl and as bounds of distances from points.

    A mesh is a shell: a body wholly inside a closed one does not touch it. That cannot happen
    unnoticed to an arm whose bodies touch one another in a row and of which a part is outside.

    ``width`` is the second of its three extents, in m: of a plate not how thick it is.
    """

    def __init__(
        self,
        shape: fcl.CollisionGeometry,
        width: float,
        distances: Distances,
        near: Near | None = None,
        parts: Array | None = None,
    ) -> None:
        """In its own frame; ``parts`` has a point (k, 3) of each part of it, the origin without."""
        self.width = width
        self._shape, self._parts = shape, np.zeros((1, 3)) if parts is None else parts
        self._distances, self._near = distances, near
        self._thing = Thing(fcl.CollisionObject(shape, fcl.Transform()), self._parts)

    def placed(self, placement: Placement) -> Solid:
        """The solid moved from its own frame into place, without building it again."""
        turn, origin = rotation_from_rpy(*placement.rpy_rad), np.array(placement.position_m)
        distances, near = self._distances, self._near

        def distances_there(points: Array) -> tuple[Array, Array]:
            return distances((points - origin) @ turn)

        def near_there(points: Array, reach: float) -> tuple[Array, Array]:
            assert near is not None
            return near((points - origin) @ turn, reach)

        there = Solid(self._shape, self.width, distances_there, near and near_there)
        shape = fcl.CollisionObject(self._shape, fcl.Transform(turn, origin))
        there._thing = Thing(shape, placement.placed(self._parts))
        return there

    def hits(self, robot: Robot, ends: Array, poses: Poses | None = None) -> Mask:
        """Whether any moving body touches the solid, (n,).

        Args:
            ends: (bodies, 2, n, 3), see :func:`~cellcolor.frontend.contact.collision.body_ends`.
            poses: of the joints; robots without solids do not need them.
        """
        hit = np.zeros(ends.shape[2], dtype=bool)
        moving = [index for index, body in enumerate(robot.bodies) if body.joint > 0]
        # Balls around whole bodies first, those of all bodies at once.
        middles = ends[moving].mean(axis=1)
        wholes = np.array([_around_whole(robot.bodies[index]) for index in moving])
        apart = self.at_least(middles.reshape(-1, 3)).reshape(middles.shape[:2])
        near = apart <= wholes[:, None]
        # From the tool to the base: what is near the object is tested first.
        for index, nearby in zip(reversed(moving), near[::-1], strict=True):
            rows = np.flatnonzero(nearby & ~hit)
            if not len(rows):
                continue
            body = robot.bodies[index]
            chosen = None if poses is None or body.solid is None else poses.take(rows)
            hit[rows] = self.touched_by(body, ends[index][:, rows], chosen)
        return hit

    def touched_by(self, body: Body, ends: Array, poses: Poses | None = None) -> Mask:
        """Whether one body touches the solid, (n,); ``ends`` (2, n, 3) are those of its axis."""
        touching, open_ = self._sweep(body, ends)
        if body.solid is not None:
            touching |= self._encloses(body, ends, poses, open_)
            open_ &= ~touching
        asked = np.flatnonzero(open_)
        if len(asked):
            chosen = None if poses is None or body.solid is None else poses.take(asked)
            touching[asked] = self._touches(body, ends[:, asked], chosen)
        return touching

    def _encloses(self, body: Body, ends: Array, poses: Poses | None, asked: Mask) -> Mask:
        """Whether a point of a part of a body is inside what is filled, (n,), where asked.

        What is filled is at no distance there; with a shell that never comes out.
        """
        rows = np.flatnonzero(asked)
        turns, origins = body_poses(body, ends, poses)
        points = points_of(body, (turns[rows], origins[rows]))
        inside = np.zeros(len(asked), dtype=bool)
        at_most = self._distances(points.reshape(-1, 3))[1].reshape(points.shape[:2])
        inside[rows] = (at_most <= 0.0).any(axis=1)
        return inside

    def at_least(self, points: Array) -> Array:
        """Lower bounds (k,) of the distances of points (k, 3), m."""
        return self._distances(points)[0]

    def meets(self, mesh: Solid) -> bool:
        """Whether a face of a mesh touches it; a mesh that is wholly inside does not."""
        request, result = fcl.CollisionRequest(), fcl.CollisionResult()
        return bool(fcl.collide(self._thing.shape, mesh._thing.shape, request, result) > 0)

    def touched_by_fixed(self, robot: Robot, ends: Array, poses: Poses | None = None) -> str | None:
        """The link of the robot that cannot move and touches the solid, if there is one."""
        for body, both in zip(robot.bodies, ends, strict=True):
            if body.joint == 0 and self._touches(body, both, poses).any():
                return body.link
        return None

    def _sweep(self, body: Body, ends: Array) -> tuple[Mask, Mask]:
        """Sure hits (n,), and what is left open (n,); the others are clear.

        A body is made of slices across its axis and, if its ends are round, of two balls there. Of
        the capsule around a body with flat faces no hit is sure.
        """
        finest = _FINEST if body.solid is None else _FINEST_AROUND
        start, along = ends[0], ends[1] - ends[0]
        hit, left_open = np.zeros(len(start), dtype=bool), np.zeros(len(start), dtype=bool)

        def ask(rows: Rows, place: Array, half: float, around: float) -> Mask:
            """Are balls of the radius ``around`` about points of the axis in doubt?"""
            # A ball about a point of the axis lies in the body if it does not leave its ends.
            inside = np.full(len(rows), body.radius)
            if body.solid is not None:
                inside = np.full(len(rows), -1.0)
            elif body.flat:
                inside = np.minimum(inside, body.length * np.minimum(place, 1 - place))
            points = start[rows] + place[:, None] * along[rows]
            near, far = self._distances(points)
            hit[rows[far <= inside]] = True
            doubtful: Mask = (near <= around) & ~hit[rows]
            if self._near is not None and half <= _CLOSE:
                again = np.flatnonzero(doubtful)
                near, far = self._near(points[again], around)
                hit[rows[again[far <= inside[again]]]] = True
                doubtful[again] = (near <= around) & ~hit[rows[again]]
            return doubtful

        half = body.length / 2
        rows, place = np.arange(len(start)), np.full(len(start), 0.5)
        rows = rows[ask(rows, place, half, _around_whole(body))]
        if body.length == 0:
            left_open[rows] = True
            return hit, left_open
        if not body.flat:
            for end in (0.0, 1.0):
                asked = rows[~hit[rows]]
                doubt = ask(asked, np.full(len(asked), end), 0.0, body.radius)
                left_open[asked[doubt]] = True
        # One hit or one open end is enough: the rest of that body is not looked at.
        rows = rows[~(hit | left_open)[rows]]
        place = np.full(len(rows), 0.5)
        while len(rows):
            doubtful = ask(rows, place, half, float(np.hypot(half, body.radius)))
            doubtful &= ~hit[rows]
            if half <= finest:
                left_open[rows[doubtful]] = True
                break
            half /= 2
            step = half / body.length
            rows = np.repeat(rows[doubtful], 2)
            place = (place[doubtful][:, None] + [-step, step]).ravel()
        return hit, left_open & ~hit

    def _touches(self, body: Body, ends: Array, poses: Poses | None = None) -> Mask:
        """By fcl, one after the other: ends (2, n, 3) to (n,)."""
        return touch_thing(body, body_poses(body, ends, poses), self._thing)


def _around_whole(body: Body) -> float:
    """Radius of the smallest ball around a body, m."""
    half = body.length / 2
    return float(np.hypot(half, body.radius)) if body.flat else half + body.radius


def mesh_solid(vertices: Array, faces: Faces, deadline: Deadline = NEVER) -> Solid:
    """A triangle mesh in its own frame."""
    deadline.check()
    model = mesh_model(vertices, faces)
    deadline.check()
    samples, slack = sample_mesh(vertices, faces, _SPACING, _SAMPLES)
    lowest, highest = vertices.min(axis=0), vertices.max(axis=0)
    extent = highest - lowest
    pitch = max(_PITCH, float(extent.max()) / _PARTS)
    origin = lowest - _AROUND
    counts = np.ceil((extent + 2 * _AROUND) / pitch).astype(int) + 1
    empty = np.ones(counts, dtype=bool)
    empty[tuple(np.rint((samples - origin) / pitch).astype(int).T)] = False
    grid = pitch * distance_transform_edt(empty)
    # A sample is at most half a diagonal from the middle of its cell.
    half_diagonal = pitch * np.sqrt(3) / 2

    def distances(points: Array) -> tuple[Array, Array]:
        beyond = np.maximum(np.maximum(lowest - points, points - highest), 0.0)
        place = (points - origin) / pitch
        index = np.clip(np.rint(place).astype(int), 0, counts - 1)
        off = place - index
        off_by = pitch * np.sqrt(np.einsum("ij,ij->i", off, off)) + half_diagonal
        stored = grid[index[:, 0], index[:, 1], index[:, 2]]
        outside = np.sqrt(np.einsum("ij,ij->i", beyond, beyond))
        return np.maximum(outside, to_mesh(stored - off_by)), stored + off_by

    deadline.check()
    tree = cKDTree(samples, balanced_tree=False, compact_nodes=False)

    def near(points: Array, reach: float) -> tuple[Array, Array]:
        to_sample, _ = tree.query(points, distance_upper_bound=np.hypot(reach, slack) + _ROUNDING)
        return to_mesh(to_sample), to_sample

    def to_mesh(to_sample: Array) -> Array:
        """A lower bound of distances from the mesh, from one of those to the nearest sample.

        The way from a point to the nearest one of the mesh is at right angles to the face or the
        edge that this lies on, and a sample on these is at most ``slack`` aside of it; corners
        are samples.
        """
        return np.sqrt(np.maximum(np.maximum(to_sample, 0.0) ** 2 - slack**2, 0.0))

    parts = one_of_each_part(vertices, faces)
    return Solid(model, sorted(extent.tolist())[1], distances, near, parts)


def sample_mesh(vertices: Array, faces: Faces, slack: float, most: int) -> tuple[Array, float]:
    """Points (k, 3) on all faces and edges, and how far these can be from the nearest of their own.

    Edges are cut into equal parts. A face is crossed by rows of points along its longest side, so
    that a long thin face has about as many as its edges, and never as many as a square of its
    length. Between two rows a point is nearer than half their distance to one of them, or to the
    side where the upper one ends, since the angles at the longest side are acute; along rows and
    edges it is nearer than half their step to a point. So with steps of s the slack is s / sqrt(2).

    Args:
        vertices: (n, 3) in m.
        faces: (m, 3), none of them without area.
        slack: wanted, m.
        most: about the most points besides the vertices; the slack grows to stay below.
    """
    mesh = TriangleMesh(vertices, faces)
    edges, lengths = mesh.edges, mesh.lengths
    a, b, c = longest_side_first(vertices[faces])
    double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    height = double_area / np.linalg.norm(b - a, axis=1)
    # Of n points at steps of s about length / s lie on edges and area / s^2 on faces.
    half = (lengths.sum() + 2 * height.sum()) / (2 * most)
    step = float(max(np.sqrt(2) * slack, half + np.sqrt(half**2 + double_area.sum() / (2 * most))))

    along_edges = _between(vertices[edges[:, 0]], vertices[edges[:, 1]], lengths, step)
    face, place = cuts(height / step)
    row_start = a[face] + place[:, None] * (c - a)[face]
    row_end = b[face] + place[:, None] * (c - b)[face]
    on_rows = _between(row_start, row_end, np.linalg.norm(row_end - row_start, axis=1), step)
    return np.concatenate([vertices, along_edges, row_start, row_end, on_rows]), step / np.sqrt(2)


def _between(start: Array, end: Array, lengths: Array, step: float) -> Array:
    """Points inside segments (k, 3), at most ``step`` from each other and from the ends."""
    which, place = cuts(lengths / step)
    return np.asarray(start[which] + place[:, None] * (end - start)[which])
