"""Times and joints: order, jumps, limits, velocities, accelerations, jerks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from operator import le

import numpy as np

from cellcolor.arrays import Array, Index, Mask, stretches
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.tolerances import (
    ANGLE_ROUNDING,
    BOW,
    BOW_OF_SLIDE,
    CYCLE,
    JUMP,
    SHARE_OVER_LIMIT,
)


@dataclass(frozen=True)
class JointLimits:
    """What the joints keep to; each (joints,).

    Attributes:
        lower, upper: rad, or m of a slide; infinite where the setup leaves them and collisions out.
        velocity: rad/s or m/s.
        acceleration: rad/s² or m/s²; None where the setup has none.
        jerk: rad/s³ or m/s³; None where the setup has none.
        slides: which joints are prismatic.
    """

    lower: Array
    upper: Array
    velocity: Array
    acceleration: Array | None
    jerk: Array | None
    slides: Mask

    @property
    def units(self) -> list[str]:
        """What the position of each joint is in."""
        return ["m" if slides else "rad" for slides in self.slides]

    def text(self, does: str, found: Array, per: str, most: Array) -> Callable[[int, int], str]:
        """What is said of a row and a joint where ``found`` (k, joints) exceeds what is allowed."""
        units = self.units
        return lambda k, joint: (
            f"{does} {found[k, joint]:.4g} {units[joint]}/{per}, allowed: {most[joint]:.4g}"
        )


def judge_joints(limits: JointLimits, faults: FaultList) -> Mask:
    """Note what is wrong with times and joints.

    Between two samples each joint moves in proportion to time, so its velocity is its step per
    time. Accelerations are those of a smooth motion through the samples.

    Returns:
        (k - 1,) which steps are jumps.
    """
    trajectory = faults.trajectory
    steps = np.diff(trajectory.joints, axis=0)
    _judge_limits(limits, faults)
    together = trajectory.contact[1:] & trajectory.contact[:-1]
    passed = np.diff(trajectory.times) if faults.timed else np.full(len(steps), np.inf)
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
    )
    safe = np.where(ascending, passed, np.inf)[:, None]
    velocity = steps / safe
    rounding = ANGLE_ROUNDING / safe
    fast = np.abs(velocity) > limits.velocity * (1 + SHARE_OVER_LIMIT) + rounding
    fast |= ~ascending[:, None]
    jumps = (np.abs(steps) > JUMP) & (fast | together[:, None])
    for sample, joint in np.argwhere(jumps).tolist():
        by = f"{steps[sample, joint]:.4g} {limits.units[joint]}"
        text = f"{trajectory.joint_names[joint]} moves by {by} to the next sample"
        faults.add("jump", text, sample, sample + 1, joint=joint)
    fast &= ~jumps & ascending[:, None]
    speed = np.abs(velocity)
    said = limits.text("moves at", speed, "s", limits.velocity)
    faults.add_joint_stretches("velocity", fast, speed, said)
    known = ascending & ~jumps.any(axis=1)
    if faults.timed:
        _judge_accelerations(known, limits, faults)
        _judge_jerks(known, limits, faults)
    return np.asarray(jumps.any(axis=1))


def _judge_limits(limits: JointLimits, faults: FaultList) -> None:
    lower, upper, joints = limits.lower, limits.upper, faults.trajectory.joints
    over = np.maximum(joints - upper, lower - joints)

    def beyond(k: int, joint: int) -> str:
        if limits.slides[joint]:
            return f"{1000 * over[k, joint]:.3g} mm"
        return f"{np.degrees(over[k, joint]):.3g} degrees"

    faults.add_joint_stretches(
        "joint limit",
        over > ANGLE_ROUNDING,
        over,
        lambda k, joint: (
            f"is at {joints[k, joint]:.5f} {limits.units[joint]}, {beyond(k, joint)} beyond "
            f"its limits of {lower[joint]:.5f} and {upper[joint]:.5f}"
        ),
    )


def _judge_accelerations(known: Mask, limits: JointLimits, faults: FaultList) -> None:
    """Note samples where no smooth motion through the samples keeps the accelerations.

    Whatever moves on a straight line from sample to sample says no more than the ends of that line
    do, so only these are tested: the verdict is the same however densely lines are sampled. Three
    samples of a motion that keeps a limit keep it as well: twice their second divided difference
    is a mean of the accelerations between them. So do four. If the middle step has the velocity v
    and lasts t, those before and after it have u and w and last r and s, the motion has a velocity
    within ar/2 of u where the middle step begins and within as/2 of w where it ends, and between
    two velocities the mean is at most at/4 off the middle of both: v is at most
    a(r + t + s)/4 off (u + w)/2. The arm rests before the first sample and after the last.

    Along a line of many samples the motion cannot have been elsewhere. It is allowed ``BOW`` off
    the line (``BOW_OF_SLIDE`` if it is prismatic), so where the line ends its velocity is within
    sqrt(2 a BOW) of the line's: longer lines have no more time for a change than those for which
    that is ar/2.

    Args:
        known: (k - 1,) steps that are motions.
    """
    times, joints, most = faults.trajectory.times, faults.trajectory.joints, limits.acceleration
    if most is None or len(known) < 2:
        return
    # In which a velocity can change beside a line, and from one end of it to the other.
    longest = np.sqrt(8 * np.where(limits.slides, BOW_OF_SLIDE, BOW) / most)
    for first, after in stretches(known):
        rows = first + corners(times[first : after + 1], joints[first : after + 1])
        passed = np.diff(times[rows])
        velocity = np.diff(joints[rows], axis=0) / passed[:, None]
        rest = np.zeros((1, joints.shape[1]))  # steps of no time
        if first == 0:
            passed, velocity = np.insert(passed, 0, 0.0), np.concatenate([rest, velocity])
            rows = np.insert(rows, 0, 0)
        if after == len(known):
            passed, velocity = np.append(passed, 0.0), np.concatenate([velocity, rest])
            rows = np.append(rows, len(times) - 1)
        if len(passed) < 2:
            continue
        # What a rounding of angles makes of a velocity; rest has none.
        rounding = np.divide(ANGLE_ROUNDING, passed, where=passed > 0, out=np.zeros_like(passed))
        rounding = rounding[:, None]
        beside = np.minimum(passed[:, None], longest)
        along = np.minimum(passed[:, None], 2 * longest)
        between = (beside[1:] + beside[:-1]) / 2
        found = np.abs(np.diff(velocity, axis=0)) / between
        over = found > most * (1 + SHARE_OVER_LIMIT) + (rounding[1:] + rounding[:-1]) / between
        if len(passed) > 2:
            mean = (beside[2:] + along[1:-1] + beside[:-2]) / 4
            off = np.abs(velocity[1:-1] - (velocity[2:] + velocity[:-2]) / 2) / mean
            slack = (rounding[1:-1] + (rounding[2:] + rounding[:-2]) / 2) / mean
            # Both ends of the middle step are at fault; it is noted where it begins.
            over[:-1] |= off > most * (1 + SHARE_OVER_LIMIT) + slack
            found[:-1] = np.maximum(found[:-1], off)
        at_fault, excess = np.zeros(joints.shape, dtype=bool), np.zeros(joints.shape)
        at_fault[rows[1:-1]], excess[rows[1:-1]] = over, found
        text = limits.text("accelerates by", excess, "s²", most)
        faults.add_joint_stretches("acceleration", at_fault, excess, text)


def _judge_jerks(known: Mask, limits: JointLimits, faults: FaultList) -> None:
    """Note samples where no smooth motion through the samples keeps the jerks.

    Six times the third divided difference of four samples is a mean of the jerks between the first
    and the last, for any smooth motion through them. From each corner of the motion, the three next
    ones that are a cycle or more apart are taken. The arm rests before the first sample and after
    the last. A velocity that changes at once between two long lines is left to the accelerations.

    Args:
        known: (k - 1,) steps that are motions.
    """
    trajectory, most = faults.trajectory, limits.jerk
    if most is None:
        return
    at_fault, excess = (
        np.zeros(trajectory.joints.shape, dtype=bool),
        np.zeros_like(trajectory.joints),
    )
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
    text = limits.text("jerks by", excess, "s³", most)
    faults.add_joint_stretches("jerk", at_fault, excess, text)


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


def corners(times: Array, joints: Array) -> Index:
    """The samples (c,) between which all joints move in proportion to time, up to rounding.

    A sample is left out if the line from the last corner to some later sample passes it, and all
    that lie between, within a rounding of angles: many samples of a slow bend keep some of them.
    """
    kept = [0]
    # For rows of a few numbers, plain floats are many times faster than arrays.
    at, rows = times.tolist(), joints.tolist()
    low, high = [-np.inf] * joints.shape[1], [np.inf] * joints.shape[1]
    for k, row in enumerate(rows[1:], 1):
        begin = kept[-1]
        passed = at[k] - at[begin]
        slopes = [(there - here) / passed for here, there in zip(rows[begin], row, strict=True)]
        fits = all(map(le, low, slopes)) and all(map(le, slopes, high))
        if k > begin + 1 and not fits:
            kept.append(k - 1)
            passed = at[k] - at[k - 1]
            slopes = [(there - here) / passed for here, there in zip(rows[k - 1], row, strict=True)]
            low, high = [-np.inf] * len(row), [np.inf] * len(row)
        rounding = ANGLE_ROUNDING / passed
        low = [max(least, slope - rounding) for least, slope in zip(low, slopes, strict=True)]
        high = [min(most, slope + rounding) for most, slope in zip(high, slopes, strict=True)]
    kept.append(len(at) - 1)
    return np.array(kept)
