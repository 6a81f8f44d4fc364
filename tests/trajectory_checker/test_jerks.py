"""Jerks of a drive, held against splines whose jerk is constant between knots."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.joint_motion import JointLimits, judge_joints
from cellcolor.trajectory_checker.tolerances import ANGLE_ROUNDING
from examples import examples

APART = 0.2  # s, between knots


def driven(times: Array, joint: Array) -> Trajectory:
    """A drive of one joint."""
    count = len(times)
    normals, points = np.tile([0.0, 0.0, 1.0], (count, 1)), np.zeros((count, 3))
    away, none = np.zeros(count, dtype=bool), np.full(count, -1)
    return Trajectory("one", ("joint",), times, joint[:, None], points, normals, away, none)


def faults(trajectory: Trajectory, jerk: float) -> set[FaultKind]:
    free = np.array([np.inf])
    limits = JointLimits(None, None, free, None, np.array([jerk]), np.inf, np.zeros(1, bool))
    found = FaultList(trajectory, timed=True)
    judge_joints(trajectory, np.asarray(trajectory.points), limits, True, found)
    return set(found.counts)


@examples(60)
@given(seed=st.integers(0, 100_000), decimals=st.sampled_from([6, 15]))
def test_a_drive_is_at_fault_just_where_its_jerk_is_above_the_limit(
    seed: int, decimals: int
) -> None:
    """A cubic spline from rest to rest; its jerks are third differences of its coefficients."""
    rng = np.random.default_rng(seed)
    inner = np.cumsum(rng.uniform(-1.0, 1.0, 6) + 0.1)
    # Equal coefficients at both ends: no velocity and no acceleration there.
    coefficients = np.concatenate([np.zeros(4), inner, inner[[-1] * 4]])
    spline = BSpline(APART * np.arange(len(coefficients) + 4), coefficients, 3)
    most = float(np.abs(np.diff(coefficients, 3)).max()) / APART**3
    begin, end = 3 * APART, len(coefficients) * APART
    times = begin + np.cumsum(rng.uniform(0.001, rng.choice([0.003, 0.02]), 20_000))
    times = np.concatenate([[begin], times[times < end - 0.001], [end]])
    drive = driven(times - begin, np.round(spline(times), decimals))
    assert "jerk" not in faults(drive, most)
    # Angles are taken for rounded, which over 8 ms is a jerk of 8 roundings / (8 ms)³.
    assert "jerk" in faults(drive, 0.95 * most - 8 * ANGLE_ROUNDING / 0.008**3)


def test_accelerations_that_begin_at_once_are_at_fault() -> None:
    """0 to 8 rad/s² at a sample: third differences are half of 8 (8 ms)² before it and after it."""
    times = np.arange(0.0, 1.0, 0.008)
    speed = 8 * np.minimum(np.minimum(times, 0.2), 1.0 - 0.008 - times)
    place = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * 0.008)])
    assert "jerk" in faults(driven(times, place), 450.0)
    assert "jerk" not in faults(driven(times, place), 550.0)
