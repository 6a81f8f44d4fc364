"""Arms whose axes are a little off the ideal ones: no solution is lost, and names stay."""

from __future__ import annotations

import calibrated
import dh_arms
import numpy as np
import pytest
from arm_plates import plate
from independent import wrapped
from solution_sets import Arm, from_many_starts

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.calibrated import (
    Axes,
    NearIdeal,
    both_sides_of_folds,
    idealized,
    missing,
)
from cellcolor.frontend.arm.eaik import EaikKinematics
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import forward, task_determinant, tip_jacobian
from cellcolor.frontend.arm.newton import nearest
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.ur import BRANCHES, UrKinematics
from cellcolor.frontend.setup import RobotFiles

pytestmark = pytest.mark.slow

LOCKED = 0.4
ARMS = (("ur", "ur5e"), ("eaik", "ur5e"), ("eaik", "kr6"), ("eaik", "puma560"))


def family(kinematics: str, text: str) -> tuple[Robot, InverseKinematics]:
    robot = dh_arms.robot(text)
    files = RobotFiles(
        arm_urdf="<",
        flange_link="flange",
        tool_urdf="<",
        tip_link="tool_tip",
        locked_joint_6_rad=LOCKED,
    )
    return robot, {"ur": UrKinematics, "eaik": EaikKinematics}[kinematics](robot, files)


def volumes(robot: Robot, q: Array) -> Array:
    poses = forward(robot, q)
    return task_determinant(*tip_jacobian(poses), poses.tool_axis)


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
    assert (found[rows, branches, 5] == LOCKED).all()
    # The configuration that the pose was made of is there if it passes the shipped setup's
    # threshold on conditioning, or a tenth of it for a usual calibration.
    near = np.where(np.isnan(found), np.inf, wrapped(found - q[:, None]))[:, :, :5].max(axis=2)
    regular = volumes(robot, q) > (1e-3 if scale > 1 else 1e-4)
    assert regular.sum() > 850 and near.min(axis=1)[regular].max() < 1e-6


@pytest.mark.parametrize(("kinematics", "name"), ARMS)
def test_nothing_else_is_found_from_many_other_starts(kinematics: str, name: str) -> None:
    one = Arm(*family(kinematics, calibrated.urdf(name)))
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (12, 6))
    poses = forward(one.robot, q)
    others = from_many_starts(one.robot, poses.tip, poses.tool_axis, 150, 4)
    assert one.held_against(others, q).different == 0


@pytest.mark.parametrize(("kinematics", "name"), ARMS)
def test_solutions_of_either_sign_are_equally_many(kinematics: str, name: str) -> None:
    robot, arm = family(kinematics, calibrated.urdf(name))
    poses = forward(robot, np.random.default_rng(6).uniform(-np.pi, np.pi, (1000, 6)))
    found = arm.solve(poses.tip, poses.tool_axis)
    # But for a few next to a singularity.
    assert np.count_nonzero(missing(robot, found)) <= 5
    # One taken away is missed.
    first = np.argmin(np.isnan(found[:, :, 0]), axis=1)
    found[np.arange(1000), first] = np.nan
    assert np.count_nonzero(missing(robot, found)) >= 990


@pytest.mark.parametrize(("kinematics", "name"), ARMS)
def test_a_branch_alone_is_the_same_as_among_all(kinematics: str, name: str) -> None:
    robot, arm = family(kinematics, calibrated.urdf(name))
    random = np.random.default_rng(7)
    poses = forward(robot, random.uniform(-np.pi, np.pi, (300, 6)))
    branches = random.integers(0, 8, 300)
    every = arm.solve(poses.tip, poses.tool_axis)[np.arange(300), branches]
    alone = arm.solve(poses.tip, poses.tool_axis, branches)
    assert alone.shape == (300, 1, 6)
    assert (np.isnan(alone[:, 0]) == np.isnan(every)).all()
    regular = volumes(robot, np.nan_to_num(every)) > 1e-4
    assert np.nanmax(wrapped(alone[:, 0] - every)[regular]) < 1e-6


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


def test_frames_far_out_on_nearly_parallel_axes_say_nothing() -> None:
    """A calibration may put the frame of a joint hundreds of metres along its axis."""
    placements = [np.eye(4), *dh_arms.steps_of(dh_arms.ARMS["ur5e"])]
    near = calibrated.perturbed(placements, 1e-3, 5e-4, 1)
    far = [each.copy() for each in near]
    out = np.eye(4)
    out[2, 3] = 300.0
    far[2] = near[2] @ out  # the frame of joint 3, and back before the next one
    far[3] = np.linalg.inv(out) @ near[3]
    arms = [family("ur", dh_arms.urdf_of(each)) for each in (near, far)]
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (200, 6))
    poses = forward(arms[0][0], q)
    first, second = (arm.solve(poses.tip, poses.tool_axis) for _, arm in arms)
    assert np.nanmax(wrapped(first - second)) < 1e-6
    assert (np.isnan(first) == np.isnan(second)).mean() > 0.999


def test_the_ideal_axes_are_parallel_and_meet() -> None:
    robot = dh_arms.robot(calibrated.urdf("kr6"))
    poses = forward(robot, np.zeros((1, 6)))
    axes = Axes(poses.axis[0], poses.origin[0, 1:])
    ideal = idealized(axes, 0.01)
    assert np.allclose(ideal.directions[1], ideal.directions[2], atol=1e-15)
    # The wrist's three axes go through one point.
    for k in (3, 4):
        apart = np.cross(ideal.points[5] - ideal.points[k], ideal.directions[k])
        assert np.linalg.norm(apart) < 1e-12
    angle, distance = ideal.off(axes)
    assert 1e-4 < angle < 5e-3 and 1e-5 < distance < 5e-3


def test_both_sides_of_a_fold_are_tried() -> None:
    robot = dh_arms.robot(dh_arms.urdf("kr6"))
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (2, 1, 6))
    q[0, 0, 4] = 0.0  # the wrist is aligned
    q[1, 0] = np.nan
    tried = both_sides_of_folds(robot, q)
    assert tried.shape == (2, 3, 6) and np.isnan(tried[1]).all()
    sides = tried[0, 1:] - tried[0, 0]
    assert np.allclose(np.linalg.norm(sides, axis=1), 0.1) and np.allclose(sides[0], -sides[1])


class Given:
    """Signs that are told which name and which determinant each solution has."""

    def branches(self, _: Robot, solutions: Array) -> tuple[Array, Array]:
        return np.array([2, 2, 2, 6, 2])[: len(solutions)], np.array([0.2, 0.3, 0.1, 0.5, 0.2])


def test_two_of_the_same_signs_have_names_as_long_as_there_are_any() -> None:
    """Three by the name 2, and one by 6; the last is the first one again."""
    robot = dh_arms.robot(dh_arms.urdf("ur5e"))
    solutions = np.outer(np.arange(1.0, 6.0), np.full(6, 0.1))
    solutions[4] = solutions[0] + 2 * np.pi
    arm = NearIdeal(robot=robot, closed_form=lambda *_: solutions[None], off=(0.0, 0.0))
    (named,) = arm.named(solutions[None], Given())  # type: ignore[arg-type]
    assert np.flatnonzero(~np.isnan(named[:, 0])).tolist() == [1, 2, 6]
    # The largest determinant has the name, the next one that of the other elbow and wrist.
    assert (named[[2, 1, 6]] == solutions[[1, 0, 3]]).all()


def test_the_nearest_is_told_modulo_full_circles() -> None:
    solutions = np.array([[[0.0] * 6, [1.0] * 6, [np.nan] * 6]])
    others = np.array([[[2 * np.pi + 0.1] * 5 + [3.0], [np.nan] * 6]])
    assert np.allclose(nearest(solutions, others), [[0.1, 0.9, np.inf]])
    assert np.isinf(nearest(solutions, others[:, 1:])).all()
