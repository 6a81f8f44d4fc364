"""What cannot touch near a configuration whose clearances are known: those pairs need no test.

Between two vertices of a mesh a body moves by a few millimeters, and most bodies are decimeters
from everything. So the distances are bounded from below once at a vertex. Near it only those
bodies are tested that can have come as near as a millimeter. (The idea is that of conservative
advancement, Mirtich, 1996.)

How far two links come nearer to each other is bounded by what the joints between them turn: by
that angle times the distance of a link's points from the axis, whatever the other joints do.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.collision import segment_distance
from cellcolor.frontend.contact.solids import Solid

_LEAST = 0.001  # m; bodies may be nearer than that: fcl's distances are off by some tenths of it
_SLICE = 0.06  # m; of an axis, where a body's distance is bounded from below
_FAR = 0.1  # m; a larger bound need not be a better one


@dataclass(frozen=True)
class Clearance:
    """Lower bounds of distances in k configurations.

    Attributes:
        robot: the arm.
        levers: (pairs, joints) see :func:`pair_levers`.
        configurations: (k, joints) in rad.
        tracked: (points, k, 3) see :func:`~cellcolor.frontend.contact.collision.tracked_points`.
        between: (pairs, k) of two links that are tested against each other, m.
        around: (bodies, k) of a body and anything that stands still, m.
    """

    robot: Robot
    levers: Array
    configurations: Array
    tracked: Array
    between: Array
    around: Array

    def may_touch(self, rows: Index, configurations: Array, tracked: Array) -> tuple[Mask, Mask]:
        """What may touch in n other configurations.

        Args:
            rows: (n,) the known configuration that each is near to.
            configurations: (n, joints) in rad.
            tracked: (points, n, 3) in them.

        Returns:
            (pairs, n) of links, (bodies, n) with something that stands still.
        """
        turned = np.abs(configurations - self.configurations[rows])
        pairs = self.between[:, rows] - self.levers @ turned.T < _LEAST
        moved = np.linalg.norm(tracked - self.tracked[:, rows], axis=2)
        bodies = np.empty((len(self.robot.bodies), len(rows)), dtype=bool)
        first = 0
        for number, body in enumerate(self.robot.bodies):
            points = 0 if not body.joint else 2 if body.solid is None else 8
            farthest = moved[first : first + points].max(axis=0, initial=0.0)
            bodies[number] = self.around[number, rows] - farthest < _LEAST
            first += points
        return pairs, bodies


def pair_gaps(robot: Robot, ends: Array) -> Array:
    """Lower bounds (pairs, n) of the distance of links that are tested against each other, m.

    Those of the capsules that the bodies are or lie in; ``ends`` (bodies, 2, n, 3) of their axes.
    """
    gaps, centers = np.empty((len(robot.tested_pairs), ends.shape[2])), ends.mean(axis=1)
    for gap, (i, j) in zip(gaps, robot.tested_pairs, strict=True):
        first, second = robot.bodies[i], robot.bodies[j]
        radii = first.radius + second.radius
        gap[:] = np.linalg.norm(centers[i] - centers[j], axis=1)
        gap -= radii + (first.length + second.length) / 2
        rows = np.flatnonzero(gap < _FAR)
        gap[rows] = segment_distance(*ends[i][:, rows], *ends[j][:, rows]) - radii
    return gaps


def body_gaps(robot: Robot, ends: Array, solids: Sequence[Solid]) -> Array:
    """Lower bounds (bodies, n) of the distance between each body and several solids, m.

    A body lies in balls around points of its axis.
    """
    gaps = np.full((len(robot.bodies), ends.shape[2]), np.inf)
    for own, body, (start, end) in zip(gaps, robot.bodies, ends, strict=True):
        slices = max(int(np.ceil(body.length / _SLICE)), 1)
        around = float(np.hypot(body.length / slices / 2, body.radius))
        balls = [((number + 0.5) / slices, around) for number in range(slices)]
        if not body.flat:
            balls += [(0.0, body.radius), (1.0, body.radius)]
        for place, radius in balls:
            points = start + place * (end - start)
            for solid in solids:
                np.minimum(own, solid.at_least(points) - radius, out=own)
    return gaps


def pair_levers(robot: Robot) -> Array:
    """How much nearer two links come at most for each rad that a joint turns, (pairs, joints), m.

    A joint between them turns either link against the other, so the shorter of two levers counts:
    the greatest distance from its axis of the outer link's points, and of the inner link's. Other
    joints move both links or none. Infinite for arms with prismatic joints, and for what hangs on
    followers.
    """
    levers = np.zeros((len(robot.tested_pairs), robot.joints))
    steps = np.linalg.norm(robot.placement[:, :3, 3], axis=1)
    for row, pair in enumerate(robot.tested_pairs):
        inner, outer = sorted((robot.bodies[index] for index in pair), key=lambda own: own.joint)
        if robot.slides.any() or outer.joint > robot.joints:
            levers[row] = np.inf
            continue
        for joint in range(inner.joint, outer.joint):
            levers[row, joint] = min(
                _outer_lever(robot, steps, joint, outer), _inner_lever(robot, steps, joint, inner)
            )
    return levers


def _outer_lever(robot: Robot, steps: Array, joint: int, body: Body) -> float:
    """Of a body that a joint carries, by way of the joints between."""
    points = np.array([body.start, body.end])
    if body.joint == joint + 1:
        return _from_axis(points, robot.axis[joint])
    return float(steps[joint + 1 : body.joint].sum() + np.linalg.norm(points, axis=1).max())


def _inner_lever(robot: Robot, steps: Array, joint: int, body: Body) -> float:
    """Of a body that carries a joint."""
    points = np.array([body.start, body.end]) - robot.placement[body.joint, :3, 3]
    if body.joint == joint:
        return _from_axis(points, robot.placement[joint, :3, :3] @ robot.axis[joint])
    return float(np.linalg.norm(points, axis=1).max() + steps[body.joint + 1 : joint + 1].sum())


def _from_axis(points: Array, axis: Array) -> float:
    return float(np.linalg.norm(np.cross(points, axis), axis=1).max())
