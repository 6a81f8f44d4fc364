"""Where bodies are and how far they move, in many configurations at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import Poses, frames_along, turned
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.shape import Shape

_DEPTH = 0.00065  # m; a tool of 20 mm radius may move by 10 mm, the upper arm by 17


@dataclass(frozen=True)
class HalfSpace:
    """All points p of the world with ``normal @ p`` below an offset.

    Attributes:
        normal: (3,) a unit vector, out of the half space.
        offset_m: of the plane along the normal, from the world's origin, m.
    """

    normal: tuple[float, float, float]
    offset_m: float

    @classmethod
    def through(cls, point: Array, normal: Array) -> HalfSpace:
        """The half space whose plane passes through a point (3,), with a normal of any length."""
        x, y, z = (normal / np.linalg.norm(normal)).tolist()
        return cls((x, y, z), float(np.array([x, y, z]) @ point))

    def along(self, vectors: Array) -> Array:
        """How far points or vectors (..., 3) go along the normal, (...), m."""
        return np.asarray(vectors @ np.array(self.normal))

    @property
    def shape(self) -> Shape:
        """The half space as a shape that stands still."""
        normal = np.array(self.normal)
        turn = frames_along(normal[None])[0]
        return Shape("half-space", rotation=turn, origin=self.offset_m * normal)


def body_ends(robot: Robot, poses: Poses) -> Array:
    """Both ends of every body's axis in the world, (bodies, 2, n, 3), m."""
    ends = np.empty((len(robot.bodies), 2, len(poses.tip), 3))
    for index, body in enumerate(robot.bodies):
        rotation, origin = poses.body_rotation[:, body.joint], poses.body_origin[:, body.joint]
        ends[index, 0] = origin + turned(rotation, body.start)
        ends[index, 1] = origin + turned(rotation, body.end)
    return ends


def longest_steps(radii: Array) -> Array:
    """How far bodies of these radii may move between two tested points of a link, m.

    A ball of radius r that moves by s sweeps a space that its first and last position do not cover
    completely. The gap is r - sqrt(r^2 - s^2 / 4) deep: at most 0.65 mm.
    """
    depth = np.minimum(_DEPTH, radii)
    return np.asarray(2 * np.sqrt(depth * (2 * radii - depth)))


def tracked_points(robot: Robot, ends: Array, poses: Poses) -> Array:
    """Points of all bodies that can move, in the world, (points, n, 3), m.

    No point of a body's axis moves farther than one of its ends, and none of a solid farther than
    a corner of the box around it: its displacement is a mean of theirs.
    """
    points = []
    for body, both in zip(robot.bodies, ends, strict=True):
        if body.joint == 0:
            continue
        if body.solid is None:
            points.append(both)
            continue
        corners = turned(poses.body_rotation[:, body.joint], body.solid.corners.T)
        place = corners.transpose(2, 0, 1) + poses.body_origin[:, body.joint]
        points.append(place)
    return np.concatenate([np.empty((0, *ends.shape[2:])), *points])


def tracked_steps(robot: Robot, margin: float, between: float) -> Array:
    """How far each of the tracked points may move between two tests, (points,), m.

    A solid may have sharp edges. A stationary object reaches into it by at most half a step less
    the margin in which nothing may be: 0.65 mm, as for other bodies (:func:`longest_steps`). For
    two solids that both move it is a whole step less their margin: 1.3 mm.

    Args:
        margin: the smallest margin to stationary objects, m.
        between: the margin between links, m.
    """
    steps: list[float] = []
    for body in robot.bodies:
        if body.joint == 0:
            continue
        if body.solid is None:
            steps += longest_steps(np.array([body.radius])).tolist() * 2
        else:
            steps += [2 * _DEPTH + min(2 * margin, between)] * 8
    return np.array(steps)
