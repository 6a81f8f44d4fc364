"""Accelerations and jerks: an arm that cruises neither stops nor starts, a spline has its jerk."""

from __future__ import annotations

import numpy as np
import pytest
from honest_drives import resampled
from hypothesis import given
from hypothesis import strategies as st
from joint_drives import driven, faults_of
from scipy.interpolate import BSpline

from cellcolor.arrays import Array
from cellcolor.trajectory_checker.tolerances import ANGLE_ROUNDING
from examples import examples

MOST = 8.0  # rad/s²
APART = 0.29  # s; a motion with 8 rad/s² is at most a t²/8 = 4.8 degrees off the line between
KNOTS = 0.2  # s, between those of splines


def smooth(random: np.random.Generator) -> tuple[Array, Array]:
    """Rest to rest with accelerations of 8 rad/s² at most and cruises between, and when it ends.

    Returns:
        When the acceleration changes (k + 1,), and the accelerations (k,) from then on.
    """
    pieces = [(0.0, 0.0)]
    for _ in range(int(random.integers(1, 4))):
        size, lasts = random.uniform(-MOST, MOST), random.uniform(0.02, 0.5)
        pieces += [(lasts, size), (random.choice([0.0, 0.3, 2.0]), 0.0), (lasts, -size)]
        pieces += [(random.choice([0.0, 0.1]), 0.0)]
    lasts, sizes = np.array([piece for piece in pieces if piece[0]]).T
    return np.concatenate([[0.0], np.cumsum(lasts)]), sizes


def at(times: Array, changes: Array, sizes: Array) -> Array:
    """Where it is then."""
    lasts = np.diff(changes)
    speed = np.concatenate([[0.0], np.cumsum(sizes * lasts)])
    place = np.concatenate([[0.0], np.cumsum(speed[:-1] * lasts + sizes * lasts**2 / 2)])
    piece = np.clip(np.searchsorted(changes, times, "right") - 1, 0, len(sizes) - 1)
    since = times - changes[piece]
    return np.asarray(place[piece] + speed[piece] * since + sizes[piece] * since**2 / 2)


@examples(100)
@given(seed=st.integers(0, 100_000), decimals=st.sampled_from([6, 15]))
def test_a_motion_that_keeps_its_limits_has_no_fault(seed: int, decimals: int) -> None:
    """However it is sampled, and sampled more densely once more."""
    random = np.random.default_rng(seed)
    changes, sizes = smooth(random)
    steps = random.uniform(0.001, random.choice([0.002, 0.05, APART]), 20_000)
    times = np.cumsum(steps)
    times = np.concatenate([[0.0], times[times < changes[-1] - 0.001], changes[-1:]])
    if times[-1] - times[-2] > APART:
        times = np.insert(times, -1, (times[-1] + times[-2]) / 2)
    drive = driven(times, np.round(at(times, changes, sizes), decimals))
    assert "acceleration" not in faults_of(drive, acceleration=MOST)
    assert "acceleration" not in faults_of(resampled(drive, 0.01), acceleration=MOST)


@pytest.mark.parametrize("step", [0.001, 0.05])
def test_an_arm_that_cruises_neither_stops_nor_starts(step: float) -> None:
    """At 1.9 rad/s it takes 0.24 s and 13 degrees to stop, and each sample says where it is."""
    changes = np.cumsum([0.0, 1.9 / MOST, 1.5, 1.9 / MOST])
    times = np.append(np.arange(0.0, changes[-1] - step / 2, step), changes[-1])
    whole = driven(times, at(times, changes, np.array([MOST, 0.0, -MOST])))
    assert faults_of(whole, acceleration=MOST) == set()
    joint, row = np.asarray(whole.joints)[:, 0], int(np.searchsorted(times, 1.0))
    later = np.insert(times + 0.1 * (times > times[row]), row + 1, times[row] + 0.1)
    doubled = driven(later, np.insert(joint, row + 1, joint[row]))
    begun, ended = driven(times[row:], joint[row:]), driven(times[:row], joint[:row])
    for forged in (doubled, begun, ended):
        assert faults_of(forged, acceleration=MOST) == {"acceleration"}
        assert faults_of(resampled(forged, 0.005), acceleration=MOST) == {"acceleration"}


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
    spline = BSpline(KNOTS * np.arange(len(coefficients) + 4), coefficients, 3)
    most = float(np.abs(np.diff(coefficients, 3)).max()) / KNOTS**3
    begin, end = 3 * KNOTS, len(coefficients) * KNOTS
    times = begin + np.cumsum(rng.uniform(0.001, rng.choice([0.003, 0.02]), 20_000))
    times = np.concatenate([[begin], times[times < end - 0.001], [end]])
    drive = driven(times - begin, np.round(spline(times), decimals))
    assert "jerk" not in faults_of(drive, jerk=most)
    # Angles are taken for rounded, which over 8 ms is a jerk of 8 roundings / (8 ms)³.
    assert "jerk" in faults_of(drive, jerk=0.95 * most - 8 * ANGLE_ROUNDING / 0.008**3)
