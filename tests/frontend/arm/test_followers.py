"""Joints with ``<mimic>``: they move what hangs on them, and what cannot be followed is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import ROBOTS

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.contact.engine import Contacts, pairs_of
from cellcolor.frontend.contact.tip import body_ends
from examples import examples

ARM, TOOL = ROBOTS / "ur5.urdf", ROBOTS / "polishing_tool.urdf"
LIMIT = '<limit lower="-9" upper="9" effort="1" velocity="1"/>'


def joint(
    name: str,
    parent: str,
    mimic: str,
    kind: str = "revolute",
    origin: str = "",
    axis: str = "0 0 1",
    limit: str = LIMIT,
    at: str = "0 0 0",
) -> str:
    """A joint that follows another one, and a ball on the link behind it."""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{name}_link"/>'
        f'{origin}<axis xyz="{axis}"/>{limit}<mimic {mimic}/></joint><link name="{name}_link">'
        f'<collision><origin xyz="{at}"/><geometry><sphere radius="0.01"/></geometry></collision>'
        "</link>"
    )


def load(more: str = "", *, tool: str = "", force: bool = False) -> Robot:
    arm = ARM.read_text().replace("</robot>", more + "</robot>")
    own = TOOL.read_text().replace("</robot>", tool + "</robot>")
    arm_urdf, tool_urdf = parse_urdf(arm, ARM), parse_urdf(own, TOOL)
    return load_robot(arm_urdf, "wrist_3_link", tool_urdf, "tool_tip", force=force)


FLANGE_ORIGIN = '<origin xyz="0.1 -0.2 0.05" rpy="0.3 -0.4 0.5"/>'
NAIL_ORIGIN = '<origin xyz="0 0.03 0.02" rpy="-1 0.2 0"/>'


@examples(20)
@given(
    q=st.lists(st.floats(-3, 3), min_size=6, max_size=6),
    factor=st.sampled_from([-1.0, 2.0, 0.5]),
    offset=st.floats(-0.5, 0.5),
    kind=st.sampled_from(["revolute", "prismatic", "continuous"]),
)
def test_bodies_are_where_their_joints_put_them(
    q: list[float], factor: float, offset: float, kind: str
) -> None:
    """A link on the upper arm that follows the elbow, and one on that which follows the first."""
    narrow = LIMIT.replace("9", "4")
    mimic = f'joint="elbow_joint" multiplier="{factor}" offset="{offset}"'
    rod = joint("rod", "upper_arm_link", mimic, kind, FLANGE_ORIGIN, "0 0.6 0.8", narrow, "0 0 0.1")
    nail = joint(
        "nail", "rod_link", 'joint="rod" multiplier="0.25"', "prismatic", NAIL_ORIGIN,
        "1 0 0", LIMIT.replace("9", "0.25"), "0.01 0 0",
    )  # fmt: skip
    robot = load(nail + rod)  # whatever their order in the file
    model = load().model
    data = model.createData()
    pin.framesForwardKinematics(model, data, np.array(q))
    upper_arm = data.oMf[model.getFrameId("upper_arm_link")].homogeneous
    first = factor * q[2] + offset
    moved = slid(first, [0, 0.6, 0.8]) if kind == "prismatic" else turned(first, [0, 0.6, 0.8])
    rod_link = upper_arm @ placed([0.1, -0.2, 0.05], [0.3, -0.4, 0.5]) @ moved
    nail_link = rod_link @ placed([0, 0.03, 0.02], [-1, 0.2, 0]) @ slid(0.25 * first, [1, 0, 0])
    ends = body_ends(robot, forward(robot, np.array([q])))[:, 0, 0]
    for link, pose, at in (("rod", rod_link, [0, 0, 0.1, 1]), ("nail", nail_link, [0.01, 0, 0, 1])):
        (number,) = [k for k, body in enumerate(robot.bodies) if body.link == f"{link}_link"]
        assert ends[number] == pytest.approx((pose @ at)[:3], abs=1e-12)


def placed(xyz: list[float], rpy: list[float]) -> Array:
    """The pose of a URDF's origin, its three turns one after the other."""
    roll, pitch, yaw = (turned(a, axis) for a, axis in zip(rpy, np.eye(3), strict=True))
    return slid(1.0, xyz) @ yaw @ pitch @ roll


def turned(angle: float, axis: Array | list[float]) -> Array:
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec(angle * np.asarray(axis)).as_matrix()
    return pose


def slid(by: float, axis: list[float]) -> Array:
    pose = np.eye(4)
    pose[:3, 3] = by * np.array(axis)
    return pose


def test_a_follower_hits_what_it_meets_only_where_it_has_moved() -> None:
    """A ball at the base slides to the flange while joint 6 turns by 1 rad, which moves no axis."""
    q = np.array([0.3, -1.2, 1.4, -1.0, -1.5, 0.0])
    plain = load()
    goal = forward(plain, q[None]).origin[0, 6]
    start = np.array([0.0, 0.5, 0.8])
    way = goal - start
    length = float(np.linalg.norm(way))
    base = next(body.link for body in plain.bodies if body.joint == 0)
    ball = joint(
        "slide", base, f'joint="wrist_3_joint" multiplier="{length!r}"', "prismatic",
        f'<origin xyz="{start[0]} {start[1]} {start[2]}"/>',
        " ".join(repr(float(x)) for x in way / length),
        '<limit lower="-2" upper="2" effort="1" velocity="1"/>',
    )  # fmt: skip
    robot = load(ball)
    tried = np.array([q, q + np.eye(6)[5]])
    for own, expected in ((plain, [False, False]), (robot, [False, True])):
        assert Contacts(pairs_of(own), own)(tried).tolist() == expected
    still = replace(robot, followers=(replace(robot.followers[0], multiplier=0.0),))
    assert not Contacts(pairs_of(still), still)(tried).any()
    some = forward(robot, tried).take(np.array([1]))
    assert (
        body_ends(robot, some)[:, :, 0] == body_ends(robot, forward(robot, tried))[:, :, 1]
    ).all()


@pytest.mark.parametrize("factor", [0.5, -4.0])
def test_followers_stay_within_their_limits(factor: float) -> None:
    limit = LIMIT.replace('-9" upper="9', '-0.4" upper="1')
    mimic = f'joint="wrist_1_joint" multiplier="{factor}" offset="0.2"'
    robot = load(tool=joint("finger", "tool_body", mimic, limit=limit))
    ends = np.array([factor * robot.lower[3] + 0.2, factor * robot.upper[3] + 0.2])
    assert np.sort(ends) == pytest.approx([-0.4, 1])
    assert (np.delete(robot.lower, 3) == np.delete(load().lower, 3)).all()
    assert robot.warnings == ()


@pytest.mark.parametrize(
    ("mimic", "keys", "message"),
    [
        ('joint="fingr"', {}, "no joint 'fingr'"),
        ('joint="finger"', {}, "follows itself"),
        ('joint="wrist_1_joint" offset="30"', {}, "nowhere"),
        ('joint="wrist_1_joint" multiplier="0.5"', {"limit": ""}, "more than a circle"),
        ('joint="wrist_1_joint"', {"kind": "prismatic", "limit": ""}, "more than a circle"),
        ('joint="wrist_1_joint"', {"kind": "floating"}, "floating"),
        ('joint="wrist_1_joint"', {"axis": "0 0 2"}, "length 1"),
    ],
)
def test_what_cannot_follow_is_refused(mimic: str, keys: dict[str, str], message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        load(tool=joint("finger", "tool_body", mimic, **keys))
    assert caught.value.file == str(TOOL)
    assert (caught.value.field or "").startswith("joint[finger].")


def test_a_weight_that_follows_is_refused_where_forces_are_asked_for() -> None:
    inertia = " ".join(f'{a}="1e-5"' for a in ("ixx", "iyy", "izz"))
    inertia += " " + " ".join(f'{a}="0"' for a in ("ixy", "ixz", "iyz"))
    mass = f'<inertial><mass value="0.1"/><inertia {inertia}/></inertial></link>'
    finger = joint("finger", "tool_body", 'joint="wrist_1_joint"').replace("</link>", mass)
    assert len(load(tool=finger).followers) == 1
    with pytest.raises(InputError, match="force = false") as caught:
        load(tool=finger, force=True)
    assert caught.value.file == str(TOOL)
