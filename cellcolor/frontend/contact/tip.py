"""Room at the tool's tip, and how far bodies may move between two tests.

Bodies end short of the tip, since the tip touches the object. Obstacles and the ground must leave
room for the region where the tool works (``docs/frontend.md``, "Validity"), which depends only on
the tool's pose, whatever the arm does.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask, numbered
from cellcolor.frontend.arm.body import Body, Shape
from cellcolor.frontend.arm.kinematics import Poses, turned
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, poses_along
from cellcolor.frontend.parts.surface import Faces, Surface, along_edges
from cellcolor.memory import batches

_DEPTH = 0.00065  # m; a tool of 20 mm radius may move by 10 mm, the upper arm by 17


def body_ends(robot: Robot, poses: Poses) -> Array:
    """Both ends of every body's axis in the world, (bodies, 2, n, 3), m."""
    ends = np.empty((len(robot.bodies), 2, len(poses.tip), 3))
    for own, body in zip(ends, robot.bodies, strict=True):
        own[:] = _placed(poses, body, np.array([body.start, body.end]))
    return ends


def tracked_points(robot: Robot, poses: Poses) -> Array:
    """The outline of all bodies that can move, in the world, (points, n, 3), m."""
    points = [_placed(poses, body, body.outline) for body in robot.bodies if body.joint]
    return np.concatenate([np.empty((0, len(poses.tip), 3)), *points])


def _placed(poses: Poses, body: Body, points: Array) -> Array:
    """Points (p, 3) that a body carries, in the world, (p, n, 3)."""
    there = turned(poses.rotation[:, body.joint], points.T).transpose(2, 0, 1)
    return np.asarray(there + poses.origin[:, body.joint])


def tracked_steps(robot: Robot, margin: float, between: float) -> Array:
    """How far each of the tracked points may move between two tests, (points,), m.

    A solid may have sharp edges. A stationary object reaches into it by at most half a step less
    the margin in which nothing may be: 0.65 mm, as for other bodies (:func:`longest_step`). For
    two solids that both move it is a whole step less their margin: 1.3 mm.

    Args:
        margin: the smallest margin to stationary objects, m.
        between: the margin between links, m.
    """
    of_solids = 2 * _DEPTH + min(2 * margin, between)
    moving = [body for body in robot.bodies if body.joint]
    steps = [longest_step(each.radius) if each.solid is None else of_solids for each in moving]
    return np.repeat(steps, [len(body.outline) for body in moving])


def longest_step(radius: float) -> float:
    """How far a body of this radius may move between two tested points of a link, m.

    A ball of radius r that moves by s sweeps a space that its first and last position do not cover
    completely. The gap is r - sqrt(r^2 - s^2 / 4) deep: at most 0.65 mm.
    """
    depth = min(_DEPTH, radius)
    return 2 * math.sqrt(depth * (2 * radius - depth))


class Tip:
    """All points within the contact radius of the tool's axis, from the tip to the tool's body.

    Attributes:
        body: the region as a shape fixed to the last joint.
    """

    def __init__(
        self, robot: Robot, radius: float, obstacles: Sequence[Shape], ground: Shape | None
    ) -> None:
        """``radius`` in m, and the ground if there is one."""
        point, axis = robot.tip[:3, 3], robot.tip[:3, 2]
        # How far behind the tip the axis of each body on the last link begins, or a solid itself.
        behind = []
        for body in robot.bodies:
            if body.joint == robot.joints:
                ends = [body.start, body.end] if body.solid is None else body.solid.vertices
                behind.append(float(((point - ends) @ axis).min()))
        length = max(min(behind, default=0.0), 0.0)
        self.body = Body("tool tip", robot.joints, point, point - length * axis, radius, flat=False)
        # Without a length it is a ball, whichever way its frame is turned.
        along = np.array([0.0, 0.0, -length])
        region = replace(self.body, joint=1, start=np.zeros(3), end=along)
        below: list[Shape] = [] if ground is None else [ground]
        self._with_obstacles, self._with_ground = (
            Contacts([(region, thing, 0.0) for thing in things]) for things in (obstacles, below)
        )

    def blocked(self, points: Array, directions: Array) -> Mask:
        """Whether something is in the way, (k,).

        Args:
            points: (k, 3) where the tip is, m.
            directions: (k, 3) unit vectors along the tool, from the flange to the tip.
        """
        poses = poses_along(points, directions)
        return self._with_ground(poses) | self._with_obstacles(poses)

    def free_along(self, surface: Surface, edges: Faces) -> Mask:
        """Whether obstacles leave room all along mesh edges (k, 2), (k,).

        Tested at points so close together that at most 0.65 mm of an overlap with the region is
        missed. The ground is flat, so the vertices are enough.
        """
        free = np.ones(len(edges), dtype=bool)
        if not self._with_obstacles:
            return free
        way = surface.lengths(edges) + self.body.length * surface.turns(edges)
        pieces = np.maximum(np.ceil(way / longest_step(self.body.radius)).astype(int), 1)
        for part in batches(pieces):
            which, number = numbered(pieces[part])
            row = part.start + which
            points, directions = along_edges(surface, edges[row], number / pieces[part][which])
            free[row[self._with_obstacles(poses_along(points, directions))]] = False
        return free
