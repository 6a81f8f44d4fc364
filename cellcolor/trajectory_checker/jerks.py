"""Jerks of joints: how fast their accelerations change."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.trajectory_checker.corners import corners
from cellcolor.trajectory_checker.fault_list import FaultList, stretches
from cellcolor.trajectory_checker.tolerances import ANGLE_ROUNDING, CYCLE, SHARE_OVER_LIMIT


def judge_jerks(
    trajectory: Trajectory,
    known: Mask,
    tips: Array,
    most: Array,
    units: list[str],
    faults: FaultList,
) -> None:
    """Note samples where no smooth motion through the samples keeps the jerks.

    Six times the third divided difference of four samples is a mean of the jerks between the first
    and the last, for any smooth motion through them. From each corner of the motion, the three next
    ones that are a cycle or more apart are taken. The arm rests before the first sample and after
    the last. A velocity that changes at once between two long lines is left to the accelerations.

    Args:
        known: (k - 1,) steps that are motions.
        tips: (k, 3) where the tool's tip is, m.
        most: (joints,) rad/s³ or m/s³.
        units: (joints,) of positions.
    """
    at_fault = np.zeros(trajectory.joints.shape, dtype=bool)
    excess = np.zeros(trajectory.joints.shape)
    rest = CYCLE * np.arange(1, 4)
    for first, after in stretches(known):
        before, behind = 3 * (first == 0), 3 * (after == len(known))  # times at rest
        moving = slice(first, after + 1)
        rows = first + corners(trajectory.times[moving], trajectory.joints[moving])
        rows = np.pad(rows, (before, behind), "edge")
        times, joints = trajectory.times[rows], trajectory.joints[rows]
        times[:before] -= rest[::-1][:before]
        times[len(times) - behind :] += rest[:behind]
        jerk, rounding, second = _jerks(times, joints)
        over = jerk > most * (1 + SHARE_OVER_LIMIT) + rounding[:, None]
        at = rows[second]
        np.logical_or.at(at_fault, at, over)
        np.maximum.at(excess, at, jerk)
    faults.add_joint_stretches(
        "jerk",
        at_fault,
        excess,
        lambda k, joint: (
            f"jerks by {excess[k, joint]:.4g} {units[joint]}/s³, allowed: {most[joint]:.4g}"
        ),
        tips,
    )


def _jerks(times: Array, joints: Array) -> tuple[Array, Array, Index]:
    """Mean jerks (n, joints), what a rounding of angles adds (n,), and each second sample (n,)."""
    four = [np.arange(len(times))]
    for _ in range(3):
        four.append(np.searchsorted(times, times[four[-1]] + CYCLE * (1 - 1e-9)))
        four = [samples[four[-1] < len(times)] for samples in four]
    jerk, rounding = np.zeros((len(four[0]), joints.shape[1])), np.zeros(len(four[0]))
    for number, sample in enumerate(four):
        others = [times[sample] - times[other] for other in four[:number] + four[number + 1 :]]
        weight = 6 / np.prod(others, axis=0)
        jerk += weight[:, None] * joints[sample]
        rounding += np.abs(weight) * ANGLE_ROUNDING
    return np.abs(jerk), rounding, four[1]
