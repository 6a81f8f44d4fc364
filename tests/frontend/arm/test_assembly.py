"""Vendors' trees: joints that stand still, tools at any pose, missing masses and efforts."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from assembled import load_robot
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import ROBOTS

from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import Urdf, parse_urdf
from cellcolor.frontend.setup import Setup

ARM = (ROBOTS / "ur5.urdf").read_text()
TOOL = ROBOTS / "polishing_tool.urdf"
GRIPPER = """
  <joint name="{name}" type="{kind}"><parent link="tool_body"/><child link="{name}_link"/>
    <origin xyz="0 0.01 0.05" rpy="0.3 0.2 -0.4"/><axis xyz="0 0.6 0.8"/>{limit}</joint>
  <link name="{name}_link"><inertial><origin xyz="0 0.02 0.03"/><mass value="0.1"/>
    <inertia ixx="1e-5" ixy="0" ixz="0" iyy="1e-5" iyz="0" izz="1e-5"/></inertial></link>
"""
LIMIT = '<limit lower="-0.1" upper="2" effort="1" velocity="1"/>'


def tool_with(kind: str = "prismatic", limit: str = LIMIT, more: str = "") -> Urdf:
    """The polishing tool with a finger."""
    finger = GRIPPER.format(name="finger", kind=kind, limit=limit)
    text = TOOL.read_text().replace("</robot>", f"{finger}{more}</robot>")
    return parse_urdf(text, Path("tool.urdf"))


def arm_with(pattern: str, replacement: str, count: int = 1) -> Urdf:
    text, found = re.subn(pattern, replacement, ARM, count=count, flags=re.DOTALL)
    assert found
    return parse_urdf(text, Path("arm.urdf"))


def load(arm: Urdf | None = None, tool: Urdf | None = None, **keys: object) -> Robot:
    return load_robot(
        arm or parse_urdf(ARM, Path("arm.urdf")),
        "wrist_3_link",
        tool or parse_urdf(TOOL.read_text(), Path("tool.urdf")),
        "tool_tip",
        **keys,  # type: ignore[arg-type]
    )


def test_a_gripper_has_to_be_given_its_position() -> None:
    with pytest.raises(InputError, match=r"\[robot.fixed_joints\], as finger = 0.0") as caught:
        load(tool=tool_with())
    assert (caught.value.file, caught.value.field) == ("tool.urdf", "joint[finger]")


@given(
    kind=st.sampled_from(["revolute", "prismatic", "continuous"]),
    position=st.floats(-0.1, 2),
)
def test_a_fixed_joint_stands_where_the_urdf_puts_it(kind: str, position: float) -> None:
    """By Rodrigues' formula: what hangs on it moves the last frame's center of mass."""
    robot = load(tool=tool_with(kind), fixed_joints={"finger": position})
    turn = Rotation.from_euler("xyz", [0.3, 0.2, -0.4]).as_matrix()
    axis, point = np.array([0, 0.6, 0.8]), np.array([0, 0.02, 0.03])
    if kind == "prismatic":
        moved = point + position * axis
    else:
        cos, sin = np.cos(position), np.sin(position)
        moved = point * cos + np.cross(axis, point) * sin + axis * (axis @ point) * (1 - cos)
    flange = load()
    # The tool's root link is the flange, whose frame is that of the last joint.
    place = np.array([0, 0.01, 0.05]) + turn @ moved
    mass, center = flange.mass[5] + 0.1, flange.mass[5] * flange.center[5]
    root = flange.tip[:3, 3] - 0.1 * flange.tip[:3, 2]
    expected = (center + 0.1 * (root + flange.tip[:3, :3] @ place)) / mass
    assert robot.mass[5] == pytest.approx(mass)
    assert robot.center[5] == pytest.approx(expected, abs=1e-12)
    assert robot.model.nq == 6


def test_a_follower_of_a_fixed_joint_follows_it() -> None:
    other = GRIPPER.format(
        name="thumb", kind="prismatic", limit='<mimic joint="finger" multiplier="-2" offset="0.5"/>'
    )
    robot = load(tool=tool_with(more=other), fixed_joints={"finger": 0.2})
    assert "mimic" not in " ".join(robot.warnings)  # none is left where it stands at zero
    alone = tool_with(more=GRIPPER.format(name="thumb", kind="prismatic", limit=LIMIT))
    expected = load(tool=alone, fixed_joints={"finger": 0.2, "thumb": -2 * 0.2 + 0.5})
    assert robot.center[5] == pytest.approx(expected.center[5], abs=1e-15)


@pytest.mark.parametrize(
    ("given_", "field", "message"),
    [
        ({"finger": 2.5}, "robot.fixed_joints.finger", "2.5 is outside .* -0.1 to 2"),
        ({"fingr": 0.0}, "robot.fixed_joints.fingr", "no such joint"),
        ({"finger": 0.0, "elbow_joint": 0.3}, "robot", "needs 6 revolute joints .* has 5"),
    ],
)
def test_positions_that_cannot_be(given_: dict[str, float], field: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        load(tool=tool_with(), fixed_joints=given_)
    assert caught.value.field == field


def test_a_rail_under_the_arm_can_stand_still() -> None:
    """A prismatic joint between base and tip is refused, and given its position it is a base."""
    rail = (
        '<link name="rail"/><joint name="slide" type="prismatic"><parent link="rail"/>'
        '<child link="base_link"/><axis xyz="0 1 0"/>'
        '<limit lower="0" upper="3" effort="9" velocity="1"/></joint></robot>'
    )
    arm = arm_with("</robot>", rail)
    with pytest.raises(InputError, match=r"prismatic, .*slide = 0.0") as caught:
        load(arm)
    assert caught.value.field == "joint[slide].type"
    moved, standing = load(arm, fixed_joints={"slide": 1.25}), load()
    joints = np.random.default_rng(3).uniform(-3, 3, (20, 6))
    there, here = forward(moved, joints), forward(standing, joints)
    assert there.tip == pytest.approx(here.tip + np.array([0, 1.25, 0]), abs=1e-12)


def test_continuous_joints_have_no_limits() -> None:
    arm = arm_with(
        r'(<joint name="wrist_3_joint" type=)"revolute"(.*?)<limit [^>]*/>', r'\1"continuous"\2'
    )
    with pytest.raises(InputError, match=r"'effort' is missing .*force = false"):
        load(arm)
    robot = load(arm, force=False)
    assert robot.lower.tolist()[5] == -np.inf and robot.upper.tolist()[5] == np.inf
    assert np.isnan(robot.effort[5]) and np.isnan(robot.velocity[5])
    assert robot.lower[:5].tolist() == load().lower[:5].tolist()
    joints = np.random.default_rng(3).uniform(-9, 9, (20, 6))
    assert forward(robot, joints).tip == pytest.approx(forward(load(), joints).tip, abs=1e-12)


@given(position=st.tuples(*[st.floats(-0.5, 0.5)] * 3), rpy=st.tuples(*[st.floats(-3.1, 3.1)] * 3))
def test_a_tool_is_where_it_is_mounted(
    position: tuple[float, float, float], rpy: tuple[float, float, float]
) -> None:
    plain, moved = load(), load(mount_position_m=position, mount_rpy_rad=rpy)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = Rotation.from_euler("xyz", rpy).as_matrix(), position
    flange = plain.tip @ np.linalg.inv(_translation(0.1))
    assert moved.tip == pytest.approx(flange @ pose @ _translation(0.1), abs=1e-12)


def _translation(z: float) -> np.ndarray:
    pose = np.eye(4)
    pose[2, 3] = z
    return pose


@pytest.mark.parametrize("name", ["tool0", "flange", "ee_link"])
def test_any_frame_on_the_last_link_is_a_flange(name: str) -> None:
    frame = (
        f'<link name="{name}"/><joint name="to_{name}" type="fixed"><parent link="wrist_3_link"/>'
        f'<child link="{name}"/><origin xyz="0.01 0 0.02" rpy="0 0 0.5"/></joint></robot>'
    )
    arm = arm_with("</robot>", frame)
    tool = parse_urdf(TOOL.read_text(), Path("tool.urdf"))
    robot = load_robot(arm, name, tool, "tool_tip")
    moved = load(mount_position_m=(0.01, 0, 0.02), mount_rpy_rad=(0, 0, 0.5))
    assert robot.tip == pytest.approx(moved.tip, abs=1e-12)
    with pytest.raises(InputError, match=f"not in the arm, which has '{name}'"):
        load_robot(arm, "hand", tool, "tool_tip")


@pytest.mark.parametrize(
    "text",
    [
        '<robot xmlns:xacro="http://ros.org/wiki/xacro"><xacro:arm prefix=""/></robot>',
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="${prefix}a"/></robot>',
        "<robot><xacro:include filename='$(find x)/y.xacro'/></robot>",
    ],
)
def test_xacro_is_refused_with_the_command(text: str) -> None:
    with pytest.raises(
        InputError, match=r"xacro arm.urdf.xacro -o arm.urdf .without ROS: pip install xacrodoc"
    ):
        parse_urdf(text, Path("some/arm.urdf.xacro"))


def test_setups_of_before_are_written_as_before() -> None:
    """Fingerprints of surfaces have the setup in them: new keys stand there only when given."""
    setup = Setup.read(ROBOTS / "ur5_polishing.toml")
    written = setup.model_dump(mode="json")
    assert "margins" not in written
    assert set(written["robot"]) == {
        "arm_urdf", "flange_link", "tool_urdf", "tip_link", "locked_joint_6_rad",
        "may_touch_ground",
    }  # fmt: skip
    mounted = setup.varied(robot={"mount_position_m": (0, 0, 0.1), "fixed_joints": {"a": 1}})
    assert mounted.model_dump(mode="json")["robot"]["mount_position_m"] == [0, 0, 0.1]
    assert mounted.model_dump(mode="json")["robot"]["fixed_joints"] == {"a": 1}
