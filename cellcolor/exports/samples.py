"""The trajectory as controllers take it: with a fixed time step, velocities and accelerations."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.errors import InputError


@dataclass(frozen=True, eq=False)
class Samples:
    """One planned stretch, from rest to rest.

    Attributes:
        first: its first sample in the trajectory.
        times: (k,) s, from 0 on.
        joints, velocities, accelerations: (k, joints) in rad, rad/s and rad/s², or m.
        points, normals: (k, 3) the tip in the world, m, and the outward normal.
        contact: (k,) whether the tool is on the surface.
        segment: (k,) the segment, -1 between them.
        beside: how far a joint is from the judged motion at most, rad or m.
    """

    first: int
    times: Array
    joints: Array
    velocities: Array
    accelerations: Array
    points: Array
    normals: Array
    contact: Mask
    segment: Index
    beside: float = 0.0


def stretches(trajectory: Trajectory, step_s: float | None = None) -> list[Samples]:
    """The planned stretches: one ends where the move to the next sample was not planned.

    The velocity at a sample is that of the parabola through it and its two neighbors;
    accelerations come from velocities in the same way. Both are zero at the ends. With a time step,
    joints follow the cubic Hermite curve through the samples and their velocities, and all else is
    interpolated linearly. The last moment is the first that is not before the last sample.

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
    if step_s is None:
        return Samples(
            first, times, joints, velocities, slopes(times, velocities), trajectory.points[own],
            trajectory.normals[own], contact, trajectory.segment[own],
        )  # fmt: skip
    count = int(np.ceil(times[-1] / step_s - 1e-9))
    moments = np.asarray(np.arange(count + 1) * step_s, dtype=np.float64)
    asked = np.minimum(moments, times[-1])
    before = np.clip(np.searchsorted(times, asked, side="right") - 1, 0, max(len(times) - 2, 0))
    after = np.minimum(before + 1, len(times) - 1)
    width = np.where(after > before, times[after] - times[before], 1.0)
    share = ((asked - times[before]) / width)[:, None]
    straight = joints[before] + share * (joints[after] - joints[before])
    slope = (joints[after] - joints[before]) / width[:, None]
    starts, ends = velocities[before] - slope, velocities[after] - slope
    away = share * (1 - share) * ((1 - share) * starts - share * ends) * width[:, None]
    moved = straight + away
    speeds = slope + (1 - share) * (1 - 3 * share) * starts + share * (3 * share - 2) * ends
    nearest = np.where(share[:, 0] < 1, before, after)
    normals = trajectory.normals[own]
    turned = normals[before] + share * (normals[after] - normals[before])
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    points = trajectory.points[own]
    return Samples(
        first,
        moments,
        moved,
        speeds,
        slopes(moments, speeds),
        points[before] + share * (points[after] - points[before]),
        np.where(lengths > 1e-9, turned / np.maximum(lengths, 1e-9), normals[before]),
        contact[before] & contact[after] | (contact[nearest] & (share[:, 0] % 1 == 0)),
        trajectory.segment[own][nearest],
        float(np.abs(away).max(initial=0.0)),
    )


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
