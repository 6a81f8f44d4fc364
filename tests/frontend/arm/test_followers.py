"""Joints with ``<mimic>``: they stand still with their leaders, and others are refused."""

from __future__ import annotations

import pytest
from assembled import load_robot
from shipped import ROBOTS

from cellcolor.errors import InputError
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import parse_urdf

ARM, TOOL = ROBOTS / "ur5.urdf", ROBOTS / "polishing_tool.urdf"
LIMIT = '<limit lower="-9" upper="9" effort="1" velocity="1"/>'


def joint(
    name: str,
    parent: str,
    mimic: str,
    kind: str = "revolute",
    axis: str = "0 0 1",
    limit: str = LIMIT,
) -> str:
    """A joint that follows another one, and a ball on the link behind it."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{name}_link"/>'
        f'<axis xyz="{axis}"/>{limit}<mimic {mimic}/></joint><link name="{name}_link">'
        f'<collision><geometry><sphere radius="0.01"/></geometry></collision>'
        "</link>"
    )


def load(*, tool: str = "", fixed_joints: dict[str, float] | None = None) -> Robot:
    own = TOOL.read_text().replace("</robot>", tool + "</robot>")
    tool_urdf = parse_urdf(own, TOOL)
    return load_robot(
        ARM, "wrist_3_link", tool_urdf, "tool_tip", fixed_joints=fixed_joints or {}, force=False
    )


@pytest.mark.parametrize(
    ("mimic", "keys", "message"),
    [
        ('joint="fingr"', {}, "no joint 'fingr'"),
        ('joint="finger"', {}, "follows itself"),
        ('joint="wrist_1_joint"', {"limit": ""}, r"moves: give its position .* finger = 0\.0"),
        ('joint="wrist_1_joint"', {"kind": "floating"}, "floating"),
        ('joint="wrist_1_joint"', {"axis": "0 0 2"}, "length 1"),
    ],
)
def test_what_cannot_follow_is_refused(mimic: str, keys: dict[str, str], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        load(tool=joint("finger", "tool_body", mimic, **keys))
    assert caught.value.file == str(TOOL)
    assert (caught.value.field or "").startswith("joint[finger].")


def test_a_follower_of_a_joint_that_moves_can_stand_still() -> None:
    finger = joint("finger", "tool_body", 'joint="wrist_1_joint"')
    with pytest.raises(InputError, match="moves"):
        load(tool=finger)
    robot = load(tool=finger, fixed_joints={"finger": 0.1})
    assert robot.joint_names == load().joint_names
    assert [body.link for body in robot.bodies].count("finger_link") == 1
