"""How far the tip of any arm gets, joint limits aside."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot

__all__ = ["farthest_reach"]

_TRIES = 4096
_CLIMBED = 16
_ROUNDS = 500
_GAIN = 1e-13  # m; a round that brings less is the last


def farthest_reach(robot: Robot, shoulder: Array) -> float:
    """The farthest that the tip gets from a point (3,) on the first joint's axis, m.

    Prismatic joints stand at zero. From the best of many configurations, always the same ones, one
    joint after the other is turned to where the tip is farthest: opposite to the point, as seen
    along the joint's axis.
    """
    tries = np.random.default_rng(0).uniform(-np.pi, np.pi, (_TRIES, robot.joints))
    tries[:, robot.slides] = 0.0
    best = np.argsort(-_distances(robot, tries, shoulder), kind="stable")[:_CLIMBED]
    q, farthest = tries[best], 0.0
    for _ in range(_ROUNDS):
        for joint in robot.turning[1:]:
            poses = forward(robot, q)
            axis, start = poses.axis[:, joint], poses.origin[:, joint + 1]
            moved, away = poses.tip - start, start - shoulder
            sine = np.einsum("ni,ni->n", axis, np.cross(moved, away))
            along = np.einsum("ni,ni->n", axis, moved) * np.einsum("ni,ni->n", axis, away)
            q[:, joint] += np.arctan2(sine, np.einsum("ni,ni->n", moved, away) - along)
        reached = float(_distances(robot, q, shoulder).max())
        if reached - farthest <= _GAIN:
            break
        farthest = reached
    return farthest


def _distances(robot: Robot, configurations: Array, shoulder: Array) -> Array:
    return np.asarray(np.linalg.norm(forward(robot, configurations).tip - shoulder, axis=1))
