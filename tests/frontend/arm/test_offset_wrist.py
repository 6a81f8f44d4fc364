"""Arms with an offset wrist: solutions against EAIK, refusals, and a whole plan."""

from __future__ import annotations

import dh_arms
import numpy as np
import pytest
from arm_plates import plate
from dh_arms import LOCKED
from independent import wrapped
from shipped import ROBOTS

import cellcolor
from cellcolor.errors import InputError
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.offset_wrist import OffsetWrist

pytestmark = pytest.mark.slow


def test_a_spherical_wrist_is_solved_as_by_eaik() -> None:
    """An offset of nothing is one as well, and EAIK knows a closed form for it."""
    robot = dh_arms.robot(dh_arms.urdf("irb120"))
    poses = forward(robot, np.random.default_rng(2).uniform(-np.pi, np.pi, (30, 6)))
    for ours, theirs in zip(
        OffsetWrist(robot, LOCKED).solve(poses.tip, poses.tool_axis),
        EaikKinematics(robot, LOCKED).solve(poses.tip, poses.tool_axis),
        strict=True,
    ):
        ours, theirs = (every[~np.isnan(every[:, 0])] for every in (ours, theirs))
        assert len(ours) == len(theirs)
        assert wrapped(ours[:, None] - theirs)[:, :, :5].max(axis=2).min(axis=1).max() < 1e-5


def test_an_arm_whose_second_and_third_axes_are_not_parallel_is_refused() -> None:
    with pytest.raises(InputError, match="not parallel to that of joint 2") as caught:
        OffsetWrist(dh_arms.robot(dh_arms.urdf("cuspidal")), LOCKED)
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
