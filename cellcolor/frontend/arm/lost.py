"""What is said of a calibrated arm: how far it is off the ideal one, and what is missing.

Of any pose that is not singular as many solutions have a positive task determinant as a negative
one: their difference is the degree of the map from joint angles, which close on themselves, to
poses, and it is zero since some poses are out of reach (Milnor, Topology from the Differentiable
Viewpoint, 1965, section 5). So a solution that is missing by itself shows; two that vanish together
at a singularity are not missing.
"""

from __future__ import annotations

import math

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.kinematics import (
    bytes_of_poses,
    forward,
    signed_task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.memory import chunks

__all__ = ["missing", "remark_on_calibration"]


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
