"""Calibrated arms: solutions of the true arm, by way of the ideal arm that its axes are next to.

A calibration moves and tilts the axes of one arm by what was measured on it. Axes that are meant to
be parallel or to meet then only nearly are. A closed form solves the ideal arm, and its solutions
are starts for Newton's method on the true arm (one step of a homotopy, with several starts). Away
from singularities each start leads to a solution of its own, and none is missed. Next to a fold, a
singularity where two solutions meet or have just vanished, the true solutions may be far from the
ideal ones, as round the circle of solutions of an aligned wrist. So there are more starts:
two beside each ideal solution that is next to a fold, along the motion that leaves the task where
it is; and the ideal arm's solutions of twelve poses around, if they are far from those of the pose.

Newton's method drops what does not lead to the pose. Signs of shoulder, elbow and wrist name the
solutions (:mod:`cellcolor.frontend.arm.signs`); without signs equal ones are merged. If one branch
is asked for, the ideal arm's solution of this branch is tried first, and all the others only where
it does not lead to a solution of that name.

A missing solution shows. Of any pose that is not singular as many solutions have a positive task
determinant as a negative one: their difference is the degree of the map from joint angles, which
close on themselves, to poses, and it is zero since some poses are out of reach (Milnor, Topology
from the Differentiable Viewpoint, 1965, section 5). So a solution that is missing by itself is
noticed; two that vanish together at a singularity are not missing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, unit
from cellcolor.frontend.arm.kinematics import (
    forward,
    nearest_points,
    signed_task_determinant,
    task_jacobian,
)
from cellcolor.frontend.arm.newton import Polished, nearest
from cellcolor.frontend.arm.robot import Robot
from cellcolor.memory import chunks


@dataclass(frozen=True)
class Axes:
    """The lines about which the joints turn, all joints at zero, in the world.

    Attributes:
        directions: (joints, 3) unit vectors.
        points: (joints, 3) one on each, m.
    """

    directions: Array
    points: Array

    def off(self, other: Axes) -> tuple[float, float]:
        """How far the lines are off others: the largest angle in rad, and distance in m.

        The distance is that of this one's points, which are where the arm is.
        """
        sines = np.linalg.norm(np.cross(self.directions, other.directions), axis=1)
        apart = np.cross(self.points - other.points, other.directions)
        return float(sines.max()), float(np.linalg.norm(apart, axis=1).max())


def idealized(axes: Axes, tolerance: float) -> Axes:
    """Axes that are nearly parallel made parallel, and those that nearly meet made to meet.

    Args:
        axes: of six joints.
        tolerance: what counts as nearly, rad and m.

    Returns:
        The ideal axes, each with the point on it where its neighbors are near.
    """
    directions, points = axes.directions.copy(), _near_each_other(axes, tolerance)
    parallel = [
        float(np.linalg.norm(np.cross(directions[k], directions[k + 1]))) <= tolerance
        for k in range(5)
    ]
    for k in range(5):
        if parallel[k]:
            directions[k + 1] = directions[k] * np.sign(directions[k] @ directions[k + 1])
    for k in range(1, 6):
        if parallel[k - 1]:
            continue
        here, there = nearest_points(points[k], directions[k], points[k - 1], directions[k - 1])
        meets = float(np.linalg.norm(here - there)) <= tolerance
        points[k] = there if meets else here
    center = nearest_points(points[5], directions[5], points[4], directions[4])[0]
    to_center = center - points[3] - ((center - points[3]) @ directions[3]) * directions[3]
    if not parallel[3] and np.linalg.norm(to_center) <= tolerance:
        points[3:] = center  # a wrist: all three axes through one point
    return Axes(directions, points)


def _near_each_other(axes: Axes, tolerance: float) -> Array:
    """A point (6, 3) on each axis where the one before it is near.

    Where the frames of a calibrated arm lie along axes that are nearly parallel says nothing: it
    can be hundreds of meters away.
    """
    directions, points = axes.directions, axes.points.copy()
    for k in range(6):
        other = k - 1 if k else 1
        if np.linalg.norm(np.cross(directions[k], directions[other])) <= tolerance:
            points[k] += ((points[other] - points[k]) @ directions[k]) * directions[k]
        else:
            lines = points[k], directions[k], points[other], directions[other]
            points[k] = nearest_points(*lines)[0]
    return points


def missing(robot: Robot, solutions: Array) -> Index:
    """How many solutions of each pose are missing at least, (n,).

    Args:
        solutions: (n, s, joints) all that were found, in rad, NaN for none.
    """
    lost = np.zeros(len(solutions), dtype=np.int64)
    for rows in chunks(len(solutions), solutions.shape[1]):
        part = solutions[rows]
        there = np.nonzero(~np.isnan(part[:, :, 0]))
        poses = forward(robot, part[there])
        determinants = signed_task_determinant(poses)
        lost[rows] = np.abs(np.bincount(there[0], np.sign(determinants), minlength=len(part)))
    return lost


def remark_on_missing(robot: Robot, solutions: Array) -> str:
    """How many solutions (n, s, joints) of all vertices are missing at least, in words."""
    lost = missing(robot, solutions)
    return (
        f"missing, by the signs of the task determinants: {lost.sum()} at "
        f"{np.count_nonzero(lost)} of {len(lost)} vertices"
    )


CALIBRATION = 0.01
"""What a calibrated arm's axes may be off the ideal ones, rad and m; usual is a tenth of it."""

_GOLDEN = (1 + 5**0.5) / 2
_ICOSAHEDRON = [(0.0, first, second * _GOLDEN) for first in (1, -1) for second in (1, -1)]
_AROUND = np.array([np.roll(corner, k) for corner in _ICOSAHEDRON for k in range(3)])
_AROUND /= np.linalg.norm(_AROUND[0])
_FARTHER = 5.0  # times what the axes are off: so far from a pose are those around it
_ANOTHER = 0.1  # rad; an ideal solution of a pose around that is farther away is a start of its own
_FOLDED = 0.05  # smallest singular value; below it two solutions are about to meet
_APART = 0.1  # rad, to both sides of there


@dataclass(frozen=True, kw_only=True)
class NearIdeal(Polished):
    """A calibrated arm: its axes are a little off those of an ideal arm, whose is the closed form.

    Attributes:
        off: the largest angle in rad and distance in m of an axis from the ideal one.
    """

    off: tuple[float, float]
    farthest: float = 0.2

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        """How the arm is solved, and how many of its solutions are missing."""
        angle, distance = math.degrees(self.off[0]), 1000 * self.off[1]
        return (
            f"calibrated arm, axes up to {angle:.2g} degrees and {distance:.2g} mm off the ideal "
            "one: solved by Newton's method from the ideal one's solutions; "
            f"{remark_on_missing(self.robot, self.solve(points, directions))}",
        )

    def starts(self, points: Array, directions: Array) -> Array:
        """The ideal arm's solutions, both sides of folds, and what poses around have besides."""
        own = self.closed_form(points, directions)
        starts, (angle, distance) = [both_sides_of_folds(self.robot, own)], self.off
        for way in _AROUND:
            tilted = unit(directions + _FARTHER * angle * np.roll(way, 1))
            moved = self.closed_form(points + _FARTHER * distance * way, tilted)
            moved[nearest(moved, own) < _ANOTHER] = np.nan
            starts.append(moved)
        return np.concatenate(starts, axis=1)


def both_sides_of_folds(robot: Robot, candidates: Array) -> Array:
    """Candidates (k, s, 6), and two more beside each that is next to a singularity.

    There two solutions meet, and where the ideal arm just does not reach the true one may have
    both. They lie on both sides, in the direction in which the task does not move.

    Returns:
        (k, 3 s, 6) in rad, NaN where there is none.
    """
    there = ~np.isnan(candidates[:, :, 0])
    rows, _ = task_jacobian(forward(robot, candidates[there]))
    _, sizes, turned = np.linalg.svd(rows)
    way = np.where(sizes[:, -1:] < _FOLDED, _APART * turned[:, -1], np.nan)
    way = np.pad(way, ((0, 0), (0, 1)))  # joint 6 stays
    beside = np.full((2, *candidates.shape), np.nan)
    beside[:, there] = candidates[there] + np.stack([way, -way])
    return np.concatenate([candidates, *beside], axis=1)
