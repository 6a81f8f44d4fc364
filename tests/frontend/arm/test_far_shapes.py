"""Shapes that stand far from the arm, or are far too large, are named."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from assembled import load_robot
from shipped import ROBOTS, TOP

from cellcolor.errors import InputError
from cellcolor.frontend import Scene
from cellcolor.frontend.arm.notes import notes_on_shapes
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.prepared import prepare

UR5 = (ROBOTS / "ur5.urdf").read_text()
TOOL = ROBOTS / "polishing_tool.urdf"


def notes(text: str) -> tuple[str, ...]:
    arm = parse_urdf(text, Path("arm.urdf"), ROBOTS)
    return notes_on_shapes(load_robot(arm, "wrist_3_link", TOOL, "tool_tip"))


def moved(text: str, joint: str, by: float) -> str:
    """A joint's frame moved along its z axis."""
    found = re.search(rf'<joint name="{joint}".*?<origin xyz="(\S+) (\S+) (\S+)"', text, re.DOTALL)
    assert found
    return text[: found.start(3)] + repr(float(found[3]) + by) + text[found.end(3) :]


@pytest.mark.parametrize("far", [574.0, -3.0])
def test_an_uncorrected_calibration(far: float) -> None:
    """It moves the forearm along the parallel axes and the wrist back: the tip stays."""
    raw = moved(moved(UR5, "elbow_joint", far), "wrist_1_joint", -far)
    (note,) = notes(raw)
    ((link, away),) = re.findall(r"'(\w+)' are (\S+) m from its joint", note)
    assert link == "forearm_link" and float(away) == pytest.approx(abs(far), abs=0.3)


def test_a_shape_moved_from_its_link() -> None:
    at = UR5.index("<collision>", UR5.index('<link name="wrist_2_link"'))
    (note,) = notes(UR5[:at] + re.sub(r'xyz="\S+', 'xyz="50', UR5[at:], count=1))
    assert "'wrist_2_link' are 49.9 m from its joint" in note or "are 50 m" in note


def test_a_shape_in_millimeters() -> None:
    at = UR5.index("<collision>", UR5.index('<link name="forearm_link"'))
    wide = UR5[:at] + re.sub(r'radius="[^"]*"', 'radius="60"', UR5[at:], count=1)
    (note,) = notes(wide)
    assert "'forearm_link'" in note and "looks like millimeters" in note


def test_one_of_several_shapes_that_is_elsewhere() -> None:
    """The sphere at one end of the upper arm, 0.9 m off: not as far as the arm is long."""
    at = UR5.index("<collision>", UR5.index('<link name="upper_arm_link"'))
    at = UR5.index("<sphere", at)
    at = UR5.rindex("<collision>", 0, at)
    (note,) = notes(UR5[:at] + re.sub(r'xyz="\S+', 'xyz="0.9', UR5[at:], count=1))
    assert "a collision shape of 'upper_arm_link' is 0." in note and "origin" in note


def test_a_base_in_millimeters_is_not_blamed_on_the_part() -> None:
    at = UR5.index("<collision>", UR5.index('<link name="base_link"'))
    text = UR5[:at] + re.sub(r'radius="[^"]*"', 'radius="75"', UR5[at:], count=1)
    (note,) = notes(text)
    assert "'base_link' are up to 150 m large" in note and "0.15" in note
    scene = Scene.read(TOP / "instances" / "scenes" / "wok.toml")
    robot = {"arm_urdf": text, "tool_urdf": str(TOOL)}
    with pytest.raises(InputError, match=r"looks like millimeters: 0\.15") as caught:
        prepare(scene.with_setup(scene.setup.varied(robot=robot)))
    assert caught.value.field == "link[base_link].collision"


@pytest.mark.parametrize("robot", ["ur3e", "ur5e_calibrated", "ur16e", "kr6", "irb120", "tx2_60"])
def test_no_shipped_arm_is_warned_of(robot: str) -> None:
    file = ROBOTS / f"{robot}.urdf"
    arm = parse_urdf(file.read_text(), file, ROBOTS)
    flange = next(link for link in ("tool0", "flange", "wrist_3_link") if link in arm.links)
    assert not notes_on_shapes(load_robot(arm, flange, TOOL, "tool_tip", force=False))
