"""The tool's turn about its axis, where the setup gives it: which one it is, and how far off."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.kinematics import angle_about, bytes_of_poses, forward, tool_across
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.turned import turn_at
from cellcolor.frontend.setup import Turn
from cellcolor.memory import chunks


def across_of(robot: Robot, joints: Array, deadline: Deadline = NEVER) -> Array:
    """The tool's x axis (k, 3) in the world, in configurations (k, joints)."""
    across = np.empty((len(joints), 3))
    for rows in chunks(len(joints), bytes_of_poses(robot.joints)):
        deadline.check()
        across[rows] = tool_across(robot, forward(robot, joints[rows]))
    return across


def turns_off(turn: Turn, points: Array, directions: Array, across: Array) -> Array:
    """How far the tool is from each of the turns that the setup gives, (k, turns) in rad.

    Args:
        points: (k, 3) the tip, m.
        directions: (k, 3) unit vectors that the tool's z axis should have.
        across: (k, 3) the tool's x axis.

    Returns:
        From 0 to pi; infinite where the setup's rule says nothing.
    """
    angle = angle_about(directions, turn_at(turn, points, directions), across)
    off = angle[:, None] - np.radians(turn.degrees)
    off = np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi)
    return np.asarray(np.where(np.isnan(off), np.inf, off))
