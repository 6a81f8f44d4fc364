"""The input of every export, its samples as controllers take them, and what an export is.

Controllers take a trajectory with a fixed time step, velocities and accelerations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.errors import InputError
from cellcolor.files.writing import FileKind
from cellcolor.frontend.setup import Controller

if TYPE_CHECKING:
    from cellcolor.frontend.arm.robot import Robot


class NotForThisArm(Exception):
    """No program for this arm in this language; the text says why."""


@dataclass(frozen=True, eq=False)
class PlannedMotion:
    """A motion, and the arm that makes it.

    Attributes:
        trajectory: joint angles over time.
        robot: the arm with its tool; None if unknown, and then no program for a controller can be
            written.
        flange: (4, 4) pose of the link that the tool is mounted on, in the frame of the last joint.
        base: (4, 4) pose in the world of the frame that the controller counts from.
        step_s: fixed time step of the exported samples, s; None keeps those of the trajectory.
        force_n: the force along the tool's axis that the setup asks for, N.
        controller: what the setup says of the arm's controller; None if it names none.
        led: whether the arm does not rest where strokes begin and end.
        part: (4, 4) pose of the part in the world, the work object of programs.
    """

    trajectory: Trajectory
    robot: Robot | None = None
    flange: Array = field(default_factory=lambda: np.eye(4))
    base: Array = field(default_factory=lambda: np.eye(4))
    step_s: float | None = None
    force_n: float = 0.0
    controller: Controller | None = None
    led: bool = False
    part: Array = field(default_factory=lambda: np.eye(4))


@dataclass(frozen=True, slots=True)
class Export:
    """A file that another program reads.

    Attributes:
        kind: recognizes files written by cellcolor; only these are overwritten.
        content: makes the bytes; raises :class:`NotForThisArm` if there is none for the arm.
    """

    kind: FileKind
    content: Callable[[PlannedMotion], bytes]


@dataclass(frozen=True, eq=False)
class Samples:
    """One planned stretch, from rest to rest.

    Attributes:
        times: (k,) s, from 0 on.
        joints, velocities, accelerations: (k, joints) in rad, rad/s and rad/s², or m.
        contact: (k,) whether the tool is on the surface.
        beside: how far a joint is from the judged motion at most, rad or m.
    """

    times: Array
    joints: Array
    velocities: Array
    accelerations: Array
    contact: Mask
    beside: float = 0.0


def stretches(trajectory: Trajectory, step_s: float | None = None) -> list[Samples]:
    """The planned stretches: one ends where the move to the next sample was not planned.

    The velocity at a sample is that of the parabola through it and its two neighbors;
    accelerations come from velocities in the same way. Both are zero at the ends. With a time step,
    joints follow the cubic Hermite curve through the samples and their velocities. The last moment
    is the first that is not before the last sample.

    Raises:
        InputError: two samples have the same nanosecond, or the later one comes first.
    """
    cuts = [0, *(sample + 1 for sample in trajectory.unplanned), len(trajectory.times)]
    return [_stretch(trajectory, a, b, step_s) for a, b in pairwise(cuts) if b > a]


def _stretch(trajectory: Trajectory, first: int, last: int, step_s: float | None) -> Samples:
    own = slice(first, last)
    times = trajectory.times[own] - trajectory.times[first]
    early = np.flatnonzero(np.diff(np.round(times * 1e9)) <= 0)
    if len(early):
        field = f"times[{first + int(early[0]) + 1}]"
        raise InputError(None, field, "is not later than the one before")
    joints, contact = trajectory.joints[own], trajectory.contact[own]
    velocities = slopes(times, joints)
    if step_s is None or len(times) < 2:
        return Samples(times, joints, velocities, slopes(times, velocities), contact)
    count = int(np.ceil(times[-1] / step_s - 1e-9))
    moments = np.asarray(np.arange(count + 1) * step_s, dtype=np.float64)
    asked = np.minimum(moments, times[-1])
    cubic = CubicHermiteSpline(times, joints, velocities)
    moved, speeds = cubic(asked), cubic(asked, 1)
    straight = np.column_stack([np.interp(asked, times, joint) for joint in joints.T])
    touching = np.interp(asked, times, contact) == 1  # both samples around
    beside = float(np.abs(moved - straight).max(initial=0.0))
    return Samples(moments, moved, speeds, slopes(moments, speeds), touching, beside)


def slopes(times: Array, values: Array) -> Array:
    """The derivatives of values (k, m) by time, zero at both ends."""
    found = np.zeros_like(values)
    if len(times) > 2:
        found[1:-1] = np.gradient(values, times, axis=0)[1:-1]
    return found


def via_points(along: Array, values: Array, kept: Index, within: float = 1.0) -> Index:
    """Few rows such that linear interpolation between them stays this near to all the others.

    Args:
        along: (k,) what values are interpolated over, such as times; does not descend.
        values: (k, m).
        kept: rows that are among them; the first and the last one always are.
    """
    kept = np.unique(np.concatenate([[0], kept, [len(along) - 1]]))
    found = [0]
    for begin, end in pairwise(kept.tolist()):
        while begin < end:
            # Find the farthest row that a straight way reaches, by doubling and halving.
            good, reach = begin + 1, 2
            while begin + reach <= end and _straight(along, values, begin, begin + reach, within):
                good, reach = begin + reach, 2 * reach
            low, high = good, min(begin + reach, end + 1)
            while high - low > 1:
                middle = (low + high) // 2
                if _straight(along, values, begin, middle, within):
                    low = middle
                else:
                    high = middle
            begin = low
            found.append(begin)
    return np.array(found, dtype=np.int64)


def _straight(along: Array, values: Array, begin: int, end: int, within: float) -> bool:
    at, own = along[begin : end + 1], values[begin : end + 1]
    share = ((at - at[0]) / max(at[-1] - at[0], 1e-12))[:, None]
    return bool((np.abs(own[0] + share * (own[-1] - own[0]) - own) <= within).all())
