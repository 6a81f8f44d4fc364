"""From candidates of a closed form to solutions of the arm as its URDF has it.

Idea. A closed form solves an arm whose axes are exactly parallel or meet. The axes of a calibrated
arm are a little off. So the closed form solves an ideal arm beside it, and the ideal arm's
solutions are starts for Newton's method on the true arm. Away from singularities each leads to a
solution of its own, and none is missed. Next to a singularity two solutions meet or have just
vanished, and the true arm's may be far from the ideal one's, as round the circle of solutions of an
aligned wrist. There more starts are needed.

Standard terms. Newton's method from known solutions of a nearby problem is one step of numerical
continuation (a homotopy from the ideal arm to the true one), with several starts (multi-start). A
singularity where two solutions meet is a fold.

Steps of the algorithm, for each pose:

1. Ask the closed form for candidates; of a calibrated arm these are starts.
2. Of a calibrated arm, start on both sides of a fold as well, along the motion that leaves the task
   where it is; and from the ideal arm's solutions of twelve poses around this one, if they are far
   from its solutions of the pose itself.
3. Newton's method drops what does not lead to the pose, and polishes the rest.
4. Signs of shoulder, elbow and wrist name the solutions (:mod:`cellcolor.frontend.arm.signs`).
   Without signs equal ones are merged.

If one branch of each pose is asked for, the ideal arm's solution of this branch is the only start,
and all others are tried only where it does not lead to a solution of that name.

Example. A pose has 8 solutions on an ideal UR5e. There is room for 8 * (1 + 2 + 12) = 120 starts,
but 8 are left if the pose is far from a singularity: no fold is near, and the poses around have
their solutions beside these 8. A few steps of Newton's method lead to 8 solutions with 8 names.

Complexity. At most 120 runs of Newton's method a pose (240 without names), of 25 steps at most;
poses are solved in batches that fit into memory.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.newton import SAME, both_sides_of_folds, merged, nearest, polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import BRANCHES, Signs
from cellcolor.memory import chunks

CALIBRATION = 0.01
"""What a calibrated arm's axes may be off the ideal ones, rad and m; usual is a tenth of it."""

# By how much a candidate may miss the pose and still be a start, m and for unit vectors.
_EXACT = 1e-4  # of an arm whose closed form is its own
_CALIBRATED = 0.2  # of an ideal arm's closed form

_GOLDEN = (1 + 5**0.5) / 2
_ICOSAHEDRON = [(0.0, first, second * _GOLDEN) for first in (1, -1) for second in (1, -1)]
_AROUND = np.array([np.roll(corner, k) for corner in _ICOSAHEDRON for k in range(3)])
_AROUND /= np.linalg.norm(_AROUND[0])
_FARTHER = 5.0  # times what the axes are off: so far from a pose are those around it
_ANOTHER = 0.1  # rad; an ideal solution of a pose around that is farther away is a start of its own
_ELBOW_AND_WRIST = 3  # the bits of both in a branch's index
_MOST_SOLUTIONS = 16  # of six revolute joints


class ClosedForm(Protocol):
    """Inverse kinematics of an arm with exactly parallel or meeting axes."""

    def __call__(
        self, points: Array, directions: Array, /, *, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """Points (k, 3) in m and unit vectors (k, 3) to solutions (k, s, joints) in rad.

        They are NaN where there is none. Given branches (k,) it may leave out all others.
        """


@dataclass(frozen=True)
class NearIdeal:
    """A calibrated arm: its axes are a little off those of an ideal arm.

    Attributes:
        robot: the true arm.
        closed_form: that of the ideal arm.
        off: the largest angle in rad and distance in m of an axis from the ideal one.
        signs: what names solutions; None if they have no names.
        sign_of: (8,) the index that the signs have for each branch.
    """

    robot: Robot
    closed_form: ClosedForm
    off: tuple[float, float]
    signs: Signs | None
    sign_of: NDArray[np.intp] = field(default_factory=lambda: np.arange(len(BRANCHES)))

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """See :meth:`cellcolor.frontend.arm.inverse.InverseKinematics.solve`."""
        if branches is None:
            found = self._all(points, directions)
            return found if self.signs is None else found[:, self.sign_of]
        return self._one_each(points, directions, self.sign_of[branches], branches)[:, None]

    def _one_each(
        self, points: Array, directions: Array, signs: NDArray[np.intp], branches: NDArray[np.intp]
    ) -> Array:
        """The solution (n, joints) of one branch of each pose, the same as among all."""
        starts = self.closed_form(points, directions, branches=branches)
        chosen = self._from(starts, points, directions)[np.arange(len(points)), signs]
        left = np.flatnonzero(np.isnan(chosen[:, 0]))
        if len(left):
            every = self._all(points[left], directions[left])
            chosen[left] = every[np.arange(len(left)), signs[left]]
        return chosen

    def _all(self, points: Array, directions: Array) -> Array:
        """All solutions, (n, 8, joints) by signs or (n, s, joints) without, in batches."""
        most = _MOST_SOLUTIONS if self.signs is None else len(BRANCHES)
        bytes_each = 48 * self.robot.joints * most * (3 + len(_AROUND))
        batches, parts = list(chunks(max(len(points), 1), bytes_each)), []
        for batch in batches:
            starts = self._starts(points[batch], directions[batch])
            parts.append(self._from(starts, points[batch], directions[batch]))
        widest = max(part.shape[1] for part in parts)
        found = np.full((len(points), widest, self.robot.joints), np.nan)
        for batch, part in zip(batches, parts, strict=True):
            found[batch, : part.shape[1]] = part
        return found

    def _starts(self, points: Array, directions: Array) -> Array:
        """The ideal arm's solutions, both sides of folds, and what poses around have besides."""
        own = self.closed_form(points, directions)
        starts = [both_sides_of_folds(self.robot, own)]
        angle, distance = self.off
        for way in _AROUND:
            tilted = directions + _FARTHER * angle * np.roll(way, 1)
            tilted /= np.linalg.norm(tilted, axis=1, keepdims=True)
            moved = self.closed_form(points + _FARTHER * distance * way, tilted)
            moved[nearest(moved, own) < _ANOTHER] = np.nan
            starts.append(moved)
        return np.concatenate(starts, axis=1)

    def _from(self, starts: Array, points: Array, directions: Array) -> Array:
        """Solutions from starts (n, s, joints), under their names if there are any."""
        solutions = _polished(self.robot, starts, points, directions, _CALIBRATED)
        if self.signs is None:
            return merged(solutions)
        named, solved, slots, determinants = _slots(self.robot, solutions, self.signs)
        put_all(named, solved, slots, determinants)
        return named.reshape(len(points), len(BRANCHES), self.robot.joints)


def exact_solutions(
    robot: Robot, candidates: Array, points: Array, directions: Array, signs: Signs | None
) -> Array:
    """Solutions of an arm whose closed form is its own.

    Args:
        robot: the arm.
        candidates: (n, s, joints) in rad, NaN where there is none.
        points: (n, 3) where the tip has to be, m.
        directions: (n, 3) unit vectors of the tool.
        signs: what names them.

    Returns:
        (n, 8, joints) by branch, or (n, s, joints) without signs, each solution once.
    """
    solutions = _polished(robot, candidates, points, directions, _EXACT)
    if signs is None:
        return merged(solutions)
    named, solved, slots, _ = _slots(robot, solutions, signs)
    # The first of those with one name: of a pair that meets the signs are chance.
    named[slots[::-1]] = solved[::-1]
    return named.reshape(len(points), len(BRANCHES), robot.joints)


def _polished(
    robot: Robot, starts: Array, points: Array, directions: Array, farthest: float
) -> Array:
    """The solutions in (-pi, pi] that starts (n, s, joints) lead to, NaN where they do not.

    The last joint is locked, and keeps its angle wherever that is.
    """
    count, most, joints = starts.shape
    pose, flat = np.repeat(np.arange(count), most), starts.reshape(-1, joints)
    found = polished(robot, flat, points[pose], directions[pose], farthest)
    found = np.pi - np.mod(np.pi - found, 2 * np.pi)
    found[:, -1] = np.where(np.isnan(found[:, 0]), np.nan, flat[:, -1])
    return found.reshape(starts.shape)


def _slots(robot: Robot, solutions: Array, signs: Signs) -> tuple[Array, Array, Index, Array]:
    """Room for the solutions (n, s, joints) by name, and where each of them belongs.

    Returns:
        An empty table (n * 8, joints), and of each solution that there is, pose by pose, the angles
        (k, joints), the row of the table that its signs lead to, and its determinant.
    """
    pose, number = np.nonzero(~np.isnan(solutions[:, :, 0]))
    solved = solutions[pose, number]
    sign, determinants = signs.branches(robot, solved)
    empty = np.full((len(solutions) * len(BRANCHES), solutions.shape[2]), np.nan)
    return empty, solved, pose * len(BRANCHES) + sign, determinants


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
