"""A trajectory with configurations put in wherever two samples are too far apart to be trusted.

The planner has its own code for joint steps and for angles between vectors. The judge repeats these
few lines on purpose: with the planner's code it would not find the planner's faults.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask, numbered, stretch_of
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge
from cellcolor.frontend.arm.kinematics import angle_about, forward, tool_across
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.turned import turn_at
from cellcolor.frontend.setup import Turn
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.tolerances import STEP, STEP_ANGLE

_MOST = 3_000_000  # configurations; some hundred bytes each
_SLACK = 1e-6  # of a step: samples exactly one step apart need none in between


@dataclass(frozen=True)
class Dense:
    """Samples, and configurations on the way from one to the next, in the order of the motion.

    Attributes:
        sample: (d,) the sample, or the one before.
        way: (d,) the share of the way to the next sample, 0 at a sample.
        joints: (d, joints) in rad or m.
        tips: (d, 3) where the tool's tip is, m.
        axes: (d, 3) unit vectors along the tool, from the flange to the tip.
        contact: (d,) whether it is in contact: between two samples if both are.
        stroke: (d,) number of the stroke, -1 without contact.
    """

    sample: Index
    way: Array
    joints: Array
    tips: Array
    axes: Array
    contact: Mask
    stroke: Index

    def __len__(self) -> int:
        return len(self.sample)

    def where(self, row: int) -> str:
        """How a sentence about a row ends; empty for a sample."""
        return ", between it and the next sample" if self.way[row] else ""

    @property
    def outward(self) -> Array:
        """(d, 3) against the tool's axis."""
        return -self.axes


def joints_off(slides: Mask, joints: Array, known: Array) -> Array:
    """How far configurations (k, joints) are from known ones (k, branches, joints), (k, branches).

    In the joint that is farthest, m or rad modulo full circles; infinite if none is known.
    """
    way = known - joints[:, None]
    around = np.remainder(way + np.pi, 2 * np.pi) - np.pi
    off = np.abs(np.where(slides, way, around)).max(axis=2)
    return np.where(np.isnan(off), np.inf, off)


def angles(one: Array, other: Array) -> Array:
    """Angles (k,) between unit vectors (k, 3), rad."""
    chord = np.linalg.norm(one - other, axis=1)
    return np.asarray(2 * np.arcsin(np.clip(chord / 2, 0.0, 1.0)))


def poses_of(robot: Robot, joints: Array, deadline: Deadline) -> tuple[Array, Array]:
    """Tips and tool axes (k, 3) of configurations (k, joints)."""
    tips, axes = np.empty((len(joints), 3)), np.empty((len(joints), 3))
    for rows in chunks(len(joints)):
        deadline.check()
        poses = forward(robot, joints[rows])
        tips[rows], axes[rows] = poses.tip, poses.tool_axis
    return tips, axes


def across_of(robot: Robot, joints: Array, deadline: Deadline = NEVER) -> Array:
    """The tool's x axis (k, 3) in the world, in configurations (k, joints)."""
    across = np.empty((len(joints), 3))
    for rows in chunks(len(joints)):
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


def densified(
    trajectory: Trajectory, robot: Robot, tips: Array, axes: Array, skip: Mask, deadline: Deadline
) -> Dense:
    """Insert configurations, so that tip, axis and joints move at most a step from one to the next.

    Args:
        tips, axes: (k, 3) of the samples.
        skip: (k - 1,) steps that are known to be no motion: nothing is put into them.

    Raises:
        TooLarge: there would be millions.
    """
    joints, count = trajectory.joints, len(trajectory.joints)
    most = np.where(robot.slides, STEP, STEP_ANGLE)
    steps = (np.abs(np.diff(joints, axis=0)) / most).max(axis=1, initial=0.0)
    moved = np.linalg.norm(np.diff(tips, axis=0), axis=1) / STEP
    turned = angles(axes[1:], axes[:-1]) / STEP_ANGLE
    longest = np.maximum(np.maximum(steps, moved), turned)
    pieces = np.maximum(np.ceil(longest - _SLACK), 1).astype(np.int64)
    pieces[skip] = 1
    pieces = np.append(pieces, 1) if count else pieces
    if pieces.sum() > _MOST:
        raise TooLarge(f"the trajectory is too long: more than {_MOST} configurations to be tested")
    sample, number = numbered(pieces)
    way = number / pieces[sample]
    after = np.minimum(sample + 1, max(count - 1, 0))
    at = joints[sample] + way[:, None] * (joints[after] - joints[sample])
    all_tips, all_axes = tips[sample], axes[sample]
    put_in = np.flatnonzero(number)
    all_tips[put_in], all_axes[put_in] = poses_of(robot, at[put_in], deadline)
    contact = trajectory.contact[sample] & (trajectory.contact[after] | (number == 0))
    return Dense(sample, way, at, all_tips, all_axes, contact, stretch_of(contact))
