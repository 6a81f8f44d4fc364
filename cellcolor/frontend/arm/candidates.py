"""From candidates of a closed form to solutions of the arm as its URDF has it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.newton import both_sides_of_folds, merged, polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import BRANCHES, Signs

__all__ = ["CALIBRATION", "branches_of_calibrated", "exact_solutions", "solutions_of_calibrated"]

CALIBRATION = 0.01
"""What a calibrated arm's axes may be off the ideal ones, rad and m; usual is a tenth of it."""

_EXACT = (
    1e-4  # m and for unit vectors; a candidate of the true geometry that misses by more is none
)
_CALIBRATED = 0.2  # the same of an ideal geometry, at most


def exact_solutions(
    robot: Robot, candidates: Array, points: Array, directions: Array, signs: Signs | None
) -> Array:
    """Solutions of an arm whose closed form is its own.

    Args:
        candidates: (n, s, joints) in rad, NaN where there is none.
        points: (n, 3) where the tip has to be, m.
        directions: (n, 3) unit vectors of the tool.
        signs: what names them.

    Returns:
        (n, 8, joints) by branch, or (n, s, joints) without signs, each solution once.
    """
    return _solutions(robot, candidates, points, directions, signs, _EXACT)


def solutions_of_calibrated(
    robot: Robot, candidates: Array, points: Array, directions: Array, signs: Signs | None
) -> Array:
    """Solutions of an arm near an ideal one, from the ideal one's; see :func:`exact_solutions`.

    Away from singularities each solution of the ideal arm has one of the true arm beside it, to
    which Newton's method leads. Next to one, where two of the ideal arm's solutions meet or have
    just vanished, it starts on both sides.
    """
    candidates = both_sides_of_folds(robot, candidates)
    return _solutions(robot, candidates, points, directions, signs, _CALIBRATED)


def branches_of_calibrated(
    robot: Robot,
    candidates: Callable[[Index, NDArray[np.intp] | None], Array],
    points: Array,
    directions: Array,
    signs: Signs,
    wanted: NDArray[np.intp],
    of_sign: NDArray[np.intp],
) -> Array:
    """One solution of each pose; the same as among all, and found sooner.

    Most are beside the ideal arm's solution of that branch. Only where that is not so all others
    are tried.

    Args:
        candidates: rows (k,) and their branches (k,), or None for all, to those of the ideal arm.
        wanted: (n,) the branch of each pose.
        of_sign: (8,) the index that the signs have for each branch.

    Returns:
        (n, joints) in rad, NaN where there is none.
    """
    rows = np.arange(len(points))
    start = candidates(rows, wanted)
    found = _solutions(robot, start, points, directions, signs, _CALIBRATED)
    chosen = found[rows, of_sign[wanted]]
    left = np.flatnonzero(np.isnan(chosen[:, 0]))
    if len(left):
        every = candidates(left, None)
        all_of = solutions_of_calibrated(robot, every, points[left], directions[left], signs)
        chosen[left] = all_of[np.arange(len(left)), of_sign[wanted[left]]]
    return chosen


def _solutions(
    robot: Robot,
    candidates: Array,
    points: Array,
    directions: Array,
    signs: Signs | None,
    farthest: float,
) -> Array:
    count, most, joints = candidates.shape
    row = np.repeat(np.arange(count), most)
    flat = polished(robot, candidates.reshape(-1, joints), points[row], directions[row], farthest)
    flat = np.pi - np.mod(np.pi - flat, 2 * np.pi)  # (-pi, pi]
    flat[:, -1] = candidates.reshape(-1, joints)[:, -1]  # locked, wherever that is
    flat[np.isnan(flat[:, 0])] = np.nan
    if signs is None:
        return merged(flat.reshape(candidates.shape))
    solved = np.flatnonzero(~np.isnan(flat[:, 0]))
    named = np.full((count, len(BRANCHES), joints), np.nan)
    of_branch = signs.branches(robot, flat[solved])
    # The first of equal ones: of a pair that meets the signs are chance.
    named[row[solved][::-1], of_branch[::-1]] = flat[solved][::-1]
    return named
