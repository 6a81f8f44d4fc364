"""Bodies for fcl: one configuration after the other, where no faster test decides."""

from __future__ import annotations

from typing import NamedTuple
from weakref import WeakKeyDictionary

import fcl
import numpy as np

from cellcolor.arrays import Array, Index, Mask, unit
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses, frames_along
from cellcolor.frontend.arm.polyhedron import Polyhedron

_AHEAD = 64  # places that are looked at together
_SURE = 0.99  # of a distance, for rounding
_WHETHER = fcl.CollisionRequest()  # nothing else is asked for
_MODELS: WeakKeyDictionary[Polyhedron, fcl.BVHModel] = WeakKeyDictionary()


def mesh_model(vertices: Array, faces: Index) -> fcl.BVHModel:
    """Triangles for fcl: a shell, not the volume inside."""
    model = fcl.BVHModel()
    model.beginModel(len(faces), len(vertices))
    model.addSubModel(vertices, faces)
    model.endModel()
    return model


def body_shape(body: Body, wider: float = 0.0) -> fcl.CollisionGeometry:
    """The body's shape for fcl, about the origin and along z; of a solid in the joint's frame.

    Args:
        wider: how much wider bodies that are not solids are made, and cylinders longer, m.
    """
    if body.solid is not None:
        if body.solid not in _MODELS:
            _MODELS[body.solid] = mesh_model(body.solid.vertices, body.solid.faces)
        return _MODELS[body.solid]
    radius, length = body.radius + wider, body.length
    if body.flat:
        return fcl.Cylinder(radius, length + 2 * wider)
    return fcl.Capsule(radius, length) if length else fcl.Sphere(radius)


def body_poses(body: Body, ends: Array, poses: Poses | None = None) -> tuple[Array, Array]:
    """Rotations (n, 3, 3) and origins (n, 3) of that shape, from the ends (2, n, 3) of its axis.

    All shapes but solids are symmetric about their axis, so any rotation that turns z onto it will
    do. Solids need the ``poses`` of the joints.
    """
    start, end = ends
    if body.solid is not None:
        assert poses is not None  # callers whose bodies have solids pass them
        return poses.body_rotation[:, body.joint], poses.body_origin[:, body.joint]
    if not body.length:
        return np.tile(np.eye(3), (len(start), 1, 1)), start
    return frames_along(unit(end - start)), (start + end) / 2


Placed = tuple[Array, Array]
"""Rotations (n, 3, 3) and origins (n, 3)."""


class Thing(NamedTuple):
    """A stationary thing: its shape in the world, and a point (parts, 3) of each part, m."""

    shape: fcl.CollisionObject
    points: Array


def touch_thing(body: Body, placed: Placed, thing: Thing) -> Mask:
    """Whether a body in n places touches a thing, (n,); a solid is filled, the thing need not be.

    A thing within a solid's skin counts as touching it.
    """
    other = fcl.CollisionObject(body_shape(body), fcl.Transform())
    hit = np.zeros(len(placed[1]), dtype=bool)
    for row, (turn, origin) in enumerate(zip(*placed, strict=True)):
        other.setTransform(fcl.Transform(turn, origin))
        hit[row] = _touch(thing.shape, other, body.skin)
    if body.solid is not None:
        points = np.broadcast_to(thing.points, (len(hit), *thing.points.shape))
        hit |= _any_inside(body.solid, placed, points, ~hit)
    return hit


def bodies_touch(first: Body, at: Placed, second: Body, second_at: Placed) -> Mask:
    """Whether two bodies touch in each of n places, (n,); one may be wholly inside the other.

    Distances between curved shapes are off by some tenths of a millimeter in fcl. So the skin, if
    any, goes to the curved one of two shapes if one is curved.
    """
    skin = first.skin + second.skin
    curved = first.solid is None or second.solid is None
    shapes = [body_shape(body, skin if body.solid is None else 0.0) for body in (first, second)]
    a, b = (fcl.CollisionObject(shape, fcl.Transform()) for shape in shapes)
    hit = np.zeros(len(at[1]), dtype=bool)
    # Seen from the first body, so that only the second one has to be placed.
    back = at[0].transpose(0, 2, 1)
    turns, off = back @ second_at[0], back @ (second_at[1] - at[1])[:, :, None]

    def place(row: int) -> None:
        b.setTransform(fcl.Transform(turns[row], off[row, :, 0]))

    if curved or not skin:
        for row in range(len(hit)):
            place(row)
            hit[row] = _touch(a, b, 0.0)
    else:
        moved, row = _Moved(second, turns, off[:, :, 0]), 0
        while row < len(hit):
            place(row)
            spare = _distance(a, b) - skin
            hit[row] = spare < 0.0
            row = moved.first_as_far(row, spare)
    for one, own, other, other_own in (
        (first, at, second, second_at),
        (second, second_at, first, at),
    ):
        if one.solid is not None and not hit.all():
            hit |= _any_inside(one.solid, own, points_of(other, other_own), ~hit)
    return hit


class _Moved:
    """How far points of one solid move past another one, from place to place.

    Neighboring places are mostly of one motion, and a solid that has come no farther than it was
    away cannot touch.
    """

    def __init__(self, second: Body, turns: Array, origins: Array) -> None:
        """The places (n, 3, 3) and (n, 3) of the second one are seen from the first."""
        assert second.solid is not None
        middle = second.solid.vertices.mean(axis=0)
        self._radius = float(np.linalg.norm(second.solid.vertices - middle, axis=1).max())
        self._turns = turns
        self._middles = turns @ middle + origins

    def first_as_far(self, row: int, spare: float) -> int:
        """The next place after a row where the second solid may have come so much nearer, m.

        Two rotations R and S take a point at the distance r to places that are at most
        r |R - S| / sqrt(2) apart, with the Frobenius norm: their difference has the rank 2, and
        both singular values are equal.
        """
        begins = row + 1
        while spare > 0.0 and begins < len(self._middles):
            ahead = slice(begins, begins + _AHEAD)
            turned = np.linalg.norm(self._turns[ahead] - self._turns[row], axis=(1, 2))
            came = np.linalg.norm(self._middles[ahead] - self._middles[row], axis=1)
            near = came + self._radius * turned / np.sqrt(2) >= _SURE * spare
            if near.any():
                return begins + int(near.argmax())
            begins += len(near)
        return begins


def _touch(a: fcl.CollisionObject, b: fcl.CollisionObject, skin: float) -> bool:
    if skin:
        return _distance(a, b) < skin
    return bool(fcl.collide(a, b, _WHETHER, fcl.CollisionResult()))


def _distance(a: fcl.CollisionObject, b: fcl.CollisionObject) -> float:
    """How far two shapes are from each other, m; 0 if they touch."""
    if fcl.collide(a, b, _WHETHER, fcl.CollisionResult()):
        return 0.0
    return float(fcl.distance(a, b, fcl.DistanceRequest(), fcl.DistanceResult()))


def points_of(body: Body, placed: Placed) -> Array:
    """A point of each part of a body in the world, (n, parts, 3)."""
    turns, origins = placed
    if body.solid is None:
        return origins[:, None]
    return np.asarray(body.solid.one_of_each_part @ turns.transpose(0, 2, 1) + origins[:, None])


def _any_inside(solid: Polyhedron, placed: Placed, points: Array, asked: Mask) -> Mask:
    """Whether one of some points (n, k, 3) in the world is inside a solid, (n,), where asked."""
    rows = np.flatnonzero(asked)
    turns, origins = placed
    local = (points[rows] - origins[rows, None]) @ turns[rows]
    inside = np.zeros(len(asked), dtype=bool)
    inside[rows] = solid.contains(local.reshape(-1, 3)).reshape(local.shape[:2]).any(axis=1)
    return inside
