"""Kinematics, torques and conditioning against Pinocchio."""

from __future__ import annotations

import bent_tools
import numpy as np
import pytest
from bent_tools import ACROSS, BENT, STRAIGHT
from independent import kinematics_apart

from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
)
from cellcolor.frontend.arm.robot import Robot


def test_a_free_turn(robot: Robot) -> None:
    joints = np.random.default_rng(5).uniform(robot.lower, robot.upper, (100, 6))
    assert kinematics_apart(robot, joints) < 1e-9


@pytest.mark.parametrize("tool", [STRAIGHT, BENT, ACROSS])
def test_a_given_turn(tool: tuple[str, str]) -> None:
    joints = np.random.default_rng(17).uniform(-np.pi, np.pi, (40, 6))
    assert kinematics_apart(bent_tools.robot("kr6", tool), joints) < 1e-9


def test_only_the_determinant_sees_the_aligned_wrist(robot: Robot) -> None:
    poses = forward(robot, np.array([[0.3, -1.2, 1.4, -0.9, 0.0, 0.0]]))
    assert manipulability(poses)[0] > 0.01
    assert task_determinant(poses)[0] < 1e-12
