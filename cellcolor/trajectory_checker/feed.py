"""How steadily the tool moves along each stroke, and what slows it down."""

from __future__ import annotations

from typing import Literal

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import StrokeFeed
from cellcolor.frontend.setup import Motion
from cellcolor.trajectory_checker.dense import Dense
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.joint_motion import JointLimits
from cellcolor.trajectory_checker.tolerances import AT_LIMIT, POSE_ROUNDING, SHARE_OVER_LIMIT, SLOW

_Limit = Literal["velocity", "acceleration"]
_LIMITS: tuple[_Limit, ...] = ("velocity", "acceleration")
_LEAST_STEP = 1e-9  # m; a tip that stands still comes as far, so that ways ascend


def judge_feed(
    dense: Dense, limits: JointLimits, motion: Motion, faults: FaultList
) -> tuple[StrokeFeed, ...]:
    """The feed of each stroke; note where it is lower than the setup allows.

    Args:
        dense: the trajectory with configurations in between, along which lengths are measured.
        motion: with the asked feed and the least one.
    """
    trajectory = faults.trajectory
    steps, passed = _steps(trajectory, dense), np.diff(trajectory.times)
    load = _load(trajectory, limits)
    asked, window = motion.speed_m_per_s, 2 * motion.tool_radius_m
    found = []
    for first, after in trajectory.strokes:
        own = slice(first, after - 1)
        if after - first < 2 or (passed[own] <= 0).any():
            continue  # one sample has no feed; times that do not ascend are faults of their own
        mean, lowest, at, inner = feed_of(passed[own], steps[own], window)
        slow = inner & (steps[own] < SLOW * asked * passed[own])
        joint, by = _limiting(load[:, own], slow * passed[own])
        one = StrokeFeed(
            segment=int(trajectory.segment[first]),
            time=float(trajectory.times[first]),
            seconds=float(passed[own].sum()),
            asked_m_per_s=asked,
            mean_m_per_s=mean,
            lowest_m_per_s=lowest,
            window_m=window,
            slow_share=float(passed[own][slow].sum() / passed[own][inner].sum()),
            joint=None if joint is None else trajectory.joint_names[joint],
            limited_by=by,
        )
        found.append(one)
        least = (motion.least_feed or 0.0) * asked
        if lowest < least * (1 - SHARE_OVER_LIMIT):
            low = f"the feed is {lowest:.4g} m/s over {1e3 * window:g} mm"
            text = f"{low}, at least {least:.4g} is asked for{one.why}"
            place = trajectory.points[first + at]
            faults.add("feed", text, first + at, joint=joint, place=place)
    return tuple(found)


def judge_tool_speeds(
    dense: Dense, skip: Mask, motion: Motion, touches: bool, faults: FaultList
) -> None:
    """Note where the tip is faster than the setup allows, in contact and between strokes.

    Args:
        skip: (k - 1,) steps that are known to be no motion.
        touches: whether the tool touches the surface, or stands off it.
    """
    trajectory, contact = faults.trajectory, faults.trajectory.contact
    passed = np.diff(trajectory.times)
    passed = np.where((passed > 0) & ~skip, passed, np.inf)
    straight = np.linalg.norm(np.diff(faults.tips, axis=0), axis=1)
    together, touching = contact[1:] & contact[:-1], contact[1:] != contact[:-1]

    def judge(most: float | None, asked: Mask, way: Array, doing: str) -> None:
        if most is None:
            return
        speed = np.where(asked, way, 0.0) / passed
        over = speed > most * (1 + SHARE_OVER_LIMIT) + POSE_ROUNDING / passed
        faults.add_stretches(
            "velocity",
            over,
            speed,
            lambda k: f"the tool moves at {speed[k]:.4g} m/s {doing}, allowed: {most:.4g}",
        )

    judge(motion.speed_m_per_s, together, straight, "in contact")
    most = motion.approach_speed_m_per_s if touches else None
    judge(most, touching, straight, "where it touches or leaves the surface")
    most = motion.transfer_speed_m_per_s
    judge(most, ~together, _steps(trajectory, dense), "between strokes")


def _steps(trajectory: Trajectory, dense: Dense) -> Array:
    """(k - 1,) how far the tip goes from each sample to the next, m."""
    steps = np.zeros(max(len(trajectory.times) - 1, 0))
    np.add.at(steps, dense.sample[:-1], np.linalg.norm(np.diff(dense.tips, axis=0), axis=1))
    return steps


def feed_of(passed: Array, steps: Array, window: float) -> tuple[float, float, int, Mask]:
    """The mean feed of a stroke and the lowest, m/s, where that begins, and the steps in between.

    A stroke begins and ends at rest. So its first and its last stretch as long as the window do not
    count; if it is not three times as long, all of it does, and the lowest feed is the mean. Else
    the lowest is that over a stretch as long as the window, or over all that counts.

    Args:
        passed: (k,) seconds of each step.
        steps: (k,) how far the tip goes, m.
    """
    way = np.concatenate([[0.0], np.cumsum(np.maximum(steps, _LEAST_STEP))])
    times = np.concatenate([[0.0], np.cumsum(passed)])
    if way[-1] < 3 * window:
        mean = float(way[-1] / times[-1])
        return mean, mean, 0, np.ones(len(steps), dtype=bool)
    first, last = window, float(way[-1]) - window
    inner = (way[1:] > first) & (way[:-1] < last)
    mean = (last - first) / float(np.diff(np.interp([first, last], way, times))[0])
    # The mean is extreme where the stretch begins or ends at a sample.
    begins = np.concatenate([way, way - window, [first, last - window]])
    begins = begins[(begins >= first) & (begins <= last - window)]
    taken = np.interp(begins + window, way, times) - np.interp(begins, way, times)
    worst = int(np.argmax(taken))
    at = int(np.searchsorted(way, begins[worst], side="right")) - 1
    return mean, min(mean, float(window / taken[worst])), at, inner


def _load(trajectory: Trajectory, limits: JointLimits) -> Array:
    """(2, k - 1, joints): of each step the share of each limit of velocity and of acceleration."""
    passed = np.diff(trajectory.times)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        velocity = np.diff(trajectory.joints, axis=0) / passed
        load = np.zeros((2, *velocity.shape))
        load[0] = np.abs(velocity) / limits.velocity
        if limits.acceleration is not None and len(velocity) > 1:
            middles = (passed[1:] + passed[:-1]) / 2
            found = np.abs(np.diff(velocity, axis=0)) / middles / limits.acceleration
            load[1, 1:] = found
            load[1, :-1] = np.maximum(load[1, :-1], found)
    return np.nan_to_num(load)


def _limiting(load: Array, slow_s: Array) -> tuple[int | None, _Limit | None]:
    """The joint and the limit that slow a stroke down for the longest time.

    Where none is near its limit in slow steps, as in a stroke that is slow throughout for the sake
    of one place, it is the one that is nearest anywhere; None if that is not near either.

    Args:
        load: (2, k, joints) of :func:`_load`.
        slow_s: (k,) seconds of the steps that are slow, 0 for others.
    """
    if not np.any(slow_s):
        return None, None
    most = load.max(axis=(0, 2))
    held = np.where(most >= AT_LIMIT, slow_s, 0.0)
    weight = np.asarray((load == most[:, None]) * held[:, None]).sum(axis=1)
    if not weight.any():
        weight = np.where(load >= AT_LIMIT, load, 0.0).max(axis=1)
    if not weight.any():
        return None, None
    kind, joint = np.unravel_index(int(np.argmax(weight)), weight.shape)
    return int(joint), _LIMITS[kind]
