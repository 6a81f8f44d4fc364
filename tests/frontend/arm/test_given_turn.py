"""Whole poses of the tool: rules for its turn, solutions, names and measures of conditioning."""

from __future__ import annotations

import math

import bent_tools
import calibrated
import numpy as np
import pytest
from bent_tools import ACROSS, BENT, STRAIGHT, tip_frame, tip_frames
from hypothesis import given
from hypothesis import strategies as st
from independent import set_distance, wrapped

from cellcolor.arrays import Array
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import (
    angle_about,
    forward,
    task_determinant,
    tip_jacobian,
    turned_about,
)
from cellcolor.frontend.arm.robot import GIVEN_TURN, Robot
from cellcolor.frontend.arm.turned import TurnedKinematics, turn_at
from cellcolor.frontend.arm.ur import BRANCHES as UR_BRANCHES
from cellcolor.frontend.arm.ur import UrKinematics
from cellcolor.frontend.setup import RobotFiles, Turn

pytestmark = pytest.mark.second

FILES = RobotFiles(arm_urdf="<", flange_link="flange", tool_urdf="<", tip_link="tool_tip")
FAMILIES: dict[str, type[InverseKinematics]] = {"ur": UrKinematics, "eaik": EaikKinematics}
ARMS = [("ur", "ur5e"), ("eaik", "ur5e"), ("eaik", "kr6"), ("eaik", "puma560")]
TOOLS = {"straight": STRAIGHT, "bent": BENT, "across": ACROSS}


def made(family: str, arm: str, tool: str) -> tuple[Robot, TurnedKinematics]:
    robot = bent_tools.robot(arm, TOOLS[tool])
    return robot, TurnedKinematics(FAMILIES[family], robot, FILES, Turn(along=(1, 0, 0)))


def found(solutions: Array) -> list[Array]:
    return [each[~np.isnan(each[:, 0])] for each in solutions]


# --- the rule -----------------------------------------------------------------------------------

unit = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 0.1)
place = st.tuples(*[st.floats(-2, 2)] * 3)


@given(unit, place, unit, st.booleans())
def test_the_tool_points_as_far_to_the_goal_as_it_can(
    goal: tuple[float, ...], point: tuple[float, ...], direction: tuple[float, ...], towards: bool
) -> None:
    """Held against a search through a thousand directions across the tool."""
    z = np.array(direction) / np.linalg.norm(direction)
    turn = Turn(towards_m=goal) if towards else Turn(along=goal)
    across = turn_at(turn, np.array([point]), z[None])[0]
    wanted = np.array(goal) - np.array(point) if towards else np.array(goal)
    length = np.linalg.norm(wanted)
    if np.isnan(across).any():
        assert np.linalg.norm(np.cross(wanted, z)) < 2e-6 * max(1.0, length)
        return
    assert abs(across @ z) < 1e-5 and np.linalg.norm(across) == pytest.approx(1, abs=1e-9)
    one = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
    one /= np.linalg.norm(one)
    angles = np.linspace(0, 2 * np.pi, 1000)[:, None]
    others = np.cos(angles) * one + np.sin(angles) * np.cross(z, one)
    assert across @ wanted >= (others @ wanted).max() - 1e-5 * length


@given(unit, unit, st.floats(-3.1, 3.1))
def test_an_angle_about_the_tool_is_what_it_was_turned_by(
    direction: tuple[float, ...], other: tuple[float, ...], angle: float
) -> None:
    z = np.array([direction]) / np.linalg.norm(direction)
    first = np.cross(z, np.array([other]))
    if np.linalg.norm(first) < 1e-3:
        return
    second = turned_about(z, first, np.array([angle]))
    assert angle_about(z, first, second)[0] == pytest.approx(angle, abs=1e-9)
    # By the right-hand rule about the tool's z axis, as scipy's rotation vectors have it.
    from scipy.spatial.transform import Rotation

    assert np.allclose(Rotation.from_rotvec(angle * z[0]).apply(first[0]), second[0], atol=1e-12)


# --- solutions ----------------------------------------------------------------------------------


@pytest.mark.parametrize("family", FAMILIES)
def test_calibrated_arms_have_whole_solutions_too(family: str) -> None:
    """Away from singularities every configuration is found, and reaches its pose."""
    robot = bent_tools.robot(calibrated.urdf("ur5e"))
    kinematics = TurnedKinematics(FAMILIES[family], robot, FILES, Turn(along=(1, 0, 0)))
    q = np.random.default_rng(8).uniform(-np.pi, np.pi, (60, 6))
    poses = forward(robot, q)
    q = q[task_determinant(*tip_jacobian(poses), poses.tool_axis, GIVEN_TURN) > 0.01]
    assert len(q) > 20
    for row, own in enumerate(found(kinematics.solve_pose(*tip_frames(robot.model, q)))):
        assert wrapped(own - q[row]).max(axis=1).min() < 1e-6
        pose = tip_frame(robot.model, q[row])
        for each in own:
            off = tip_frame(robot.model, each).homogeneous - pose.homogeneous
            assert np.abs(off).max() < 3e-9


@pytest.mark.parametrize(
    ("tool", "count"),
    [*((tool, 40) for tool in TOOLS), pytest.param("bent", 5000, marks=pytest.mark.slow)],
)
@pytest.mark.parametrize(("family", "arm"), [*ARMS, ("eaik", "irb120")])
def test_the_same_whole_solutions_as_ssik(family: str, arm: str, tool: str, count: int) -> None:
    pytest.importorskip("ssik")
    from solution_sets import Ssik  # only here: ssik may be missing

    robot, kinematics = made(family, arm, tool)
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (count, 6))
    poses, theirs_of, solutions = tip_frames(robot.model, q), Ssik(robot), 0
    for ours, *pose in zip(found(kinematics.solve_pose(*poses)), *poses, strict=True):
        assert set_distance(ours, theirs_of.whole_solutions(*pose)) < 1e-5
        solutions += len(ours)
    assert solutions >= 3.7 * count


def test_only_one_branch_is_the_same_as_all_of_them() -> None:
    for family, arm in ARMS:
        robot, kinematics = made(family, arm, "bent")
        q = np.random.default_rng(3).uniform(-np.pi, np.pi, (40, 6))
        poses = tip_frames(robot.model, q)
        branches = np.random.default_rng(4).integers(0, 8, 40)
        one = kinematics.solve_pose(*poses, branches)
        assert one.shape == (40, 1, 6)
        every = kinematics.solve_pose(*poses)
        assert np.array_equal(one[:, 0], every[np.arange(40), branches], equal_nan=True)


@pytest.mark.parametrize(("family", "arm"), ARMS)
def test_a_branch_keeps_its_name_where_the_determinant_is_not_zero(family: str, arm: str) -> None:
    """From a configuration to one beside it, both well away from all singularities."""
    robot, kinematics = made(family, arm, "bent")
    random = np.random.default_rng(21)
    q = random.uniform(-np.pi, np.pi, (300, 6))
    names = []
    for joints in (q, q + random.uniform(-1e-3, 1e-3, q.shape)):
        every = kinematics.solve_pose(*tip_frames(robot.model, joints))
        off = np.where(np.isnan(every), np.inf, wrapped(every - joints[:, None])).max(axis=2)
        assert off.min(axis=1).max() < 1e-5
        names.append(off.argmin(axis=1))
    poses = forward(robot, q)
    clear = task_determinant(*tip_jacobian(poses), poses.tool_axis, GIVEN_TURN) > 0.01
    assert clear.sum() > 100
    assert (names[0] == names[1])[clear].all()


# --- conditioning -------------------------------------------------------------------------------


@pytest.mark.parametrize(("family", "arm"), ARMS)
def test_reach_is_what_no_configuration_exceeds(family: str, arm: str) -> None:
    robot, kinematics = made(family, arm, "bent")
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (20_000, 6))
    far = np.linalg.norm(forward(robot, q).tip - kinematics.viewpoints[0], axis=1).max()
    assert 0.97 * kinematics.reach < far <= kinematics.reach


# --- the set of turns ---------------------------------------------------------------------------


def test_each_turn_of_a_set_has_its_own_branches() -> None:
    robot, own = made("ur", "ur5e", "bent")
    points = np.array([[0.4, 0.1, 0.2], [0.3, -0.3, 0.3]])
    down = np.tile([0.0, 0.0, -1.0], (2, 1))
    rule = Turn(along=(1, 0, 0), turns_deg=(0.0, 90.0, -45.0))
    several = TurnedKinematics(UrKinematics, robot, FILES, rule)
    assert len(several.branches) == len(set(several.branches)) == 24
    assert several.branches[0] == "turn 0° shoulder-left elbow-up wrist-unflipped"
    assert several.branches[8] == "turn 90° shoulder-left elbow-up wrist-unflipped"
    assert several.branches[16] == "turn -45° shoulder-left elbow-up wrist-unflipped"
    every = several.solve(points, down)
    # About a tool that points down, 90 degrees lead from x to -y as seen in the world.
    half = math.sqrt(0.5)
    for number, x in enumerate([(1, 0, 0), (0, -1, 0), (half, half, 0)]):
        expected = own.solve_pose(points, down, np.tile(np.array(x, dtype=float), (2, 1)))
        part = every[:, 8 * number : 8 * number + 8]
        assert np.allclose(part, expected, atol=1e-9, equal_nan=True)
        for branch in range(8):
            one = several.solve(points, down, np.full(2, 8 * number + branch))
            assert np.allclose(one[:, 0], expected[:, branch], atol=1e-9, equal_nan=True)
    assert own.branches == UR_BRANCHES


# --- refusals -----------------------------------------------------------------------------------
