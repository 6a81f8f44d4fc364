"""Collisions of many configurations at once: of the arm with itself and with the ground.

Shapes are capsules and flat-ended cylinders (:class:`~cellcolor.frontend.arm.robot.Body`), given in
the world by the ends of their axes. Capsules are settled in numpy. A cylinder lies between two
capsules, one around and one inside it; only where these disagree, fcl decides.
"""

from __future__ import annotations

import fcl
import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.kinematics import Poses, turned
from cellcolor.frontend.arm.robot import Body, Robot

__all__ = [
    "body_ends",
    "body_poses",
    "body_shape",
    "hits_ground",
    "hits_itself",
    "longest_steps",
    "segment_distance",
]

_DEPTH = 0.00065  # m; a tool of 20 mm radius may move by 10 mm, the upper arm by 17


def body_ends(robot: Robot, poses: Poses) -> Array:
    """Both ends of every body's axis in the world, (bodies, 2, n, 3), m."""
    ends = np.empty((len(robot.bodies), 2, len(poses.tip), 3))
    for index, body in enumerate(robot.bodies):
        rotation, origin = poses.rotation[:, body.joint], poses.origin[:, body.joint]
        ends[index, 0] = origin + turned(rotation, body.start)
        ends[index, 1] = origin + turned(rotation, body.end)
    return ends


def hits_itself(robot: Robot, ends: Array) -> Mask:
    """Whether any tested pair of bodies overlaps, (n,)."""
    hit = np.zeros(ends.shape[2], dtype=bool)
    centers = ends.mean(axis=1)
    for i, j in robot.tested_pairs:
        first, second = robot.bodies[i], robot.bodies[j]
        radii = first.radius + second.radius
        # Bounding spheres first.
        apart = _norm(centers[i] - centers[j]) > radii + (first.length + second.length) / 2
        rows = np.flatnonzero(~(apart | hit))
        if not len(rows):
            continue
        a, b = ends[i][:, rows], ends[j][:, rows]
        close = segment_distance(a[0], a[1], b[0], b[1]) <= radii
        if not (first.flat or second.flat):
            hit[rows[close]] = True
            continue
        rows = rows[close]
        (a0, a1, ra), (b0, b1, rb) = _inside(first, a[:, close]), _inside(second, b[:, close])
        sure = np.asarray(segment_distance(a0, a1, b0, b1) <= ra + rb)
        hit[rows[sure]] = True
        rest = rows[~sure]
        hit[rest] = _overlap(first, ends[i][:, rest], second, ends[j][:, rest])
    return hit


def hits_ground(robot: Robot, ends: Array, height: float, exempt: tuple[str, ...]) -> Mask:
    """Whether any body but those of the exempt links reaches below ``height`` (m), (n,)."""
    hit = np.zeros(ends.shape[2], dtype=bool)
    for body, (start, end) in zip(robot.bodies, ends, strict=True):
        if body.link not in exempt:
            below = np.full(len(start), body.radius)
            if body.flat:
                upright = (end - start)[:, 2] / body.length
                below *= np.sqrt(np.maximum(1 - upright**2, 0.0))
            hit |= np.minimum(start[:, 2], end[:, 2]) - below < height
    return hit


def segment_distance(p0: Array, p1: Array, q0: Array, q1: Array) -> Array:
    """Distance (n,) between the segments p0-p1 and q0-q1, each (n, 3); points are allowed.

    After Ericson, Real-Time Collision Detection, 2005, section 5.1.9.
    """
    d1, d2, r = p1 - p0, q1 - q0, p0 - q0
    a, e = _dot(d1, d1), _dot(d2, d2)
    b, c, f = _dot(d1, d2), _dot(d1, r), _dot(d2, r)
    a_safe, e_safe = np.where(a > 0, a, 1.0), np.where(e > 0, e, 1.0)
    denominator = a * e - b * b
    parallel = denominator <= 1e-12 * a * e
    s = np.where(parallel, 0.0, (b * f - c * e) / np.where(parallel, 1.0, denominator))
    s = np.clip(s, 0.0, 1.0)
    t = (b * s + f) / e_safe
    # Where t leaves the second segment, or that is a point, take the best s for the end.
    s = np.where((t < 0) | (e == 0), np.clip(-c / a_safe, 0, 1), s)
    s = np.where(t > 1, np.clip((b - c) / a_safe, 0, 1), s)
    t = np.clip(t, 0.0, 1.0)
    return _norm(r + s[:, None] * d1 - t[:, None] * d2)


def body_shape(body: Body) -> fcl.CollisionGeometry:
    """The body's shape for fcl, about the origin and along z."""
    if body.flat:
        return fcl.Cylinder(body.radius, body.length)
    return fcl.Capsule(body.radius, body.length) if body.length else fcl.Sphere(body.radius)


def body_poses(body: Body, ends: Array) -> tuple[Array, Array]:
    """Rotations (n, 3, 3) and centers (n, 3) of that shape, from the ends (2, n, 3) of its axis.

    All shapes are symmetric about their axis, so any rotation that turns z onto it will do.
    """
    start, end = ends
    if not body.length:
        return np.tile(np.eye(3), (len(start), 1, 1)), start
    z = (end - start) / body.length
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z), axis=1)])
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return np.stack([x, np.cross(z, x), z], axis=2), (start + end) / 2


def _inside(body: Body, ends: Array) -> tuple[Array, Array, float]:
    """Ends and radius of the largest capsule along the axis that lies inside the body."""
    start, end = ends
    if not body.flat:
        return start, end, body.radius
    radius = min(body.radius, body.length / 2)
    inset = (end - start) * (radius / body.length)
    return start + inset, end - inset, radius


def _overlap(first: Body, first_ends: Array, second: Body, second_ends: Array) -> Mask:
    """By fcl, one after the other: ends (2, n, 3) to (n,)."""
    if not first_ends.shape[1]:
        return np.zeros(0, dtype=bool)
    a, b = (fcl.CollisionObject(body_shape(body), fcl.Transform()) for body in (first, second))
    request, hit = fcl.CollisionRequest(), np.zeros(first_ends.shape[1], dtype=bool)
    poses = zip(*body_poses(first, first_ends), *body_poses(second, second_ends), strict=True)
    for row, (turn_a, center_a, turn_b, center_b) in enumerate(poses):
        a.setTransform(fcl.Transform(turn_a, center_a))
        b.setTransform(fcl.Transform(turn_b, center_b))
        hit[row] = fcl.collide(a, b, request, fcl.CollisionResult())
    return hit


def _dot(a: Array, b: Array) -> Array:
    product: Array = np.einsum("ij,ij->i", a, b)
    return product


def _norm(a: Array) -> Array:
    norms: Array = np.sqrt(_dot(a, a))
    return norms


def longest_steps(radii: Array) -> Array:
    """How far bodies of these radii may move between two tested points of a link, m.

    What two balls of radius r at a distance s leave out between them, of all that a third one on
    its way from one to the other meets, is r - sqrt(r^2 - s^2 / 4) deep: at most 0.65 mm.
    """
    depth = np.minimum(_DEPTH, radii)
    return np.asarray(2 * np.sqrt(depth * (2 * radii - depth)))
