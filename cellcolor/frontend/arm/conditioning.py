"""What counts as well conditioned for one arm (``docs/frontend.md``, "Conditioning").

Manipulability and task determinant are volumes: the three rows of the Jacobian for the tip's
position are in meters, and those for a direction have no unit. So a share of the cube of the arm's
reach means the same for a small arm and a large one, and a number in cubic meters does not. In a
plane, or with a prismatic joint in space, they are areas, and a share is one of the square of the
reach.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import Continuity, Setup, Thresholds


@dataclass(frozen=True)
class Conditioning:
    """Thresholds in m^3, or with fewer meters (:func:`conditioning`).

    Attributes:
        min_manipulability, min_task_determinant: what is below is not valid.
        near_singular_determinant: from here on down motions are looked into.
    """

    min_manipulability: float
    min_task_determinant: float
    near_singular_determinant: float


def conditioning(setup: Setup, reach: float, robot: Robot) -> Conditioning:
    """The thresholds of a setup for an arm of a reach in m, whichever way the setup has them.

    The measures are products of so many lengths as the task has rows that are lengths, less one
    for each prismatic joint, whose column of the Jacobian has none.

    Raises:
        InputError: one is in cubic meters and the measures are not; names the key.
    """
    limits, policy = setup.thresholds, setup.continuity
    lengths = robot.task.lengths - int(robot.slides.sum())
    return Conditioning(
        _measure("thresholds", limits, "min_manipulability", reach, lengths),
        _measure("thresholds", limits, "min_task_determinant", reach, lengths),
        _measure("continuity", policy, "near_singular_determinant", reach, lengths),
    )


def _measure(
    table: str, given: Thresholds | Continuity, name: str, reach: float, lengths: int
) -> float:
    absolute, share = getattr(given, f"{name}_m3"), getattr(given, name)
    if absolute is None:
        return float(share * reach**lengths)  # one of both: the setup has been checked
    if lengths != 3:
        message = (
            f"of this arm it is no volume, but m^{lengths}: give a share of that power of the "
            f"reach, {name}"
        )
        raise InputError(None, f"{table}.{name}_m3", message)
    return float(absolute)


def task_determinants(robot: Robot, configurations: Array, limits: Conditioning | None) -> Array:
    """Task determinants (k,) in m^3 of configurations (k, joints) in rad.

    NaN where there is no configuration, or one that fails one of the limits, if there are any.
    """
    found = np.flatnonzero(~np.isnan(configurations[:, 0]))
    poses = forward(robot, configurations[found])
    linear, angular = tip_jacobian(poses)
    determinant = task_determinant(linear, angular, poses.tool_axis, robot.task)
    if limits is not None:
        good = (manipulability(linear, robot.task) >= limits.min_manipulability) & (
            determinant >= limits.min_task_determinant
        )
        determinant[~good] = np.nan
    determinants = np.full(len(configurations), np.nan)
    determinants[found] = determinant
    return determinants
