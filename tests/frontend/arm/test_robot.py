"""The URDF files, their reading, and the faults that other readers swallow."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from assembled import load_robot
from pinocchio_reading import geometry_of
from shipped import ROBOTS
from world import NEIGHBORS, PAIRS, World

from cellcolor.errors import InputError
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import ur_geometry

ARM, TOOL = "ur5.urdf", "polishing_tool.urdf"
CIRCLE = (
    '<link name="one"/><joint name="a" type="fixed"><parent link="one"/><child link="two"/></joint>'
    '<link name="two"/><joint name="b" type="fixed"><parent link="two"/><child link="one"/></joint>'
    "</robot>"
)
RAIL = (
    '<link name="rail"/><joint name="rail_joint" type="prismatic"><parent link="rail"/>'
    '<child link="base_link"/><axis xyz="0 1 0"/><limit lower="0" upper="3000"/></joint>'
    '<link name="base_link">'
)


def load(folder: Path) -> Robot:
    return load_robot(folder / ARM, "wrist_3_link", folder / TOOL, "tool_tip")


@pytest.fixture
def written(tmp_path: Path) -> Callable[..., Path]:
    """Both files copied, one with a pattern replaced."""

    def write(name: str, pattern: str, replacement: str, count: int = 1) -> Path:
        for file in (ARM, TOOL):
            text = (ROBOTS / file).read_text()
            if file == name:
                text, found = re.subn(pattern, replacement, text, count=count, flags=re.DOTALL)
                assert found
            (tmp_path / file).write_text(text)
        return tmp_path

    return write


def test_masses_and_limits_are_the_published_ones(robot: Robot) -> None:
    tool = 0.5
    published = [3.7, 8.393, 2.33, 1.219, 1.219, 0.1879 + tool]
    assert np.allclose(robot.mass, published, atol=1e-12)
    assert robot.effort.tolist() == [150, 150, 150, 28, 28, 28]
    assert np.allclose(robot.upper, 2 * np.pi) and np.allclose(robot.lower, -2 * np.pi)


def test_every_shape_collides(robot: Robot) -> None:
    assert geometry_of(robot).ngeoms == 7 * 3 + 1 + 1
    kinds = [(body.link, body.flat) for body in robot.bodies]
    assert len(kinds) == 9
    assert [link for link, flat in kinds if flat] == ["wrist_3_link", "tool_body"]


def test_bodies_touch_one_another_in_a_row(robot: Robot) -> None:
    # Therefore no part of the arm can be inside a closed mesh that the arm does not cut.
    world = World(robot, np.eye(3), np.array([[0, 1, 2]]))
    for q in np.random.default_rng(1).uniform(-np.pi, np.pi, (20, 6)):
        world.place(q)
        for pair in NEIGHBORS:
            assert world.to_itself({frozenset(pair)}) <= 1e-9


def test_neighbors_are_not_tested_against_each_other(robot: Robot) -> None:
    names = {frozenset((robot.bodies[i].link, robot.bodies[j].link)) for i, j in robot.tested_pairs}
    assert names == PAIRS
    # The upper arm has two bodies, and five links that are not next to it.
    assert len(robot.tested_pairs) == 8 * 7 / 2 - 7 + 5


@pytest.mark.parametrize(
    ("file", "pattern", "replacement", "field", "message"),
    [
        (ARM, r"<limit [^>]*/>", "", "joint[shoulder_pan_joint].limit", "'lower' is missing"),
        (ARM, r'lower="[^"]*" ', "", "joint[shoulder_pan_joint].limit", "'lower' is missing"),
        (ARM, r'effort="150"', 'effort="0"', "joint[shoulder_pan_joint].limit.effort", "positive"),
        (ARM, r'upper="[^"]*"', 'upper="-7"', "joint[shoulder_pan_joint].limit", "not below"),
        (ARM, r'upper="[^"]*"', 'upper="nan"', "joint[shoulder_pan_joint].limit.upper", "finite"),
        (TOOL, r"<inertial>.*?</inertial>", "", "link[tool_body].inertial", "weigh nothing"),
        (ARM, r'<mass value="3.7"/>', "", "link[shoulder_link].inertial.mass", "missing"),
        (ARM, r'<mass value="3.7"/>', '<mass value="-1"/>',
         "link[shoulder_link].inertial.mass.value",
         "must be positive .*force = false under .constraints"),
        (ARM, r"<cylinder ", "<cone ", "link[base_link].collision[0]", "<cone>"),
        (ARM, r'radius="0.065"', 'radius="0"', "link[base_link].collision[0].radius", "positive"),
        (ARM, r'radius="0.065"', 'radius="x"', "link[base_link].collision[0].radius", "a number"),
        (ARM, r'type="revolute"', 'type="floating"', "joint[shoulder_pan_joint].type", "floating"),
        (ARM, r'type="revolute"', 'type="prismatic"', "joint[shoulder_pan_joint].type", "prism"),
        (ARM, r'<axis xyz="0 0 1"', '<axis xyz="0 0 2"', "joint[shoulder_pan_joint].axis", "len"),
        (ARM, r'<parent link="base_link"', '<parent link="bass"',
         "joint[shoulder_pan_joint].parent", "'bass'"),
        (ARM, r'xyz="0 0 0.089159"', 'xyz="0 0"', "joint[shoulder_pan_joint].origin.xyz", "three"),
        (ARM, r"</robot>", "<link name='base_link'/></robot>", "link[base_link]", "twice"),
        (ARM, r"</robot>", "<link name='alone'/></robot>", "robot", "one root link"),
        (ARM, r'upper="6.28\d*"', 'upper="180"', "joint[shoulder_pan_joint].limit",
         "looks like degrees: 3.1416 rad"),
        (ARM, r'lower="-6.28\d*"', 'lower="-90"', "joint[shoulder_pan_joint].limit",
         "looks like degrees: -1.5708 rad"),
        (ARM, r'upper="6.28\d*"', 'upper="999999"', "joint[shoulder_pan_joint].limit",
         "999999 is as good as none"),
        (ARM, r'rpy="0 0 3.14\d*"', 'rpy="0 0 180"', "joint[shoulder_pan_joint].origin.rpy",
         "looks like degrees: 3.1416"),
        (ARM, r'<link name="base_link">', RAIL, "joint[rail_joint].limit",
         "3000 looks like millimeters: 3 m"),
        # An arm whose forearm follows the upper arm.
        (ARM, r'(<joint name="elbow_joint" type="revolute">)',
         r'\1<mimic joint="shoulder_lift_joint" multiplier="-1"/>', "joint[elbow_joint].mimic",
         "follows 'shoulder_lift_joint', which moves"),
        (ARM, r"</robot>", CIRCLE, "link[one]", "hangs on itself"),
        (ARM, r"</robot>", "", "", "not XML"),
        (ARM, r'"wrist_3_link"', '"hand"', "link[wrist_3_link]", "flange"),
        (ARM, r'(name="wrist_3_joint" type=)"revolute"', r'\1"fixed"', "robot", "six|6 revolute"),
        (TOOL, r'"tool_tip"', '"point"', "link[tool_tip]", "tip link"),
        (TOOL, r'"tool_body"', '"forearm_link"', "link[forearm_link]", "that name too"),
    ],
)  # fmt: skip
def test_faults_are_named(
    written: Callable[..., Path],
    file: str,
    pattern: str,
    replacement: str,
    field: str,
    message: str,
) -> None:
    everywhere = replacement in ('"hand"', '"point"', '"forearm_link"')
    folder = written(file, pattern, replacement, count=0 if everywhere else 1)
    with pytest.raises(InputError, match=message) as caught:
        load(folder)
    assert caught.value.file == str(folder / file)
    assert (caught.value.field or "") == field
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("joint", "pattern", "replacement", "message"),
    [
        ("elbow_joint", '"-0.425 0 0" rpy="0 0 0"', '"-0.425 0 0" rpy="0.1 0 0"', "parallel"),
        ("wrist_2_joint", 'xyz="0 -0.09465 0"', 'xyz="0.01 -0.09465 0"', "meet"),
        ("wrist_2_joint", '0 -0.09465 0" rpy="1.5', '0 -0.09465 0" rpy="1.4', "right angles"),
        ("shoulder_lift_joint", 'xyz="0 0 0" rpy="1.5', 'xyz="0.02 0 0" rpy="1.5', "meet"),
        ("elbow_joint", 'xyz="-0.425 0 0"', 'xyz="0 0 0.1"', "a2 is zero"),
    ],
)  # fmt: skip
def test_other_arms_are_refused(
    written: Callable[..., Path], joint: str, pattern: str, replacement: str, message: str
) -> None:
    folder = written(ARM, re.escape(pattern), replacement)
    with pytest.raises(InputError, match=message) as caught:
        ur_geometry(load(folder))
    assert caught.value.field == f"joint[{joint}]"
    assert "not a UR-type arm" in caught.value.message


def shapeless(text: str, link: str) -> str:
    """A URDF's text without the collision shapes of links whose names match."""

    def bare(found: re.Match[str]) -> str:
        return re.sub(r"<collision>.*?</collision>", "", found.group(), flags=re.DOTALL)

    return re.sub(rf'<link name="{link}">.*?</link>', bare, text, flags=re.DOTALL)


def test_links_that_cannot_collide_are_named(tmp_path: Path) -> None:
    assert load(ROBOTS).warnings == ()  # frames such as the tip are no things
    for file in (ARM, TOOL):
        (tmp_path / file).write_text((ROBOTS / file).read_text())
    text = (ROBOTS / ARM).read_text()
    (tmp_path / ARM).write_text(shapeless(text, "(upper_arm|wrist_2)_link"))
    (warning,) = load(tmp_path).warnings
    assert warning.endswith("'upper_arm_link', 'wrist_2_link'")
    for file in (ARM, TOOL):
        (tmp_path / file).write_text(shapeless((ROBOTS / file).read_text(), r"[^\"]*"))
    (warning,) = load(tmp_path).warnings
    assert "no collision shapes at all" in warning


def test_limits_that_nothing_reaches_are_none(written: Callable[..., Path]) -> None:
    """As of vendors who write 999999."""
    both = r'lower="-6.28\d*" upper="6.28\d*"'
    robot = load(written(ARM, both, 'lower="-999999" upper="999999"'))
    assert (robot.lower[0], robot.upper[0]) == (-np.inf, np.inf)


@pytest.mark.parametrize(
    ("soft", "limits"),
    [
        ('soft_lower_limit="-2.5" soft_upper_limit="7"', (-2.5, 2 * np.pi)),  # 7 is beyond
        ('soft_lower_limit="-2.5" soft_upper_limit="2"', (-2.5, 2)),
        ('soft_lower_limit="0" soft_upper_limit="0"', (-2 * np.pi, 2 * np.pi)),  # nobody gave any
        ('k_position="20"', (-2 * np.pi, 2 * np.pi)),
    ],
)
def test_soft_limits_are_kept(
    soft: str, limits: tuple[float, float], written: Callable[..., Path]
) -> None:
    robot = load(written(ARM, "<limit", f'<safety_controller {soft} k_velocity="10"/><limit'))
    assert np.allclose((robot.lower[0], robot.upper[0]), limits)
    assert np.allclose((robot.lower[1:], robot.upper[1:]), [[-2 * np.pi], [2 * np.pi]])


def test_velocities_in_degrees_are_said(written: Callable[..., Path]) -> None:
    robot = load(written(ARM, r'velocity="3.1\d*"', 'velocity="180"', count=2))
    (text,) = [text for text in robot.warnings if "degrees per second" in text]
    assert text.endswith("'shoulder_pan_joint' 180 rad/s, 'shoulder_lift_joint' 180 rad/s")
    assert not load(ROBOTS).warnings
