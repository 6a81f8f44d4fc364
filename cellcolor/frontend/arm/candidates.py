"""From candidates of a closed form to solutions of the arm as its URDF has it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.newton import SAME, both_sides_of_folds, merged, nearest, polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import BRANCHES, Signs
from cellcolor.memory import chunks

__all__ = [
    "CALIBRATION",
    "branches_of_calibrated",
    "exact_solutions",
    "put_all",
    "solutions_of_calibrated",
]

CALIBRATION = 0.01
"""What a calibrated arm's axes may be off the ideal ones, rad and m; usual is a tenth of it."""

_EXACT = (
    1e-4  # m and for unit vectors; a candidate of the true geometry that misses by more is none
)
_CALIBRATED = 0.2  # the same of an ideal geometry, at most
_GOLDEN = (1 + 5**0.5) / 2
_ICOSAHEDRON = [(0.0, first, second * _GOLDEN) for first in (1, -1) for second in (1, -1)]
_AROUND = np.array([np.roll(corner, k) for corner in _ICOSAHEDRON for k in range(3)])
_AROUND /= np.linalg.norm(_AROUND[0])
_FARTHER = 5.0  # times what the axes are off: so far from a pose are those around it
_ANOTHER = 0.1  # rad; an ideal solution of a pose around that is farther away is a start of its own
_ELBOW_AND_WRIST = 3  # the bits of both in a branch's index
_MOST_SOLUTIONS = 16  # of six revolute joints


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
    return _solutions(robot, candidates, points, directions, signs)


def solutions_of_calibrated(
    robot: Robot,
    closed_form: Callable[[Array, Array], Array],
    points: Array,
    directions: Array,
    signs: Signs | None,
    off: tuple[float, float],
) -> Array:
    """Solutions of an arm near an ideal one, from the ideal one's; see :func:`exact_solutions`.

    Away from singularities each solution of the ideal arm has one of the true arm beside it, to
    which Newton's method leads. Next to one, where two of the ideal arm's solutions meet or have
    just vanished, it starts on both sides. And there the true arm's solutions may be far from the
    ideal one's, as round the circle of solutions of an aligned wrist: the ideal arm is asked for
    poses around, too, and what is far from its solutions for the pose itself is another start.

    Args:
        closed_form: points (k, 3) in m and unit vectors (k, 3) to the ideal arm's solutions
            (k, s, joints) in rad, NaN where there is none.
        off: the largest angle in rad and distance in m of an axis from the ideal one.
    """
    parts = []
    # Three starts for each of its own solutions, and one more for each of the poses around.
    each = (3 + len(_AROUND)) * (_MOST_SOLUTIONS if signs is None else len(BRANCHES))
    for some in chunks(max(len(points), 1), 48 * robot.joints * each):
        own = closed_form(points[some], directions[some])
        every = [both_sides_of_folds(robot, own)]
        for way in _AROUND:
            tilted = directions[some] + _FARTHER * off[0] * np.roll(way, 1)
            tilted /= np.linalg.norm(tilted, axis=1, keepdims=True)
            moved = closed_form(points[some] + _FARTHER * off[1] * way, tilted)
            moved[nearest(moved, own) < _ANOTHER] = np.nan
            every.append(moved)
        starts = np.concatenate(every, axis=1)
        targets = points[some], directions[some]
        parts.append(_solutions(robot, starts, *targets, signs, calibrated=True))
    most = max(part.shape[1] for part in parts)
    wide = [((0, 0), (0, most - part.shape[1]), (0, 0)) for part in parts]
    return np.concatenate(
        [np.pad(part, by, constant_values=np.nan) for part, by in zip(parts, wide, strict=True)]
    )


def branches_of_calibrated(
    robot: Robot,
    closed_form: Callable[[Array, Array, NDArray[np.intp] | None], Array],
    points: Array,
    directions: Array,
    signs: Signs,
    off: tuple[float, float],
    wanted: NDArray[np.intp],
    of_sign: NDArray[np.intp],
) -> Array:
    """One solution of each pose; the same as among all, and found sooner.

    Most are beside the ideal arm's solution of that branch. Only where that is not so all others
    are tried.

    Args:
        closed_form: as for :func:`solutions_of_calibrated`; given branches (k,) it may leave out
            the other ones.
        wanted: (n,) the branch of each pose.
        of_sign: (8,) the index that the signs have for each branch.

    Returns:
        (n, joints) in rad, NaN where there is none.
    """
    start = closed_form(points, directions, wanted)
    found = _solutions(robot, start, points, directions, signs, calibrated=True)
    chosen = found[np.arange(len(points)), of_sign[wanted]]
    left = np.flatnonzero(np.isnan(chosen[:, 0]))
    if len(left):
        rest = points[left], directions[left], signs, off
        all_of = solutions_of_calibrated(robot, lambda p, d: closed_form(p, d, None), *rest)
        chosen[left] = all_of[np.arange(len(left)), of_sign[wanted[left]]]
    return chosen


def _solutions(
    robot: Robot,
    candidates: Array,
    points: Array,
    directions: Array,
    signs: Signs | None,
    calibrated: bool = False,
) -> Array:
    count, most, joints = candidates.shape
    row = np.repeat(np.arange(count), most)
    flat, farthest = candidates.reshape(-1, joints), _CALIBRATED if calibrated else _EXACT
    flat = polished(robot, flat, points[row], directions[row], farthest)
    flat = np.pi - np.mod(np.pi - flat, 2 * np.pi)  # (-pi, pi]
    flat[:, -1] = candidates.reshape(-1, joints)[:, -1]  # locked, wherever that is
    flat[np.isnan(flat[:, 0])] = np.nan
    if signs is None:
        return merged(flat.reshape(candidates.shape))
    solved = np.flatnonzero(~np.isnan(flat[:, 0]))
    of_branch, determinants = signs.branches(robot, flat[solved])
    named = np.full((count * len(BRANCHES), joints), np.nan)
    slots = row[solved] * len(BRANCHES) + of_branch
    if calibrated:
        put_all(named, flat[solved], slots, determinants)
    else:
        # The first of equal ones: of a pair that meets the signs are chance.
        named[slots[::-1]] = flat[solved][::-1]
    return named.reshape(count, len(BRANCHES), joints)


def put_all(named: Array, solutions: Array, slots: Index, determinants: Array) -> None:
    """Put solutions of a calibrated arm under their names, as many as there is room for.

    Round an aligned wrist a pose can have two with the same signs, and more than eight in all. The
    one with the larger determinant has the name. The other one takes that of the same shoulder and
    the same sign of the determinant if it is free.

    Args:
        named: (n * 8, joints) to be written to, NaN for none.
        solutions: (k, joints) in rad, many of them equal.
        slots: (k,) where the name of each would put it.
        determinants: (k,) absolute.
    """
    left = np.argsort(-determinants, kind="stable")
    for flipped in (0, _ELBOW_AND_WRIST):
        slot, first = np.unique(slots[left] ^ flipped, return_index=True)
        free = np.isnan(named[slot, 0])
        named[slot[free]] = solutions[left[first[free]]]
        there = named[slots[left], None]
        left = left[nearest(solutions[left, None], there)[:, 0] > SAME]
