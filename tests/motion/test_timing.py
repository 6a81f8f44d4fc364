"""Times of a motion: limits kept, by computations of the tests' own, and no slower than need be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from joint_drives import driven, faults_of

from cellcolor.arrays import Array
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.motion.timing import Speeds, evenly_timed, timed
from examples import examples


def test_many_sharp_bends_slow_down_only_what_is_beside_them() -> None:
    """Between them the tool is as fast as was asked for: nothing is stretched as a whole."""
    rng = np.random.default_rng(1)
    bends = 200 * np.arange(1, 25)
    slopes = np.zeros((5000, 6))
    for start in bends:
        width = int(rng.integers(2, 20))
        slopes[start : start + width] = rng.uniform(-0.02, 0.02, (width, 6))
    joints = np.cumsum(slopes, axis=0)
    points = np.zeros((5000, 3))
    points[:, 0] = 0.001 * np.arange(5000)
    times = timed(joints, Speeds(np.full(6, 3.0), np.full(6, 10.0)), points, 0.05)
    speeds = 0.001 / np.diff(times)
    far = np.abs(np.arange(4999)[:, None] - np.array([0, *bends, 4999])).min(axis=1) > 60
    assert far.sum() > 1000
    assert speeds[far] == pytest.approx(0.05)
    velocity = np.diff(joints, axis=0) / np.diff(times)[:, None]
    change = np.diff(velocity, axis=0) / ((times[2:] - times[:-2]) / 2)[:, None]
    assert np.abs(change).max() <= 10.0 + 1e-6


def test_closer_samples_do_not_slow_down() -> None:
    """The same smooth way, with eight times as many samples in its middle: the speed stays."""
    even = np.linspace(0.0, 1.0, 201)
    closer = np.concatenate([even[:80], np.linspace(0.4, 0.6, 321), even[121:]])
    for at in (even, closer):
        joints = np.column_stack([1.5 * np.sin(5 * at), 2 * np.cos(5 * at)])
        points = np.column_stack([joints, np.zeros(len(at))])
        times = timed(joints, Speeds(np.full(2, 3.0), np.full(2, 5.0)), points, 0.6)
        speeds = np.linalg.norm(np.diff(points, axis=0), axis=1) / np.diff(times)
        assert speeds[5:-5] == pytest.approx(0.6)


def faults(joints: Array, times: Array, speeds: Speeds) -> set[FaultKind]:
    """What the judge says of joints that rest before and after."""
    joints = joints[[0, *range(len(joints)), -1]]
    times = np.concatenate([[0.0], 1.0 + times, [2.0 + times[-1]]])
    return faults_of(driven(times, joints), speeds.velocities, speeds.accelerations)


@examples(30)
@given(st.integers(0, 10**6), st.integers(2, 30), st.sampled_from([0.001, 0.02, 0.4]))
def test_the_judge_finds_no_fault_in_times_of_steps_of_any_length(
    seed: int, count: int, size: float
) -> None:
    """Beside a long step a joint may turn back; it cannot speed up all along that step."""
    rng = np.random.default_rng(seed)
    steps = rng.uniform(-size, size, (count, 2)) * rng.choice([0.1, 1.0], (count, 1))
    joints, speeds = np.cumsum(steps, axis=0), Speeds(np.full(2, 2.0), np.array([5.0, 3.0]))
    assert not faults(joints, timed(joints, speeds), speeds)


@pytest.mark.parametrize("seed", range(4))
def test_an_even_stroke_keeps_its_feed_but_at_its_ends(seed: int) -> None:
    """One joint has to swing: at full speed the feed drops there."""
    random = np.random.default_rng(seed)
    way = np.linspace(0.0, 1.0, 1001)
    inside = np.clip((way - 0.4) / 0.3, 0.0, 1.0)
    swing = 0.1 * np.sin(np.pi * inside) ** 2 * np.sin(2 * np.pi * random.uniform(3, 8) * way)
    joints, points = np.column_stack([way, swing]), np.column_stack([way, way * 0, way * 0])
    speeds, window = Speeds(np.array([3.0, 3.0]), np.array([8.0, 8.0])), 0.03

    def feeds(times: Array) -> Array:
        """Over each stretch as long as the window, without the first and the last one."""
        begins = np.arange(window, 1.0 - 2 * window, 0.001)
        passed = np.interp(begins + window, way, times) - np.interp(begins, way, times)
        return np.asarray(window / passed)

    plain = feeds(timed(joints, speeds, points, 1.0))
    assert plain.min() < 0.8 * plain.max()
    even = feeds(evenly_timed(joints, speeds, points, 1.0, window))
    assert even.min() > 0.89 * even.max()
    assert even.max() > 0.95 * plain.min()  # no slower than the slowest place asks for
    # What is even already is left as it is.
    assert np.array_equal(
        evenly_timed(joints, speeds, points, 0.05, window), timed(joints, speeds, points, 0.05)
    )
