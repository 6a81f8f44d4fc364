"""Configurations of six-axis arms next to a singular wrist, elbow or shoulder."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import signs_of

KINDS = {"wrist": (4, 2), "elbow": (2, 1), "shoulder": (1, 0)}  # joint that leads there, factor


def near_singular(robot: Robot, reach: float, kind: str, off: float, count: int) -> Array:
    """Configurations (count, 6) that are ``off`` rad in one joint from a singularity.

    Args:
        robot: an arm whose branches signs tell apart.
        reach: of the arm, m.
        kind: one of ``KINDS``.
    """
    signs = signs_of(robot, reach, 1e-6)
    assert signs is not None
    joint, number = KINDS[kind]

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
            row[joint] = brentq(factor, low, high, args=(row,), xtol=1e-14) + off
            found.append(row)
        if len(found) == count:
            break
    assert len(found) == count
    return np.array(found)
