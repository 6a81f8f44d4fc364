"""The ideal geometry that a calibrated arm's axes are next to.

A calibration moves and tilts the axes of one arm by what was measured on it. Then axes that are
meant to be parallel are not, nor do those meet that are meant to, and the closed form of the ideal
arm is not that of this one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.arm.signs import nearest_points

__all__ = ["Axes", "idealized"]


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
