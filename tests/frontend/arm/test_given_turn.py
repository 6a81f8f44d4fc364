"""Whole poses of the tool: rules for its turn, solutions and names."""

from __future__ import annotations

import math

import bent_tools
import calibrated
import numpy as np
import pytest
from bent_tools import ACROSS, BENT, STRAIGHT, tip_frame, tip_frames
from dh_arms import FILES
from hypothesis import given
from hypothesis import strategies as st
from independent import wrapped

from cellcolor.arrays import Array
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import forward, task_determinant
from cellcolor.frontend.arm.robot import GIVEN_TURN, Robot
from cellcolor.frontend.arm.turned import TurnedKinematics, turn_at
from cellcolor.frontend.arm.ur import UrKinematics
from cellcolor.frontend.setup import Turn

pytestmark = pytest.mark.second

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


# --- solutions ----------------------------------------------------------------------------------


@pytest.mark.parametrize("family", FAMILIES)
def test_calibrated_arms_have_whole_solutions_too(family: str) -> None:
    """Away from singularities every configuration is found, and reaches its pose."""
    robot = bent_tools.robot(calibrated.urdf("ur5e"))
    kinematics = TurnedKinematics(FAMILIES[family], robot, FILES, Turn(along=(1, 0, 0)))
    q = np.random.default_rng(8).uniform(-np.pi, np.pi, (60, 6))
    poses = forward(robot, q)
    q = q[task_determinant(poses, GIVEN_TURN) > 0.01]
    assert len(q) > 20
    for row, own in enumerate(found(kinematics.solve_pose(*tip_frames(robot.model, q)))):
        assert wrapped(own - q[row]).max(axis=1).min() < 1e-6
        pose = tip_frame(robot.model, q[row])
        for each in own:
            off = tip_frame(robot.model, each).homogeneous - pose.homogeneous
            assert np.abs(off).max() < 3e-9


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
    clear = task_determinant(poses, GIVEN_TURN) > 0.01
    assert clear.sum() > 100
    assert (names[0] == names[1])[clear].all()
