"""Kinematics, torques and conditioning against Pinocchio."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import (
    forward,
    gravity_torques,
    manipulability,
    static_torques,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot

GRAVITY = np.array([0.0, 0.0, -9.81])


@pytest.fixture(scope="module")
def joints(robot: Robot) -> Array:
    return np.random.default_rng(5).uniform(robot.lower, robot.upper, (300, 6))


def tip_pose(robot: Robot, q: Array) -> pin.SE3:
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    return data.oMf[robot.model.getFrameId("tool_tip")]


def test_poses(robot: Robot, joints: Array) -> None:
    poses = forward(robot, joints)
    data = robot.model.createData()
    for row, q in enumerate(joints):
        pin.forwardKinematics(robot.model, data, q)
        for frame in range(7):
            assert np.allclose(poses.origin[row, frame], data.oMi[frame].translation, atol=1e-9)
            assert np.allclose(poses.rotation[row, frame], data.oMi[frame].rotation, atol=1e-9)
        tip = tip_pose(robot, q)
        assert np.allclose(poses.tip[row], tip.translation, atol=1e-9)
        assert np.allclose(poses.tool_axis[row], tip.rotation[:, 2], atol=1e-9)


def test_jacobian(robot: Robot, joints: Array) -> None:
    linear, angular = tip_jacobian(forward(robot, joints))
    data, frame = robot.model.createData(), robot.model.getFrameId("tool_tip")
    for row, q in enumerate(joints):
        expected = pin.computeFrameJacobian(
            robot.model, data, q, frame, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        )
        assert np.allclose(linear[row], expected[:3], atol=1e-9)
        assert np.allclose(angular[row], expected[3:], atol=1e-9)


def test_gravity(robot: Robot, joints: Array) -> None:
    torques = gravity_torques(robot, forward(robot, joints), GRAVITY)
    data = robot.model.createData()
    for row, q in enumerate(joints):
        expected = pin.computeGeneralizedGravity(robot.model, data, q)
        assert np.allclose(torques[row], expected, atol=1e-9)


def test_static_torques_balance_the_surface_pushing_back(robot: Robot, joints: Array) -> None:
    poses = forward(robot, joints)
    linear, _ = tip_jacobian(poses)
    torques = static_torques(robot, poses, linear, GRAVITY, 20.0)
    data, still = robot.model.createData(), np.zeros(6)
    for row, q in enumerate(joints):
        # The reaction acts on the last link at the tip, against the tool's axis.
        at_tip = pin.Force(np.array([0, 0, -20.0]), np.zeros(3))
        in_joint = robot.model.frames[robot.model.getFrameId("tool_tip")].placement.act(at_tip)
        forces = pin.StdVec_Force()
        for _ in range(6):
            forces.append(pin.Force.Zero())
        forces.append(in_joint)
        expected = pin.rnea(robot.model, data, q, still, still, forces)
        assert np.allclose(torques[row], expected, atol=1e-9)


def test_manipulability_is_the_volume_of_the_velocity_ellipsoid(
    robot: Robot, joints: Array
) -> None:
    linear, _ = tip_jacobian(forward(robot, joints))
    singular_values = np.linalg.svd(linear[:, :, :5], compute_uv=False)
    assert np.allclose(manipulability(linear), singular_values.prod(axis=1), atol=1e-12)


def test_task_determinant_against_finite_differences(robot: Robot, joints: Array) -> None:
    poses = forward(robot, joints[:60])
    found = task_determinant(*tip_jacobian(poses), poses.tool_axis)
    step = 1e-6
    for row, q in enumerate(joints[:60]):
        pose = tip_pose(robot, q)
        columns = []
        for joint in range(5):
            shift = np.eye(6)[joint] * step
            ahead, behind = tip_pose(robot, q + shift), tip_pose(robot, q - shift)
            moved = (ahead.translation - behind.translation) / (2 * step)
            turned = (ahead.rotation[:, 2] - behind.rotation[:, 2]) / (2 * step)
            columns.append(np.concatenate([moved, pose.rotation[:, :2].T @ turned]))
        assert found[row] == pytest.approx(abs(np.linalg.det(np.array(columns))), abs=1e-7)


def test_only_the_determinant_sees_the_aligned_wrist(robot: Robot) -> None:
    poses = forward(robot, np.array([[0.3, -1.2, 1.4, -0.9, 0.0, 0.0]]))
    linear, angular = tip_jacobian(poses)
    assert manipulability(linear)[0] > 0.01
    assert task_determinant(linear, angular, poses.tool_axis)[0] < 1e-12
