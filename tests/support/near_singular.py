"""Configurations of six-axis arms next to a singular wrist, elbow or shoulder."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from cellcolor.arrays import Array
from cellcolor.frontend.arm.candidates import CALIBRATION
from cellcolor.frontend.arm.kinematics import forward, signed_task_determinant, tip_jacobian
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import signs_of

KINDS = {"wrist": (4, 2), "elbow": (2, 1), "shoulder": (1, 0)}  # joint that leads there, factor
BESIDE = (
    0.05  # rad from where a factor vanishes; the determinant of a calibrated arm does so between
)


def near_singular(robot: Robot, reach: float, kind: str, off: float, count: int) -> Array:
    """Configurations (count, 6) that are ``off`` rad in one joint from a singularity.

    Of a calibrated arm the factors vanish beside its singularities only, where the task determinant
    changes its sign.

    Args:
        robot: an arm whose branches signs tell apart.
        reach: of the arm, m.
        kind: one of ``KINDS``.
    """
    exact = signs_of(robot, reach, 1e-6)
    signs = exact or signs_of(robot, reach, 2 * CALIBRATION)
    assert signs is not None
    joint, number = KINDS[kind]

    def determinant(angle: float, row: Array) -> float:
        turned = np.array(row)
        turned[joint] = angle
        poses = forward(robot, turned[None])
        return float(signed_task_determinant(*tip_jacobian(poses), poses.tool_axis)[0])

    def factor(angle: float, row: Array) -> float:
        turned = np.array(row)
        turned[joint] = angle
        factors = signs.factors(forward(robot, turned[None]))[0]
        # The elbow's factor changes its sign with the shoulder's as well.
        return float(factors[number] * (np.sign(factors[0]) if number == 1 else 1.0))

    rows, found = np.random.default_rng(29).uniform(-np.pi, np.pi, (20 * count, 6)), []
    for row in rows:
        turns = np.linspace(-3.1, 3.0, 20)
        values = np.array([factor(turn, row) for turn in turns])
        crossed = np.flatnonzero(values[1:] * values[:-1] < 0)
        if len(crossed):
            low, high = turns[crossed[0]], turns[crossed[0] + 1]
            zero = brentq(factor, low, high, args=(row,), xtol=1e-14)
            if exact is None:
                low, high = zero - BESIDE, zero + BESIDE
                if determinant(low, row) * determinant(high, row) >= 0:
                    continue  # another factor changes its sign as well
                zero = brentq(determinant, low, high, args=(row,), xtol=1e-14)
            row[joint] = zero + off
            found.append(row)
        if len(found) == count:
            break
    assert len(found) == count
    return np.array(found)
