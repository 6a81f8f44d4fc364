"""Arms with an offset wrist: solutions against many starts and EAIK, refusals, and a whole plan."""

from __future__ import annotations

import dh_arms
import numpy as np
import pytest
from arm_plates import plate
from hypothesis import given
from hypothesis import strategies as st
from independent import wrapped
from shipped import ROBOTS
from solution_sets import Arm, from_many_starts

import cellcolor
from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.offset_wrist import OffsetWrist
from cellcolor.frontend.setup import RobotFiles

pytestmark = pytest.mark.slow

FILES = RobotFiles(
    arm_urdf="<",
    flange_link="flange",
    tool_urdf="<",
    tip_link="tool_tip",
    kinematics="offset-wrist",
    locked_joint_6_rad=0.4,
)
BUILT: dict[str, Arm] = {}


def arm(name: str) -> Arm:
    if name not in BUILT:
        robot = dh_arms.robot(dh_arms.urdf(name))
        BUILT[name] = Arm(robot, OffsetWrist(robot, FILES))
    return BUILT[name]


@pytest.mark.parametrize("count", [20, pytest.param(1000, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", dh_arms.OFFSET_WRISTS)
def test_the_same_solutions_as_from_many_starts(name: str, count: int) -> None:
    one, q = arm(name), np.random.default_rng(7).uniform(-np.pi, np.pi, (count, 6))
    poses = forward(one.robot, q)
    found = from_many_starts(one.robot, poses.tip, poses.tool_axis, 250, 8)
    compared = one.held_against(found, q)
    assert compared.different == 0
    assert compared.solutions > 6 * count


def test_solutions_where_the_wrist_passes_the_shoulder() -> None:
    """Two of twelve lie where the equation jumps: there joints 1 to 3 turn fast."""
    one = arm("crx10ia")
    q = np.array([[1.629821223, 1.849835247, 1.022817709, 1.180825568, -1.549104954, 2.125680380]])
    poses = forward(one.robot, q)
    every = from_many_starts(one.robot, poses.tip, poses.tool_axis, 250, 8)
    compared = one.held_against(every, q)
    assert (compared.different, compared.solutions) == (0, 12)


@given(
    name=st.sampled_from(dh_arms.OFFSET_WRISTS),
    q=st.lists(st.floats(-3.1, 3.1), min_size=5, max_size=5),
)
def test_a_configuration_is_among_the_solutions_of_its_pose(name: str, q: list[float]) -> None:
    one, own = arm(name), np.array([*q, 0.4])
    poses = forward(one.robot, own[None])
    (found,) = one.family.solve(poses.tip, poses.tool_axis)
    found = found[~np.isnan(found[:, 0])]
    again = forward(one.robot, found)
    assert np.abs(again.tip - poses.tip).max(initial=0) < 1e-8
    assert np.abs(again.tool_axis - poses.tool_axis).max(initial=0) < 1e-8
    if one.is_regular(own[None, :5])[0]:
        assert wrapped(found[:, :5] - own[:5]).max(axis=1).min() < 1e-5


def test_a_spherical_wrist_is_solved_as_by_eaik() -> None:
    """An offset of nothing is one as well, and EAIK knows a closed form for it."""
    robot = dh_arms.robot(dh_arms.urdf("irb120"))
    one, theirs = Arm(robot, OffsetWrist(robot, FILES)), EaikKinematics(robot, FILES)
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (30, 6))
    poses = forward(robot, q)
    every = theirs.solve(poses.tip, poses.tool_axis)
    sets: list[Array] = [each[~np.isnan(each[:, 0]), :5] for each in every]
    assert one.held_against(sets, q).different == 0


def test_an_arm_whose_second_and_third_axes_are_not_parallel_is_refused() -> None:
    with pytest.raises(InputError, match="not parallel to that of joint 2") as caught:
        OffsetWrist(dh_arms.robot(dh_arms.urdf("cuspidal")), FILES)
    assert caught.value.field == "joint[j3]"


@pytest.mark.slow
@pytest.mark.parametrize("name", ["xarm6", "gen3"])
def test_an_offset_wrist_is_driven_and_judged_like_other_arms(name: str) -> None:
    bare = plate(dh_arms.urdf(name), "offset-wrist", vertices=60)
    tool = {"tool_urdf": str(ROBOTS / "polishing_tool.urdf")}
    small = bare.varied(object={"size_x_m": 0.15, "size_y_m": 0.2})
    planned = cellcolor.plan(small.with_setup(small.setup.varied(robot=tool)))
    assert planned.verdict.valid
    assert planned.verdict.lift_offs == planned.solution.lift_offs
