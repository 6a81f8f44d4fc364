"""What accelerations say of a line of samples: an arm that cruises neither stops nor starts."""

from __future__ import annotations

import numpy as np
import pytest
from honest_drives import resampled
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.joint_motion import JointLimits, judge_joints
from examples import examples

MOST = 8.0  # rad/s²
APART = 0.29  # s; a motion with 8 rad/s² is at most a t²/8 = 4.8 degrees off the line between


def driven(times: Array, joint: Array) -> Trajectory:
    """A drive of one joint on the way."""
    count = len(times)
    normals = np.tile([0.0, 0.0, 1.0], (count, 1))
    away, none = np.zeros(count, dtype=bool), np.full(count, -1)
    joints, points = joint[:, None], np.zeros((count, 3))
    return Trajectory("one", ("joint",), times, joints, points, normals, away, none)


def faults(trajectory: Trajectory) -> set[FaultKind]:
    limits = JointLimits(
        None, None, np.array([np.inf]), np.array([MOST]), None, np.inf, np.zeros(1, bool)
    )
    found = FaultList(trajectory, timed=True)
    judge_joints(trajectory, np.asarray(trajectory.points), limits, True, found)
    return set(found.counts)


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
    assert "acceleration" not in faults(drive)
    assert "acceleration" not in faults(resampled(drive, 0.01))


@pytest.mark.parametrize("step", [0.001, 0.05])
def test_an_arm_that_cruises_neither_stops_nor_starts(step: float) -> None:
    """At 1.9 rad/s it takes 0.24 s and 13 degrees to stop, and each sample says where it is."""
    changes = np.cumsum([0.0, 1.9 / MOST, 1.5, 1.9 / MOST])
    times = np.append(np.arange(0.0, changes[-1] - step / 2, step), changes[-1])
    whole = driven(times, at(times, changes, np.array([MOST, 0.0, -MOST])))
    assert faults(whole) == set()
    joint, row = np.asarray(whole.joints)[:, 0], int(np.searchsorted(times, 1.0))
    later = np.insert(times + 0.1 * (times > times[row]), row + 1, times[row] + 0.1)
    doubled = driven(later, np.insert(joint, row + 1, joint[row]))
    begun, ended = driven(times[row:], joint[row:]), driven(times[:row], joint[:row])
    for forged in (doubled, begun, ended):
        assert faults(forged) == {"acceleration"}
        assert faults(resampled(forged, 0.005)) == {"acceleration"}
