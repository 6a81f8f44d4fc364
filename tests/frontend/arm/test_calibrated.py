"""Arms whose axes are a little off the ideal ones: no solution is lost, and names stay."""

from __future__ import annotations

import calibrated
import dh_arms
import numpy as np
import pytest
from arm_plates import plate
from dh_arms import LOCKED
from independent import wrapped

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import forward, task_determinant
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import BRANCHES, UrKinematics

pytestmark = pytest.mark.slow

ARMS = (("ur", "ur5e"), ("eaik", "ur5e"), ("eaik", "kr6"), ("eaik", "puma560"))


def family(kinematics: str, text: str) -> tuple[Robot, InverseKinematics]:
    robot = dh_arms.robot(text)
    return robot, {"ur": UrKinematics, "eaik": EaikKinematics}[kinematics](robot, LOCKED)


def volumes(robot: Robot, q: Array) -> Array:
    poses = forward(robot, q)
    return task_determinant(poses)


@pytest.mark.parametrize(("kinematics", "name"), ARMS)
@pytest.mark.parametrize("scale", [0.1, 1.0, 3.0])
def test_no_solution_is_lost_and_all_are_exact(kinematics: str, name: str, scale: float) -> None:
    text = calibrated.urdf(name, angle=1e-3 * scale, distance=5e-4 * scale, seed=5)
    robot, arm = family(kinematics, text)
    assert len(arm.branches) == 8
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (1000, 6))
    poses = forward(robot, q)
    found = arm.solve(poses.tip, poses.tool_axis)
    rows, branches = np.nonzero(~np.isnan(found[:, :, 0]))
    reached = forward(robot, found[rows, branches])
    assert np.abs(reached.tip - poses.tip[rows]).max() < 1e-9
    assert np.abs(reached.tool_axis - poses.tool_axis[rows]).max() < 1e-9
    assert (found[rows, branches, 5] == LOCKED.locked_joint_6_rad).all()
    # The configuration that the pose was made of is there if it passes the shipped setup's
    # threshold on conditioning, or a tenth of it for a usual calibration.
    near = np.where(np.isnan(found), np.inf, wrapped(found - q[:, None]))[:, :, :5].max(axis=2)
    regular = volumes(robot, q) > (1e-3 if scale > 1 else 1e-4)
    assert regular.sum() > 850 and near.min(axis=1)[regular].max() < 1e-6


def test_names_are_those_of_the_ideal_arm() -> None:
    _, ideal = family("ur", dh_arms.urdf("ur5e"))
    robot, arm = family("ur", calibrated.urdf("ur5e"))
    assert arm.branches == BRANCHES
    q = np.random.default_rng(9).uniform(-np.pi, np.pi, (500, 6))
    poses = forward(robot, q)
    ours = arm.solve(poses.tip, poses.tool_axis)
    theirs = ideal.solve(poses.tip, poses.tool_axis)
    off = wrapped(ours - theirs)[:, :, :5].max(axis=2)
    clear = np.nan_to_num(volumes(robot, np.nan_to_num(ours).reshape(-1, 6)).reshape(500, 8))
    both = ~np.isnan(off) & (clear > 0.01)
    assert both.sum() > 1000 and off[both].max() < 0.1


def test_a_calibrated_arm_in_a_scene() -> None:
    exact = build_surface(plate(dh_arms.urdf("ur5e"), "ur"))
    result = build_surface(plate(calibrated.urdf("ur5e"), "ur"))
    assert result.surface.cracks == ()
    assert {color.branch for color in result.report.colors} == {
        color.branch for color in exact.report.colors
    }
    (remark,) = (text for text in result.report.warnings if text.startswith("calibrated arm"))
    assert "missing, by the signs of the task determinants: 0 at 0 of" in remark
    assert not any(text.startswith("calibrated") for text in exact.report.warnings)


def test_an_arm_too_far_off_is_refused() -> None:
    for kinematics, name in ARMS:
        with pytest.raises(InputError, match=r"UR-type|no closed form") as caught:
            family(kinematics, calibrated.urdf(name, angle=0.1, distance=0.05))
        assert "\n" not in str(caught.value)
