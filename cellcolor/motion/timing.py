"""Timing of the arm: as fast as the tool's speed and the joints' limits allow.

Between two samples every joint moves in proportion to time, so limits hold for what is written
down: the velocity of each step, how much it differs from that of the next over the time from middle
to middle, and how far it is off the mean of its two neighbors'. Jerks are not limited.

Velocities and their changes are planned in two sweeps, backward and forward, each of which makes
every step as fast as its neighbor allows: the fastest way where all limits have that form
(Consolini, Locatelli, Minari, Nagy and Vajk, Optimal time-complexity speed planning for robot
manipulators, 2019). The library toppra takes three to nine times as long for the same. Its path is
a spline through the samples, so between samples it accelerates by up to twice what is allowed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array

_LEAST = 0.001  # s, of a step; where neither tool nor joints move
_BOW = 0.02  # rad or m; so far at most a motion speeds up beside a straight line
_MARGIN = 0.995  # of the accelerations; the sweeps take neighboring steps for about equally long
_EVEN = 0.9  # of its feed a stroke keeps everywhere if that is to be even
_HALVINGS = 8  # of the range in which an even feed is looked for
_ROUNDS = 60  # of sweeps; 5 to 15 are enough on sharp edges


@dataclass(frozen=True)
class Speeds:
    """What limits the arm's speed.

    Attributes:
        velocities: (joints,) rad/s or m/s.
        accelerations: (joints,) rad/s^2 or m/s^2.
    """

    velocities: Array
    accelerations: Array


def timed(
    joints: Array, speeds: Speeds, points: Array | None = None, tool_speed: float | Array = np.inf
) -> Array:
    """Times (k,) of the samples of a motion from rest to rest, from 0 on, s.

    Args:
        joints: (k, joints) rad or m, unwound, neighbors near each other.
        points: (k, 3) where the tip is, m; only with a speed of the tool.
        tool_speed: the tool goes no faster, m/s; one number, or one for each step (k - 1,).
    """
    if len(joints) < 2:
        return np.zeros(len(joints))
    moved = np.abs(np.diff(joints, axis=0))
    least = (moved / speeds.velocities).max(axis=1, initial=0.0)
    if points is not None:
        least = np.maximum(least, np.linalg.norm(np.diff(points, axis=0), axis=1) / tool_speed)
    if len(joints) == 2:  # nothing says how a way without samples speeds up but that it is straight
        least = np.maximum(least, (moved / np.sqrt(2 * _BOW * speeds.accelerations)).max(axis=1))
    least = np.maximum(least, _LEAST)
    cap = np.ones(len(least))
    for _ in range(_ROUNDS):
        squares = _swept(joints, least, cap, _MARGIN * speeds.accelerations)
        times = np.concatenate([[0.0], np.cumsum(least / np.sqrt(squares))])
        excess = (accelerations(times, joints, speeds) / speeds.accelerations).max(axis=1)
        if excess.max() <= 1.0:
            return times
        slower = np.maximum(excess / _MARGIN, 1.0)
        slower = np.maximum(slower[1:], slower[:-1])
        cap = np.where(slower > 1.0, np.minimum(cap, squares / slower), cap)
    return np.asarray(times * np.sqrt(excess.max()))


def evenly_timed(
    joints: Array, speeds: Speeds, points: Array, tool_speed: float, window: float
) -> Array:
    """As :func:`timed`, at the fastest feed that the whole stroke keeps up to a tenth.

    It keeps it over each stretch as long as the window, m, but for the first and the last one, in
    which the tool comes from rest and goes to rest.
    """
    steps = np.maximum(np.linalg.norm(np.diff(points, axis=0), axis=1), 1e-9)
    way = np.concatenate([[0.0], np.cumsum(steps)])
    begins = way[(way >= window) & (way <= way[-1] - 2 * window)]

    def at(feed: float) -> tuple[Array, bool]:
        times = timed(joints, speeds, points, feed)
        taken = np.interp(begins + window, way, times) - np.interp(begins, way, times)
        return times, bool(taken.max(initial=0.0) <= window / (_EVEN * feed))

    times, kept = at(tool_speed)
    slow, fast, best = 0.0, tool_speed, times if kept else None
    for _ in range(0 if kept else _HALVINGS):
        middle = (slow + fast) / 2
        times, kept = at(middle)
        slow, fast, best = (middle, fast, times) if kept else (slow, middle, best)
    return times if best is None else best


def accelerations(times: Array, joints: Array, speeds: Speeds) -> Array:
    """The least accelerations (k, joints) at the samples of a motion from rest to rest, rad/s^2.

    No smooth motion through the samples has less. Between neighboring steps it is the change of
    velocity. Of three steps with the velocities u, v, w that last r, s, t it is four times what v
    is off (u + w) / 2, by r + s + t: within s of the middle step velocities differ by as at most,
    and their mean is at most as/4 off the middle of the first and the last, which are at most ar/2
    and at/2 off u and w.

    Beside a step that takes long, a motion may leave the straight line by ``_BOW`` only, so a long
    step has no more time for a change than the longest one that it can be left on.
    """
    passed = np.diff(times)[:, None]
    longest = np.sqrt(8 * _BOW / speeds.accelerations)
    rest = np.zeros((1, joints.shape[1]))
    velocity = np.concatenate([rest, np.diff(joints, axis=0) / passed, rest])
    beside, along = (
        np.concatenate([rest, np.minimum(passed, most), rest]) for most in (longest, 2 * longest)
    )
    least = np.abs(np.diff(velocity, axis=0)) / ((beside[1:] + beside[:-1]) / 2)
    # Each step between its neighbors, rest at both ends; it counts at both of its samples.
    three = (beside[2:] + along[1:-1] + beside[:-2]) / 4
    bent = np.abs(velocity[1:-1] - (velocity[2:] + velocity[:-2]) / 2) / three
    least[:-1] = np.maximum(least[:-1], bent)
    least[1:] = np.maximum(least[1:], bent)
    return np.asarray(least)


def _swept(joints: Array, least: Array, cap: Array, accelerations: Array) -> Array:
    """The squares (k - 1,) of how fast each step is, as a share of its full speed.

    Let a step at full speed have the velocity B and the next one A, and let u and v be the squares
    of their shares. The acceleration between them is about ((3A - B) v + (A - 3B) u) / 4 by the
    time from middle to middle at full speed, and exactly that if u = v. Where both terms have the
    same sign, it is enough that neither step is faster than it could be if both were the same.
    Else a faster step allows a faster neighbor, so one sweep each way ends with the fastest steps.

    Args:
        joints: (k, joints) rad or m.
        least: (k - 1,) how long each step takes at full speed, s.
        cap: (k - 1,) squares at most.
        accelerations: (joints,) at most.
    """
    velocity = np.diff(joints, axis=0) / least[:, None]
    before, after = velocity[:-1], velocity[1:]
    middles = ((least[:-1] + least[1:]) / 2)[:, None]
    squares = cap.copy()
    with np.errstate(divide="ignore", invalid="ignore"):
        same = (accelerations * middles / np.abs(after - before)).min(axis=1)
        squares[1:] = np.minimum(squares[1:], same)
        squares[:-1] = np.minimum(squares[:-1], same)
        for end in (0, -1):  # rest on the other side, which takes no time
            fastest = accelerations * least[end] / 2 / np.abs(velocity[end])
            squares[end] = min(squares[end], fastest.min())
        ahead, behind = 3 * after - before, after - 3 * before
        opposed = ahead * behind < 0
        ahead, behind = np.abs(ahead), np.abs(behind)
        room = 4 * accelerations * middles
        alone_before = np.where(opposed, room / behind, np.inf)
        alone_after = np.where(opposed, room / ahead, np.inf)
        slope_before = np.where(opposed, ahead / behind, 0.0)
        slope_after = np.where(opposed, behind / ahead, 0.0)
    for k in np.flatnonzero(alone_before.min(axis=1) < squares[:-1])[::-1].tolist():
        most = (alone_before[k] + slope_before[k] * squares[k + 1]).min()
        squares[k] = min(squares[k], most)
    for k in np.flatnonzero(alone_after.min(axis=1) < squares[1:]).tolist():
        most = (alone_after[k] + slope_after[k] * squares[k]).min()
        squares[k + 1] = min(squares[k + 1], most)
    return squares
