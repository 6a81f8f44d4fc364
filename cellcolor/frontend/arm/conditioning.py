"""What counts as well conditioned for one arm (``docs/frontend.md``, "Conditioning").

Manipulability and task determinant are volumes: the three rows of the Jacobian for the tip's
position are in meters, and those for a direction have no unit. So a share of the cube of the arm's
reach means the same for a small arm and a large one, and a number in cubic meters does not.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import Setup

__all__ = ["Conditioning", "conditioning", "task_determinants"]

_POSITION = 3  # rows of the task's Jacobian that are lengths


@dataclass(frozen=True)
class Conditioning:
    """Thresholds in m^3.

    Attributes:
        min_manipulability, min_task_determinant: what is below is not valid.
        near_singular_determinant: from here on down motions are looked into.
    """

    min_manipulability: float
    min_task_determinant: float
    near_singular_determinant: float


def conditioning(setup: Setup, reach: float) -> Conditioning:
    """The thresholds of a setup for an arm of a reach in m, whichever way the setup has them."""
    unit = reach**_POSITION

    def volume(absolute: float | None, share: float | None) -> float:
        if absolute is not None:
            return absolute
        assert share is not None  # one of both: the setup has been checked
        return share * unit

    limits, policy = setup.thresholds, setup.continuity
    return Conditioning(
        volume(limits.min_manipulability_m3, limits.min_manipulability),
        volume(limits.min_task_determinant_m3, limits.min_task_determinant),
        volume(policy.near_singular_determinant_m3, policy.near_singular_determinant),
    )


def task_determinants(robot: Robot, configurations: Array, limits: Conditioning | None) -> Array:
    """Task determinants (k,) in m^3 of configurations (k, joints) in rad.

    NaN where there is no configuration, or one that fails one of the limits, if there are any.
    """
    found = np.flatnonzero(~np.isnan(configurations[:, 0]))
    poses = forward(robot, configurations[found])
    linear, angular = tip_jacobian(poses)
    determinant = task_determinant(linear, angular, poses.tool_axis)
    if limits is not None:
        good = (manipulability(linear) >= limits.min_manipulability) & (
            determinant >= limits.min_task_determinant
        )
        determinant[~good] = np.nan
    determinants = np.full(len(configurations), np.nan)
    determinants[found] = determinant
    return determinants
