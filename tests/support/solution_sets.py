"""All solutions of poses: by a family of arms, and by Newton's method from many starts.

That knows no inverse kinematics. Five joints put the tip on a point and the tool along a direction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from independent import wrapped
from scipy.optimize import brentq

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import (
    forward,
    signed_task_determinant,
    task_determinant,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup

JOINTS = 5
STEPS = 50
DAMPED = 0.05  # times the squared error, added to the normal equations (Levenberg, Marquardt)
LARGEST = 1.0  # rad; no step moves a joint farther
DONE, REACHED = 1e-13, 1e-11  # m, and for the unit vector; steps end, and what is a solution


def from_many_starts(
    robot: Robot, points: Array, directions: Array, starts: int, seed: int
) -> list[Array]:
    """Joints 1 to 5 (s, 5) of all solutions of poses (n, 3) each, from so many random starts."""
    random, found = np.random.default_rng(seed), []
    for point, direction in zip(points, directions, strict=True):
        joints = random.uniform(-np.pi, np.pi, (starts, 6))
        off, rows = np.empty(starts), np.arange(starts)
        for _ in range(STEPS):
            poses = forward(robot, joints[rows])
            error = np.concatenate([point - poses.tip, direction - poses.tool_axis], axis=1)
            off[rows] = np.abs(error).max(axis=1)
            going = off[rows] > DONE
            linear, angular = poses.jacobian
            # The tool's axis moves by the cross product with the angular velocity.
            turned = np.cross(angular, poses.tool_axis[:, :, None], axisa=1, axisb=1, axisc=1)
            jacobian = np.concatenate([linear, turned], axis=1)[going, :, :JOINTS]
            rows, error = rows[going], error[going]
            if not len(rows):
                break
            across = jacobian.transpose(0, 2, 1)
            damping = DAMPED * (error**2).sum(axis=1) + 1e-15
            normal = across @ jacobian + damping[:, None, None] * np.eye(JOINTS)
            step = np.linalg.solve(normal, across @ error[:, :, None])[:, :, 0]
            most = np.abs(step).max(axis=1, keepdims=True)
            joints[rows, :JOINTS] += step * np.minimum(1.0, LARGEST / np.maximum(most, 1e-30))
        found.append(_once(joints[off < REACHED, :JOINTS]))
    return found


KINDS = {"wrist": 4, "elbow": 2, "shoulder": 1}  # the joint that leads there


def near_singular(robot: Robot, kind: str, off: float, count: int) -> Array:
    """Configurations (count, 6) that are ``off`` rad in one joint from where the sign changes.

    That is the sign of the task determinant.
    """
    joint, found = KINDS[kind], []

    def determinant(angle: float, row: Array) -> float:
        poses = forward(robot, np.where(np.arange(6) == joint, angle, row)[None])
        return float(signed_task_determinant(poses)[0])

    turns = np.linspace(-3.1, 3.0, 20)
    for row in np.random.default_rng(29).uniform(-np.pi, np.pi, (20 * count, 6)):
        values = np.array([determinant(turn, row) for turn in turns])
        crossed = np.flatnonzero(values[1:] * values[:-1] < 0)
        if len(crossed):
            low, high = turns[crossed[0]], turns[crossed[0] + 1]
            row[joint] = brentq(determinant, low, high, args=(row,), xtol=1e-14) + off
            found.append(row)
        if len(found) == count:
            break
    return np.array(found)


def _once(solutions: Array) -> Array:
    """Solutions (s, joints) modulo full circles, each once."""
    kept: list[Array] = []
    for q in solutions:
        if all(wrapped(q - other).max() > 1e-6 for other in kept):
            kept.append(q)
    return np.array(kept).reshape(-1, solutions.shape[1])


REGULAR = 1e-5  # of reach^3; nearer to a singularity two solutions are about to meet
SAME = 1e-5  # rad


@dataclass(frozen=True)
class Arm:
    """An arm with its tool and its inverse kinematics."""

    robot: Robot
    family: InverseKinematics

    @classmethod
    def of(cls, setup: Setup) -> Arm:
        """The one that a setup names."""
        arm = prepare_arm(setup)
        return cls(arm.robot, arm.kinematics)

    def solved(self, points: Array, directions: Array) -> list[Array]:
        """Joints 1 to 5 (s, 5) of all solutions of each pose, rad."""
        found = self.family.solve(points, directions)
        return [each[~np.isnan(each[:, 0]), :5] for each in found]

    def is_regular(self, five: Array) -> Mask:
        """Which of some solutions (s, 5) are not about to meet another one, (s,)."""
        poses = forward(self.robot, np.column_stack([five, np.zeros(len(five))]))
        determinant = task_determinant(poses)
        return np.asarray(determinant > REGULAR * self.family.reach**3)

    def different(self, q: Array, starts: int) -> tuple[int, int]:
        """At how many poses of configurations (n, 6) the sets are others than from many starts.

        Returns:
            That, and how many solutions were compared.
        """
        poses = forward(self.robot, q)
        every = from_many_starts(self.robot, poses.tip, poses.tool_axis, starts, 8)
        solutions = different = 0
        for ours, theirs in zip(self.solved(poses.tip, poses.tool_axis), every, strict=True):
            ours, theirs = (five[self.is_regular(five)] for five in (ours, theirs))
            apart = wrapped(ours[:, None] - theirs[None]).max(axis=2, initial=0.0)
            solutions += len(ours)
            different += len(ours) != len(theirs) or bool(
                len(ours) and max(apart.min(axis=0).max(), apart.min(axis=1).max()) > SAME
            )
        return different, solutions

    def lost(self, q: Array, within: float) -> int:
        """How many of configurations (n, 6) are not among the solutions of their own poses."""
        poses = forward(self.robot, q)
        return sum(
            wrapped(ours - own[:5]).max(axis=1).min(initial=np.inf) > within
            for own, ours in zip(q, self.solved(poses.tip, poses.tool_axis), strict=True)
        )
