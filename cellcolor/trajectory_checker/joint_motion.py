"""Times and joints alone: order, jumps, limits, velocities, accelerations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.tolerances import ANGLE_ROUNDING, JUMP, SHARE_OVER_LIMIT

__all__ = ["JointLimits", "judge_joints"]


@dataclass(frozen=True)
class JointLimits:
    """What the joints keep to; each (joints,).

    Attributes:
        lower, upper: rad; None where the setup leaves limits and collisions out.
        velocity: rad/s.
        acceleration: rad/s²; None where the setup has none.
    """

    lower: Array | None
    upper: Array | None
    velocity: Array
    acceleration: Array | None


def judge_joints(
    trajectory: Trajectory, tips: Array, limits: JointLimits, timed: bool, faults: FaultList
) -> Mask:
    """Note what is wrong with times and joints.

    Between two samples each joint moves in proportion to time, so its velocity is its step per
    time. Three neighboring samples of a smooth motion have an acceleration between them: the
    second divided difference, twice, is a mean of the accelerations there, so it keeps a limit if
    the motion does.

    Args:
        tips: (k, 3) where the tool's tip is, m.

    Returns:
        (k - 1,) which steps are jumps.
    """
    steps = np.diff(trajectory.joints, axis=0)
    _judge_limits(trajectory, tips, limits, faults)
    together = trajectory.contact[1:] & trajectory.contact[:-1]
    if not timed:
        jumps = (np.abs(steps) > JUMP) & together[:, None]
        _note_jumps(jumps, steps, trajectory.joint_names, tips, faults)
        return np.asarray(jumps.any(axis=1))
    passed = np.diff(trajectory.times)
    ascending = passed > 0
    faults.add_stretches(
        "time",
        np.concatenate([[False], ~ascending]),
        np.concatenate([[0.0], -passed]),
        lambda k: (
            f"{-passed[k - 1]:.6g} s before the sample before it"
            if passed[k - 1]
            else "at the time of the sample before it"
        ),
        tips,
    )
    safe = np.where(ascending, passed, np.inf)[:, None]
    velocity = steps / safe
    rounding = ANGLE_ROUNDING / safe
    fast = np.abs(velocity) > limits.velocity * (1 + SHARE_OVER_LIMIT) + rounding
    fast |= ~ascending[:, None]
    jumps = (np.abs(steps) > JUMP) & (fast | together[:, None])
    _note_jumps(jumps, steps, trajectory.joint_names, tips, faults)
    fast &= ~jumps & ascending[:, None]
    faults.add_joint_stretches(
        "velocity",
        fast,
        np.abs(velocity),
        lambda k, joint: (
            f"moves at {abs(velocity[k, joint]):.4g} rad/s, allowed are "
            f"{limits.velocity[joint]:.4g}"
        ),
        tips,
    )
    if limits.acceleration is not None and len(passed) > 1:
        known = ascending & ~jumps.any(axis=1)
        _judge_accelerations(velocity, passed, known, tips, limits.acceleration, faults)
    return np.asarray(jumps.any(axis=1))


def _judge_limits(
    trajectory: Trajectory, tips: Array, limits: JointLimits, faults: FaultList
) -> None:
    lower, upper, joints = limits.lower, limits.upper, trajectory.joints
    if lower is None or upper is None:
        return
    over = np.maximum(joints - upper, lower - joints)
    faults.add_joint_stretches(
        "joint limit",
        over > ANGLE_ROUNDING,
        over,
        lambda k, joint: (
            f"is at {joints[k, joint]:.5f} rad, {np.degrees(over[k, joint]):.3g} degrees beyond "
            f"its limits of {lower[joint]:.5f} and {upper[joint]:.5f}"
        ),
        tips,
    )


def _note_jumps(
    jumps: Mask, steps: Array, names: tuple[str, ...], tips: Array, faults: FaultList
) -> None:
    for sample, joint in np.argwhere(jumps).tolist():
        text = f"{names[joint]} moves by {steps[sample, joint]:.4g} rad to the next sample"
        faults.add("jump", text, sample, sample + 1, joint, place=tips[sample])


def _judge_accelerations(
    velocity: Array, passed: Array, known: Mask, tips: Array, most: Array, faults: FaultList
) -> None:
    """Note samples whose two neighbors show too great an acceleration; ``known`` steps only."""
    both = known[1:] & known[:-1]
    before, after = passed[:-1], passed[1:]
    between = np.where(both, (before + after) / 2, np.inf)[:, None]
    acceleration = np.abs(np.diff(velocity, axis=0)) / between
    shorter = np.where(both, np.minimum(before, after), np.inf)[:, None]
    rounding = 2 * ANGLE_ROUNDING / (shorter * between)
    over = acceleration > most * (1 + SHARE_OVER_LIMIT) + rounding
    none = np.zeros((1, over.shape[1]))
    faults.add_joint_stretches(
        "acceleration",
        np.concatenate([none.astype(bool), over]),
        np.concatenate([none, acceleration]),
        lambda k, joint: (
            f"accelerates by {acceleration[k - 1, joint]:.4g} rad/s², allowed are {most[joint]:.4g}"
        ),
        tips,
    )
