"""Collisions of many configurations at once: with the arm itself, ground, obstacles and object.

Shapes are capsules and flat-ended cylinders (:class:`~cellcolor.frontend.robot.Body`). Capsules
are settled in numpy. A cylinder lies between two capsules, one around and one inside it; only
where these disagree, and against obstacles and the object's mesh, fcl decides.
"""

from __future__ import annotations

import fcl
import numpy as np
from numpy.typing import NDArray

from cellcolor.frontend.kinematics import Poses
from cellcolor.frontend.robot import Array, Body, Robot
from cellcolor.frontend.scene import BoxObstacle, CylinderObstacle, Obstacle, SphereObstacle
from cellcolor.frontend.surfaces import Faces, rotation_from_rpy

__all__ = ["Collider", "hits_ground", "hits_itself", "segment_distance"]

Mask = NDArray[np.bool_]


def hits_itself(robot: Robot, poses: Poses) -> Mask:
    """Whether any tested pair of bodies overlaps, (n,)."""
    hit = np.zeros(len(poses.tip), dtype=bool)
    ends = [_ends(body, poses) for body in robot.bodies]
    for i, j in robot.tested_pairs:
        first, second = robot.bodies[i], robot.bodies[j]
        rows = np.flatnonzero(~hit)
        a, b = ends[i][:, rows], ends[j][:, rows]
        radii = first.radius + second.radius
        close = segment_distance(a[0], a[1], b[0], b[1]) <= radii
        if not (first.flat or second.flat):
            hit[rows[close]] = True
            continue
        rows, a, b = rows[close], a[:, close], b[:, close]
        (a0, a1, ra), (b0, b1, rb) = _inside(first, a), _inside(second, b)
        sure = segment_distance(a0, a1, b0, b1) <= ra + rb
        hit[rows[sure]] = True
        for row in rows[~sure]:
            hit[row] = _overlap(_solid(first, poses, row), _solid(second, poses, row))
    return hit


def hits_ground(robot: Robot, poses: Poses, height: float, exempt: tuple[str, ...]) -> Mask:
    """Whether any body but those of the exempt links reaches below ``height`` (m), (n,)."""
    hit = np.zeros(len(poses.tip), dtype=bool)
    for body in robot.bodies:
        if body.link not in exempt:
            start, end = _ends(body, poses)
            below = np.full(len(start), body.radius)
            if body.flat:
                upright = (end - start)[:, 2] / body.length
                below *= np.sqrt(np.maximum(1 - upright**2, 0.0))
            hit |= np.minimum(start[:, 2], end[:, 2]) - below < height
    return hit


class Collider:
    """Something that stands still, prepared for many queries.

    A mesh is a shell: a body wholly inside a closed one does not touch it. That cannot happen
    unnoticed to an arm whose bodies touch one another in a row and of which a part is outside.
    """

    def __init__(
        self, robot: Robot, solid: fcl.CollisionObject, lowest: Array, highest: Array
    ) -> None:
        """``lowest`` and ``highest`` (3,) bound the solid in the world, m."""
        self._solid, self._lowest, self._highest = solid, lowest, highest
        self._request = fcl.CollisionRequest()
        # From the tool to the base: what is near the object is asked first.
        self._bodies = [
            (body, fcl.CollisionObject(_shape(body), fcl.Transform()), _center_and_turn(body))
            for body in reversed(robot.bodies)
        ]

    @classmethod
    def of_mesh(cls, robot: Robot, vertices: Array, faces: Faces) -> Collider:
        """A triangle mesh in the world."""
        model = fcl.BVHModel()
        model.beginModel(len(faces), len(vertices))
        model.addSubModel(vertices, faces)
        model.endModel()
        solid = fcl.CollisionObject(model, fcl.Transform())
        return cls(robot, solid, vertices.min(axis=0), vertices.max(axis=0))

    @classmethod
    def of_obstacle(cls, robot: Robot, obstacle: Obstacle) -> Collider:
        """A primitive of the scene."""
        match obstacle:
            case BoxObstacle(size_m=size):
                shape, half = fcl.Box(*size), np.array(size) / 2
            case CylinderObstacle(radius_m=radius, height_m=height):
                shape, half = fcl.Cylinder(radius, height), np.array([radius, radius, height / 2])
            case SphereObstacle(radius_m=radius):
                shape, half = fcl.Sphere(radius), np.full(3, radius)
        turn, center = rotation_from_rpy(*obstacle.rpy_rad), np.array(obstacle.position_m)
        solid = fcl.CollisionObject(shape, fcl.Transform(turn, center))
        reach = np.abs(turn) @ half
        return cls(robot, solid, center - reach, center + reach)

    def hits_fixed(self) -> str | None:
        """The link of the robot that cannot move and touches the solid, if there is one."""
        for body, solid, (center, turn) in self._bodies:
            if body.joint == 0 and self._touches(solid, center, turn):
                return body.link
        return None

    def hits(self, poses: Poses) -> Mask:
        """Whether any moving body touches the solid, (n,)."""
        hit = np.zeros(len(poses.tip), dtype=bool)
        for body, solid, (center, turn) in self._bodies:
            if body.joint == 0:
                continue
            rows = np.flatnonzero(~hit)
            ends = _ends(body, poses)[:, rows]
            near = (ends.min(axis=0) - body.radius <= self._highest).all(axis=1)
            near &= (ends.max(axis=0) + body.radius >= self._lowest).all(axis=1)
            rows = rows[near]
            rotation = poses.rotation[rows, body.joint]
            centers = poses.origin[rows, body.joint] + rotation @ center
            turns = rotation @ turn
            for row, at, turned in zip(rows, centers, turns, strict=True):
                hit[row] = self._touches(solid, at, turned)
        return hit

    def _touches(self, solid: fcl.CollisionObject, center: Array, turn: Array) -> bool:
        solid.setTransform(fcl.Transform(turn, center))
        return bool(fcl.collide(self._solid, solid, self._request, fcl.CollisionResult()))


def segment_distance(p0: Array, p1: Array, q0: Array, q1: Array) -> Array:
    """Distance (n,) between the segments p0-p1 and q0-q1, each (n, 3); points are allowed.

    After Ericson, Real-Time Collision Detection, 2005, section 5.1.9.
    """
    d1, d2, r = p1 - p0, q1 - q0, p0 - q0
    a, e = (d1 * d1).sum(1), (d2 * d2).sum(1)
    b, c, f = (d1 * d2).sum(1), (d1 * r).sum(1), (d2 * r).sum(1)
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
    gap = r + s[:, None] * d1 - t[:, None] * d2
    distance: Array = np.sqrt((gap * gap).sum(1))
    return distance


def _ends(body: Body, poses: Poses) -> Array:
    """Both ends of the body's axis in the world, (2, n, 3)."""
    rotation, origin = poses.rotation[:, body.joint], poses.origin[:, body.joint]
    return np.stack([origin + rotation @ body.start, origin + rotation @ body.end])


def _inside(body: Body, ends: Array) -> tuple[Array, Array, float]:
    """Ends and radius of the largest capsule along the axis that lies inside the body."""
    start, end = ends
    if not body.flat:
        return start, end, body.radius
    radius = min(body.radius, body.length / 2)
    inset = (end - start) * (radius / body.length)
    return start + inset, end - inset, radius


def _shape(body: Body) -> fcl.CollisionGeometry:
    if body.flat:
        return fcl.Cylinder(body.radius, body.length)
    return fcl.Capsule(body.radius, body.length) if body.length else fcl.Sphere(body.radius)


def _center_and_turn(body: Body) -> tuple[Array, Array]:
    """Pose of the shape in its joint's frame: fcl's shapes lie along their own z axis."""
    center = (body.start + body.end) / 2
    if not body.length:
        return center, np.eye(3)
    z = (body.end - body.start) / body.length
    x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    return center, np.column_stack([x, np.cross(z, x), z])


def _solid(body: Body, poses: Poses, row: int) -> fcl.CollisionObject:
    center, turn = _center_and_turn(body)
    rotation, origin = poses.rotation[row, body.joint], poses.origin[row, body.joint]
    return fcl.CollisionObject(
        _shape(body), fcl.Transform(rotation @ turn, origin + rotation @ center)
    )


def _overlap(first: fcl.CollisionObject, second: fcl.CollisionObject) -> bool:
    return bool(fcl.collide(first, second, fcl.CollisionRequest(), fcl.CollisionResult()))
