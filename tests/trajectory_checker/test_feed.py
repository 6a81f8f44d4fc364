"""The feed of strokes: drives whose speeds are known, and what the judge says of them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from joint_drives import driven

from cellcolor.arrays import Array, stretch_of
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import StrokeFeed
from cellcolor.frontend.setup import Motion
from cellcolor.trajectory_checker.dense import Dense
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.feed import feed_of, judge_feed, judge_tool_speeds
from cellcolor.trajectory_checker.joint_motion import JointLimits
from examples import examples

ASKED, RADIUS = 0.1, 0.01  # m/s, and m of the tool
STEP = 0.01  # s


@examples(100)
@given(st.integers(0, 10**6), st.floats(0.05, 0.3))
def test_the_lowest_feed_is_the_lowest_over_any_stretch(seed: int, window: float) -> None:
    """Against stretches that begin every tenth of a millimeter."""
    random = np.random.default_rng(seed)
    passed, steps = random.uniform(0.01, 1, 40), random.uniform(0.001, 0.1, 40)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    times = np.concatenate([[0.0], np.cumsum(passed)])
    mean, lowest, at, inner = feed_of(passed, steps, window)
    assert lowest <= mean
    begins = np.arange(window, way[-1] - 2 * window, 1e-4)
    if not len(begins):
        return
    taken = np.interp(begins + window, way, times) - np.interp(begins, way, times)
    assert lowest <= window / taken.max() + 1e-9
    assert lowest == pytest.approx(min(mean, window / taken.max()), rel=0.02)
    assert way[at] <= begins[np.argmax(taken)] + 0.1 and 0 <= at < len(steps)
    assert (way[1:][inner] > window).all() and (way[:-1][inner] < way[-1] - window).all()
    between = np.interp([window, way[-1] - window], way, times)
    assert mean == pytest.approx((way[-1] - 2 * window) / (between[1] - between[0]))


def test_a_short_stroke_has_its_mean() -> None:
    mean, lowest, at, inner = feed_of(np.array([1.0, 3.0]), np.array([0.02, 0.02]), 0.02)
    assert (mean, lowest, at, inner.all()) == (0.01, 0.01, 0, True)


def test_where_the_tool_comes_from_rest_nothing_is_slow() -> None:
    """Else a stroke would be slow for a while, with its lowest feed above its mean."""
    ramp = np.linspace(0.001, ASKED, 20)
    speed = np.concatenate([ramp, np.full(200, ASKED), ramp[::-1]])
    feed, _ = judged(speed, np.ones((240, 1)), np.full(1, 9.0), np.full(1, 1e9))
    assert feed.slow_share == 0.0 and feed.why == ""
    assert feed.lowest_m_per_s == pytest.approx(ASKED) == feed.mean_m_per_s


def along(speed: Array, lever: Array) -> tuple[Trajectory, Dense]:
    """A stroke along x at these speeds; each joint moves by ``lever`` times what the tip does."""
    way = np.concatenate([[0.0], np.cumsum(STEP * speed)])
    joints = np.zeros((len(way), lever.shape[1]))
    joints[1:] = np.cumsum(lever * (STEP * speed)[:, None], axis=0)
    plain = driven(STEP * np.arange(len(way)), joints)
    tips = np.column_stack([way, np.zeros((len(way), 2))])
    contact = np.ones(len(way), dtype=bool)
    drive = Trajectory(
        plain.name, plain.joint_names, plain.times, plain.joints, tips, plain.normals, contact,
        np.zeros(len(way), dtype=int),
    )  # fmt: skip
    every = np.arange(len(way))
    return drive, Dense(
        every, np.zeros(len(way)), joints, tips, -plain.normals, contact, stretch_of(contact)
    )


def judged(
    speed: Array, lever: Array, velocity: Array, acceleration: Array, **keys: float
) -> tuple[StrokeFeed, set[str]]:
    drive, dense = along(speed, lever)
    slides = np.zeros(lever.shape[1], dtype=bool)
    everywhere = np.full(len(velocity), np.inf)
    limits = JointLimits(-everywhere, everywhere, velocity, acceleration, None, slides)
    motion = Motion(
        tool_radius_m=RADIUS, speed_m_per_s=ASKED, joint_accelerations_rad_per_s2=(1.0,), **keys
    )
    faults = FaultList(drive, dense.tips)
    (feed,) = judge_feed(dense, limits, motion, faults)
    return feed, set(faults.counts)


def test_a_stroke_at_the_asked_feed_is_not_slow() -> None:
    feed, faults = judged(
        np.full(200, ASKED), np.ones((200, 2)), np.ones(2), np.ones(2), least_feed=1.0
    )
    assert feed.mean_m_per_s == pytest.approx(ASKED) == feed.lowest_m_per_s
    assert (feed.slow_share, feed.joint, feed.why, faults) == (0.0, None, "", set())


def test_a_joint_at_its_velocity_is_named_with_the_slow_share() -> None:
    """Half of the way at half the feed: two thirds of the time, 0.0667 m/s on average."""
    speed = np.concatenate([np.full(100, ASKED), np.full(200, ASKED / 2)])
    lever = np.where(np.arange(300)[:, None] < 100, [[1.0, 1.0]], [[1.0, 8.0]])
    feed, _ = judged(speed, lever, np.array([9.0, 0.4]), np.full(2, 1e9))
    assert feed.mean_m_per_s == pytest.approx(ASKED / 1.5)
    assert feed.lowest_m_per_s == pytest.approx(ASKED / 2)
    assert feed.slow_share == pytest.approx(2 / 3, rel=0.01)
    assert (feed.joint, feed.limited_by) == ("joint 1", "velocity")
    assert "because of the velocity of joint 1" in str(feed)


def test_a_joint_at_its_acceleration_is_named() -> None:
    """A dip with 0.1 m/s² that asks a tenth of what the first joint may, and all of the second."""
    dip = np.concatenate([np.linspace(ASKED, 0.02, 80), np.linspace(0.02, ASKED, 80)])
    speed = np.concatenate([np.full(100, ASKED), dip, np.full(100, ASKED)])
    lever = np.tile([1.0, 10.0], (len(speed), 1))
    feed, _ = judged(speed, lever, np.full(2, 9.0), np.array([1.0, 1.015]))
    assert (feed.joint, feed.limited_by) == ("joint 1", "acceleration")


@pytest.mark.parametrize(("least", "kinds"), [(0.55, {"feed"}), (0.45, set())])
def test_the_least_feed_is_held(least: float, kinds: set[str]) -> None:
    """A stretch at half the feed that is longer than the footprint; at the ends the arm rests."""
    speed = np.concatenate([np.full(100, ASKED), np.full(80, ASKED / 2), np.full(100, ASKED)])
    speed[:10], speed[-10:] = 0.01, 0.01
    _, faults = judged(speed, np.ones((280, 1)), np.ones(1), np.ones(1), least_feed=least)
    assert faults == kinds


@pytest.mark.parametrize(("most", "kinds"), [(0.9, {"velocity"}), (1.1, set()), (None, set())])
def test_the_tip_keeps_to_its_speed_between_strokes(most: float | None, kinds: set[str]) -> None:
    """Along the way that it takes, not from sample to sample: half a circle in a second."""
    plain = driven(np.array([0.0, 1.0]), np.array([0.0, np.pi]))
    count = 200
    turn = np.linspace(0.0, np.pi, count + 1)
    tips = np.column_stack([np.cos(turn), np.sin(turn), 0 * turn]) / np.pi  # 1 m
    sample, away = np.minimum(np.arange(count + 1) // count, 1), np.zeros(count + 1, dtype=bool)
    way = np.arange(count + 1) % count / count
    dense = Dense(sample, way, turn[:, None], tips, tips, away, np.full(count + 1, -1))
    motion = Motion(joint_accelerations_rad_per_s2=(1.0,), transfer_speed_m_per_s=most)
    faults = FaultList(plain, tips[[0, -1]])
    judge_tool_speeds(dense, np.zeros(1, dtype=bool), motion, True, faults)
    assert set(faults.counts) == kinds
