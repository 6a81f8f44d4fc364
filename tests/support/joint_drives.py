"""Drives of a few joints on the way, and what the judge says of their times and angles."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.joint_motion import JointLimits, judge_joints


def driven(times: Array, joints: Array) -> Trajectory:
    """A drive of joints (k, joints), or of a single one (k,), without contact."""
    joints = joints.reshape(len(times), -1)
    count, names = len(times), tuple(f"joint {k}" for k in range(joints.shape[1]))
    normals, points = np.tile([0.0, 0.0, 1.0], (count, 1)), np.zeros((count, 3))
    away, none = np.zeros(count, dtype=bool), np.full(count, -1)
    return Trajectory("drive", names, times, joints, points, normals, away, none)


def faults_of(
    drive: Trajectory,
    velocity: Array | float = np.inf,
    acceleration: Array | float | None = None,
    jerk: float | None = None,
) -> set[FaultKind]:
    """The kinds of its faults by these limits of each joint, or of all."""
    count = len(drive.joint_names)
    fastest, most, change = (
        None if limit is None else np.full(count, limit) for limit in (velocity, acceleration, jerk)
    )
    assert fastest is not None
    everywhere = np.full(count, np.inf)
    slides = np.zeros(count, bool)
    limits = JointLimits(-everywhere, everywhere, fastest, most, change, slides)
    found = FaultList(drive, np.asarray(drive.points))
    judge_joints(limits, found)
    return set(found.counts)
