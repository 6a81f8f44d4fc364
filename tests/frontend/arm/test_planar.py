"""Planar arms: solutions, names and measures against Pinocchio, a SCARA's scene, refusals."""

from __future__ import annotations

import dataclasses
from functools import partial

import dh_arms
import numpy as np
import pinocchio as pin
import pytest
from bent_tools import BENT, tip_frame, tip_frames, tool
from hypothesis import given
from hypothesis import strategies as st
from independent import wrapped
from refused_setups import refused_setup
from shipped import ROBOTS, TOP
from vertex_minima import vertex_minimum

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.candidate_table import VALID
from cellcolor.errors import InputError
from cellcolor.frontend import Scene, Setup, build_surface
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.loading import load_robot
from cellcolor.frontend.arm.planar import PlanarThree, PlanarTwo
from cellcolor.frontend.arm.robot import FREE_IN_PLANE, GIVEN_IN_PLANE, Robot
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.arm.urdf import parse_urdf
from cellcolor.frontend.setup import RobotFiles, Turn
from examples import examples

FILES = RobotFiles(arm_urdf="<", flange_link="flange", tool_urdf="<", tip_link="tool_tip")
SCENE = TOP / "instances" / "planar" / "kr6_r700_z200_plate.toml"
FLIP = np.diag([1.0, -1.0, -1.0])


def turn_z(angle: float) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])


def arm(lengths: list[float], zeros: list[float], flips: list[bool]) -> str:
    """URDF of an arm with parallel axes, each up or down, at heights that differ; flange down."""
    steps, before = [], np.eye(3)
    for length, zero, flipped in zip([0.0, *lengths], zeros, flips, strict=True):
        own = turn_z(zero) @ (FLIP if flipped else np.eye(3))
        step = np.eye(4)
        step[:3, :3] = before.T @ own
        step[:3, 3] = before.T @ np.array([length, 0.0, 0.07])
        steps.append(step)
        before = FLIP if flipped else np.eye(3)
    last = np.eye(4)
    last[:3, :3] = before.T @ FLIP
    return dh_arms.urdf_of([*steps, last])


def two(lengths: list[float], zeros: list[float], flips: list[bool]) -> Robot:
    """A tool straight down, out at the end of the second link."""
    fixed = parse_urdf(tool((f"{lengths[1]} 0 0.1", "0 0 0")), "tool.urdf")
    whole = parse_urdf(arm(lengths[:1], zeros[:2], flips[:2]), "arm.urdf")
    robot = load_robot(whole, "flange", fixed, "tool_tip", 2)
    return dataclasses.replace(robot, task=FREE_IN_PLANE)


def three(lengths: list[float], zeros: list[float], flips: list[bool]) -> Robot:
    """A tool beside the third axis, turned about it by something."""
    beside = parse_urdf(tool(("0.03 -0.02 0.1", "0 0 0.8")), "tool.urdf")
    whole = parse_urdf(arm(lengths, zeros, flips), "arm.urdf")
    robot = load_robot(whole, "flange", beside, "tool_tip", 3)
    return dataclasses.replace(robot, task=GIVEN_IN_PLANE)


lengths = st.lists(st.floats(0.1, 0.5), min_size=2, max_size=2)
zeros = st.lists(st.floats(-3, 3), min_size=3, max_size=3)
flips = st.lists(st.booleans(), min_size=3, max_size=3)
angles = st.lists(st.floats(-3.1, 3.1), min_size=3, max_size=3)


@given(lengths, zeros, flips, angles)
@examples(30)
def test_every_configuration_is_among_the_solutions_of_its_pose(
    lengths: list[float], zeros: list[float], flips: list[bool], q: list[float]
) -> None:
    """Of both families; poses are Pinocchio's, and all solutions reach them."""
    robot = two(lengths, zeros, flips)
    joints = np.array([q[:2]])
    tips, directions, _ = tip_frames(robot.model, joints)
    _hold(robot, joints, PlanarTwo(robot, FILES).solve(tips, directions)[0])
    robot = three(lengths, zeros, flips)
    kinematics = TurnedKinematics(PlanarThree, robot, FILES, Turn(along=(1, 0, 0)))
    joints = np.array([q])
    _hold(robot, joints, kinematics.solve_pose(*tip_frames(robot.model, joints))[0])


def _hold(robot: Robot, joints: Array, found: Array) -> None:
    assert found.shape == (2, robot.joints) and not np.isnan(found).any()
    # At a straight elbow both branches meet, and half of the digits are lost.
    assert wrapped(found - joints).max(axis=1).min() < 1e-6
    pose = tip_frame(robot.model, joints[0])
    for each in found:
        reached = tip_frame(robot.model, each)
        off = np.abs(reached.homogeneous - pose.homogeneous)
        assert off[:3, 3].max() < 1e-9
        # The turn of the tool is asked for with three joints only; with two it follows.
        assert off.max() < (1e-9 if robot.joints == 3 else 2.1)


@given(lengths, zeros, flips, angles)
@examples(30)
def test_the_elbow_is_where_its_name_says(
    lengths: list[float], zeros: list[float], flips: list[bool], q: list[float]
) -> None:
    robot = two(lengths, zeros, flips)
    kinematics = PlanarTwo(robot, FILES)
    tips, directions, _ = tip_frames(robot.model, np.array([q[:2]]))
    for name, each in zip(kinematics.branches, kinematics.solve(tips, directions)[0], strict=True):
        data = robot.model.createData()
        pin.forwardKinematics(robot.model, data, each)
        shoulder, elbow = (data.oMi[k].translation[:2] for k in (1, 2))
        chord, beside = tips[0, :2] - shoulder, elbow - shoulder
        left = chord[0] * beside[1] - chord[1] * beside[0]  # the tool comes from above
        assert abs(left) < 1e-6 or (left > 0) == (name == "elbow-left")


def test_only_points_in_the_plane_have_solutions() -> None:
    robot = two([0.4, 0.3], [0, 0, 0], [False, False, False])
    kinematics = PlanarTwo(robot, FILES)
    tips, directions, _ = tip_frames(robot.model, np.array([[0.3, 1.2]]))
    for off, there in ((0.9e-4, True), (-0.9e-4, True), (1.1e-4, False), (-1.1e-4, False)):
        found = kinematics.solve(tips + np.array([0, 0, off]), directions)
        assert np.isnan(found).all() != there
    for degrees, there in ((0.09, True), (0.11, False), (180.0, False)):
        tilted = np.array([[np.sin(np.radians(degrees)), 0, -np.cos(np.radians(degrees))]])
        assert np.isnan(kinematics.solve(tips, tilted)).all() != there
    far = kinematics.solve(np.array([[0.71, 0, tips[0, 2]], [0.05, 0, tips[0, 2]]]), directions)
    assert np.isnan(far).all()


@pytest.mark.parametrize("make", [two, three])
def test_measures_are_areas_of_the_motion_in_the_plane(make: type) -> None:
    """Against differences of Pinocchio's poses."""
    robot: Robot = make([0.4, 0.3], [0.3, -0.4, 0.2], [False, True, False])
    random = np.random.default_rng(4)
    q = random.uniform(-np.pi, np.pi, (30, robot.joints))
    poses, step = forward(robot, q), 1e-6
    linear, angular = tip_jacobian(poses)
    determinants = task_determinant(linear, angular, poses.tool_axis, robot.task)
    areas = manipulability(linear, robot.task)
    for row, joints in enumerate(q):
        columns = []
        for shift in step * np.eye(robot.joints):
            after, before = (tip_frame(robot.model, joints + s) for s in (shift, -shift))
            moved = (after.translation - before.translation)[:2] / (2 * step)
            turned = (after.rotation @ before.rotation.T)[1, 0] / (2 * step)
            columns.append([*moved, turned][: robot.joints])
        jacobian = np.array(columns).T
        assert determinants[row] == pytest.approx(abs(np.linalg.det(jacobian)), abs=1e-7)
        sizes = np.linalg.svd(jacobian[:2], compute_uv=False)
        assert areas[row] == pytest.approx(sizes.prod(), abs=1e-7)


@pytest.mark.parametrize("joints", [2, 3])
def test_reach_is_what_no_configuration_exceeds(joints: int) -> None:
    values = [0.4, 0.3], [0.1, 0.2, 0.3], [False, True, False]
    kinematics: InverseKinematics
    if joints == 2:
        robot = two(*values)
        kinematics = PlanarTwo(robot, FILES)
    else:
        robot = three(*values)
        kinematics = TurnedKinematics(PlanarThree, robot, FILES, Turn(along=(1, 0, 0)))
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (20_000, joints))
    far = np.hypot(*forward(robot, q).tip[:, :2].T).max()
    assert 0.99 * kinematics.reach < far <= kinematics.reach + 1e-12


# --- the SCARA ----------------------------------------------------------------------------------


def test_the_scara_is_solved_from_its_urdf_to_a_proven_minimum() -> None:
    """On a coarse mesh a search through all colorings of the vertices has the same minimum."""
    scene = Scene.read(SCENE).varied(object={"target_vertices": 60})
    result = build_surface(scene)
    valid = np.argwhere(result.reasons == VALID)
    assert len(valid) > 60 and result.branches == ("elbow-left", "elbow-right")
    for vertex, branch in valid[::5]:
        pose = tip_frame(result.robot.model, result.configurations[vertex, branch])
        assert np.abs(pose.translation - result.surface.vertices[vertex]).max() < 1e-9
        assert np.abs(pose.rotation - FLIP).max() < 1e-9  # x along x, z down
    found = cellcolor.solve(result)
    assert found.optimal and found.solution.proved_for_surface
    assert found.segments == vertex_minimum(result.surface) == 2


def test_lengths_and_ranges_of_the_scara_are_those_that_are_published() -> None:
    """425 and 275 mm, 700 in all; 170, 145 and 360 degrees; a stroke of 200 mm downwards."""
    robot = build_surface(Scene.read(SCENE).varied(object={"target_vertices": 20})).robot
    poses = forward(robot, np.zeros((1, 3)))
    assert np.diff(poses.origin[0, 1:, 0]) == pytest.approx([0.425, 0.275])
    assert np.degrees(robot.upper) == pytest.approx([170, 145, 360])
    assert np.degrees(robot.lower) == pytest.approx([-170, -145, -360])
    setup = Setup.read(ROBOTS / "kr6_r700_z200.toml")
    with pytest.raises(InputError, match="outside the joint's limits, 0 to"):
        build_surface(
            Scene.read(SCENE).with_setup(setup.varied(robot={"fixed_joints": {"joint_3": 0.21}}))
        )


def test_two_joints_do_where_the_turn_is_free() -> None:
    """The fourth joint stands still: the same elbows, and the tool's turn follows from them."""
    whole = Scene.read(SCENE).varied(object={"target_vertices": 60})
    fixed = {"joint_3": 0.16, "joint_4": 0.5}
    robot = {"kinematics": "planar-2r", "fixed_joints": fixed}
    setup = whole.setup.varied(robot=robot, task={"turn": None})
    result, other = build_surface(whole.with_setup(setup)), build_surface(whole)
    assert np.array_equal(result.reasons, other.reasons)
    assert np.allclose(
        result.configurations, other.configurations[..., :2], atol=1e-9, equal_nan=True
    )
    assert cellcolor.solve(result).segments == 2


# --- refusals -----------------------------------------------------------------------------------

refused = partial(refused_setup, SCENE)


def test_three_joints_and_a_free_turn_are_redundant() -> None:
    error = refused(task={"turn": None})
    assert error.field == "robot.kinematics" and "redundant" in error.message
    assert "task.turn" in error.message and "planar-2r" in error.message


def test_a_given_turn_is_more_than_two_joints_can_do() -> None:
    fixed = {"joint_3": 0.16, "joint_4": 0.5}
    error = refused(robot={"kinematics": "planar-2r", "fixed_joints": fixed})
    assert error.field == "task.turn" and "3 dimensions" in error.message
    assert "2 joints" in error.message


def test_a_prismatic_joint_has_to_stand_still() -> None:
    error = refused(robot={"fixed_joints": {}})
    assert error.field == "joint[joint_3].type" and "fixed_joints" in error.message


@pytest.mark.parametrize(
    ("table", "key"),
    [
        ("thresholds", "min_manipulability"),
        ("thresholds", "min_task_determinant"),
        ("continuity", "near_singular_determinant"),
    ],
)
def test_thresholds_in_cubic_meters_are_refused(table: str, key: str) -> None:
    error = refused(**{table: {key: None, f"{key}_m3": 0.01}})
    assert error.field == f"{table}.{key}_m3" and key in error.message
    assert (error.file is not None and error.file.endswith("kr6_r700_z200.toml")) or not error.file


def test_arms_that_are_not_planar_are_refused() -> None:
    bent = parse_urdf(tool(BENT), "tool.urdf")
    whole = parse_urdf(arm([0.4], [0, 0], [False, False]), "arm.urdf")
    with pytest.raises(InputError, match="not parallel to the tool's z axis"):
        PlanarTwo(load_robot(whole, "flange", bent, "tool_tip", 2), FILES)
    straight = parse_urdf(tool(("0 0 0.1", "0 0 0")), "tool.urdf")
    with pytest.raises(InputError, match="no length") as caught:
        PlanarTwo(load_robot(whole, "flange", straight, "tool_tip", 2), FILES)
    assert caught.value.field == "joint[j2]"
