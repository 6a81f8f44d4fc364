"""Calibrated arms: the ideal geometry that their axes are next to, and what is said of them.

A calibration moves and tilts the axes of one arm by what was measured on it. Then axes that are
meant to be parallel or to meet do not, and the closed form of the ideal arm is not that of this
one.

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

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.kinematics import (
    bytes_of_poses,
    forward,
    signed_task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import nearest_points
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
    for rows in chunks(len(solutions), solutions.shape[1] * bytes_of_poses(robot.joints)):
        part = solutions[rows]
        there = np.nonzero(~np.isnan(part[:, :, 0]))
        poses = forward(robot, part[there])
        determinants = signed_task_determinant(*tip_jacobian(poses), poses.tool_axis)
        lost[rows] = np.abs(np.bincount(there[0], np.sign(determinants), minlength=len(part)))
    return lost


def remark_on_calibration(robot: Robot, off: tuple[float, float], solutions: Array) -> str:
    """A sentence for the report.

    Args:
        off: the largest angle in rad and the largest distance in m of an axis from the ideal one.
        solutions: (n, s, joints) of all vertices, NaN for none.
    """
    lost = missing(robot, solutions)
    angle, distance = math.degrees(off[0]), 1000 * off[1]
    return (
        f"calibrated arm, axes up to {angle:.2g} degrees and {distance:.2g} mm off the ideal one: "
        "solved by Newton's method from the ideal one's solutions; missing, by the signs of the "
        f"task determinants: {lost.sum()} at {np.count_nonzero(lost)} of {len(lost)} vertices"
    )
