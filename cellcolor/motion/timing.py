"""Timing of the arm: as fast as the tool's speed and the joints' limits allow (TOPP-RA).

Pham and Pham, A new approach to time-optimal path parameterization based on reachability
analysis, 2018. Between two samples every joint moves in proportion to time, so derivatives along
the way are differences of samples, and limits hold for what is written down: velocities between
samples, their change from one step to the next over the time from middle to middle, and how far
the velocity of a step is off the mean of its two neighbors'.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d

from cellcolor.arrays import Array
from cellcolor.errors import RefusedResult

_STEP = 0.01  # of the path's parameter, about, per sample; TOPP-RA's tolerances suit such a scale
_LEAST = 0.001  # s, of a step; where neither tool nor joints move
_UNEVEN = 30.0  # times longer and shorter than the median step is a step of the parameter at most
_ROUNDS = 12  # of TOPP-RA; then what is still too fast is stretched
_EXACT = 6  # of these rounds slow down by what the accelerations ask for, later ones by more
_STRETCHES = 30  # of it, with what is around; then the whole motion is
_AROUND = 121  # samples
_MORE = 1.001  # times longer than needed, for rounding
_MARGIN = 0.97  # of the accelerations; differences of samples exceed the derivatives a little


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
        speeds: of the joints.
        points: (k, 3) where the tip is, m; only with a speed of the tool.
        tool_speed: the tool goes no faster, m/s; one number, or one for each step (k - 1,).

    Raises:
        RefusedResult: no times were found, which for a motion from rest to rest is a bug.
    """
    if len(joints) < 2:
        return np.zeros(len(joints))
    moved = np.abs(np.diff(joints, axis=0))
    least = (moved / speeds.velocities).max(axis=1, initial=0.0)
    if points is not None:
        least = np.maximum(least, np.linalg.norm(np.diff(points, axis=0), axis=1) / tool_speed)
    least = np.maximum(least, _LEAST)
    if len(joints) < 3:  # no sample between rest and rest
        return _kept(np.array([0.0, *least * 2]), joints, speeds)
    # The parameter grows as time does at full speed. Were it the sample's number, the arm would
    # seem to jerk wherever samples get closer.
    spans = _STEP * np.clip(least / np.median(least), 1 / _UNEVEN, _UNEVEN)
    fastest = spans / least
    # At a sample the steps on both sides of it have to be possible.
    cap = np.minimum(np.append(fastest, np.inf), np.insert(fastest, 0, np.inf))
    for number in range(_ROUNDS):
        rates = _rates(joints, spans, cap, speeds)
        steps = np.maximum(2 * spans / (rates[1:] + rates[:-1]), least)
        times = np.concatenate([[0.0], np.cumsum(steps)])
        # In sharp bends the differences say more than the derivatives do: slower just there.
        excess = (accelerations(times, joints) / speeds.accelerations).max(axis=1)
        if excess.max() <= 1.0:
            break
        slower = np.maximum(excess / _MARGIN, 1.0) ** (0.5 if number < _EXACT else 1.0)
        around = np.maximum(
            slower, np.maximum(np.append(slower[1:], 1), np.insert(slower[:-1], 0, 1))
        )
        cap = np.where(around > 1.0, np.minimum(cap, rates / around), cap)
    return _kept(times, joints, speeds)


def accelerations(times: Array, joints: Array) -> Array:
    """The least accelerations (k, joints) at the samples of a motion from rest to rest, rad/s^2.

    No smooth motion through the samples has less. Between neighboring steps it is the change of
    velocity. Of three steps with the velocities u, v, w that last r, s, t it is four times what v
    is off (u + w) / 2, by r + s + t: within s of the middle step velocities differ by as at most,
    and their mean is at most as/4 off the middle of the first and the last, which are at most ar/2
    and at/2 off u and w.
    """
    steps = np.diff(times)
    velocity = np.diff(joints, axis=0) / steps[:, None]
    rest = np.zeros((1, joints.shape[1]))
    change = np.diff(np.concatenate([rest, velocity, rest]), axis=0)
    around = np.append(steps, 0.0) + np.insert(steps, 0, 0.0)
    least = np.abs(change) / (around / 2)[:, None]
    # Each step between its neighbors, rest at both ends; it counts at both of its samples.
    padded = np.concatenate([rest, velocity, rest])
    three = np.convolve(np.concatenate([[0.0], steps, [0.0]]), np.ones(3), "valid")
    bent = np.abs(velocity - (padded[2:] + padded[:-2]) / 2) / (three / 4)[:, None]
    least[:-1] = np.maximum(least[:-1], bent)
    least[1:] = np.maximum(least[1:], bent)
    return np.asarray(least)


def _kept(times: Array, joints: Array, speeds: Speeds) -> Array:
    """The times, stretched around where an acceleration is still too large, or else all alike."""
    for _ in range(_STRETCHES):
        excess = (accelerations(times, joints) / speeds.accelerations).max(axis=1)
        if excess.max() <= 1.0:
            return times
        longer = np.where(excess > 1.0, np.sqrt(excess) * _MORE, 1.0)
        # Full around what is too fast, and less and less farther away: that is smooth itself.
        longer = uniform_filter1d(maximum_filter1d(longer, _AROUND), _AROUND)
        steps = np.diff(times) * np.maximum(longer[1:], longer[:-1])
        times = np.concatenate([[0.0], np.cumsum(steps)])
    most = float((accelerations(times, joints) / speeds.accelerations).max())
    return np.asarray(times * max(1.0, np.sqrt(most)))


def _rates(joints: Array, spans: Array, cap: Array, speeds: Speeds) -> Array:
    """How fast the parameter grows at each sample (k,), 1/s; ``spans`` (k - 1,) are its steps."""
    import toppra
    from toppra.constraint import DiscretizationType, JointAccelerationConstraint, LinearConstraint
    from toppra.interpolator import AbstractGeometricPath

    toppra.setup_logging("ERROR")
    grid = np.concatenate([[0.0], np.cumsum(spans)])
    steps = np.diff(joints, axis=0) / spans[:, None]
    before, after = np.insert(steps, 0, steps[0], axis=0), np.append(steps, steps[-1:], axis=0)
    one, other = np.insert(spans, 0, spans[0])[:, None], np.append(spans, spans[-1])[:, None]
    derivatives: dict[int, Array] = {
        0: joints,
        1: (before * other + after * one) / (one + other),
        2: 2 * (after - before) / (one + other),
    }

    class Samples(AbstractGeometricPath):  # type: ignore[misc]
        """The samples as a path that is only ever asked at its samples."""

        dof = joints.shape[1]
        path_interval = np.array([grid[0], grid[-1]])

        def __call__(self, _positions: Array, order: int = 0) -> Array:
            return derivatives[order]

    class Cap(LinearConstraint):  # type: ignore[misc]
        """No faster than the tool's speed and the joints' velocities allow."""

        def compute_constraint_params(self, _path: Any, _grid: Array, *_: Any) -> tuple[Any, ...]:
            bounds = np.column_stack([np.zeros(len(cap)), cap**2])
            return None, None, None, None, None, None, bounds

    limit = _MARGIN * np.column_stack([-speeds.accelerations, speeds.accelerations])
    bend = JointAccelerationConstraint(limit, DiscretizationType.Collocation)
    solver = toppra.algorithm.TOPPRA(
        [Cap(), bend], Samples(), gridpoints=grid, solver_wrapper="seidel"
    )
    _, rates, _ = solver.compute_parameterization(0.0, 0.0)
    if rates is None or np.isnan(rates).any():
        raise RefusedResult("a motion from rest to rest was found to have no times")
    return np.asarray(rates)
