"""Tools that point back at the arm are named, and no other ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from assembled import load_robot
from shipped import ROBOTS

from cellcolor.frontend.arm.urdf import parse_urdf

TOOL = """<robot name="tool"><link name="body"/>
<joint name="tip_joint" type="fixed"><parent link="body"/><child link="tip"/>
<origin xyz="{xyz}" rpy="{rpy}"/></joint><link name="tip"/></robot>"""


def warnings(
    xyz: str, rpy: str, mounted: float = 0.0, arm: str = "ur5", flange: str = "wrist_3_link"
) -> list[str]:
    """Of the arm with a tool, turned about x at its flange."""
    robot = load_robot(
        ROBOTS / f"{arm}.urdf",
        flange,
        parse_urdf(TOOL.format(xyz=xyz, rpy=rpy), Path("tool.urdf")),
        "tip",
        mount_rpy_rad=(mounted, 0.0, 0.0),
        force=False,
    )
    return [text for text in robot.warnings if "flange" in text]


@pytest.mark.parametrize(
    ("xyz", "rpy"),
    [("0 0 0.1", "3.1416 0 0"), ("0 0 0.1", "0 2.2 0"), ("0.1 0 0", "0 -1.5708 0")],
)
def test_a_tip_that_looks_at_the_flange(xyz: str, rpy: str) -> None:
    (text,) = warnings(xyz, rpy)
    assert "'tip' points back to the flange" in text


@pytest.mark.parametrize("arm", [("ur5", "wrist_3_link"), ("kr6", "tool0"), ("irb120", "tool0")])
def test_a_tool_mounted_the_wrong_way_round(arm: tuple[str, str]) -> None:
    """Its tip is inside the wrist, with an axis that is right as seen from the flange."""
    (text,) = warnings("0 0 0.1", "0 0 0", np.pi, *arm)
    assert "goes from the flange back into the arm" in text
    assert not warnings("0 0 0.1", "0 0 0", 0.0, *arm)


@pytest.mark.parametrize(
    ("xyz", "rpy"),
    [
        ("0 0 0.1", "0 1.5708 0"),  # a bent tool, at a right angle
        ("0.1 0 0.05", "0 0 0"),  # one beside the axis
        ("0.1 0 -0.05", "0 0 0"),  # a bracket that goes back a little
        ("0 0 0", "0 0 0"),  # the flange itself
    ],
)
def test_tools_that_are_meant(xyz: str, rpy: str) -> None:
    assert not warnings(xyz, rpy)
