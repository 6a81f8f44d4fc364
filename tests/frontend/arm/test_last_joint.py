"""A tool beside the axis of the last joint is refused with the distance that it is off."""

from __future__ import annotations

import math

import numpy as np
import pytest
from shipped import ROBOTS

from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import check_tool_on_last_axis
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.robot import Robot


def mounted(position: tuple[float, float, float], rpy: tuple[float, float, float]) -> Robot:
    files = (ROBOTS / "ur5.urdf", "wrist_3_link", ROBOTS / "polishing_tool.urdf", "tool_tip")
    return load_robot(*files, mounted=(position, rpy))


def check(robot: Robot) -> None:
    check_tool_on_last_axis(robot, forward(robot, np.zeros((1, 6))), "not that arm")


def test_off_by_a_mount() -> None:
    # Tilted about the flange by an angle, the tip 0.1 m from it; the offset is across that.
    tilt = math.radians(3)
    off = math.hypot(100 * math.sin(tilt), 12.5)
    with pytest.raises(InputError, match=f"tip is {off:.3g} mm off it, the axis 3 deg") as caught:
        check(mounted((0.0, 0.0125, 0.0), (0.0, tilt, 0.0)))
    assert caught.value.field == "joint[wrist_3_joint]"


def test_on_the_axis_at_any_turn() -> None:
    check(mounted((0.0, 0.0, 0.07), (0.0, 0.0, 1.2)))
