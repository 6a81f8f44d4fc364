"""The same questions to Pinocchio for the arm, and to coal (in :mod:`world`) for contacts."""

from __future__ import annotations

from collections.abc import Sequence

import coal
import numpy as np
import pinocchio as pin
from reasons import Reason
from world import PAIRS, World

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import (
    forward,
    manipulability,
    static_torques,
    task_determinant,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import Setup

CONTACT = 0.0005  # m; verdicts may differ nearer to contact than this
Standing = Sequence[tuple[coal.ShapeBase, coal.Transform3s]]


def wrapped(angle: Array) -> Array:
    """Size of an angle modulo 2 pi."""
    return np.abs(np.remainder(angle + np.pi, 2 * np.pi) - np.pi)


def shorter_way(first: Array, second: Array) -> tuple[Array, Array]:
    """How far each joint gets below and above where it starts, on the shorter way, rad."""
    step = np.remainder(second - first + np.pi, 2 * np.pi) - np.pi
    return np.minimum(step, 0), np.maximum(step, 0)


def kinematics_apart(robot: Robot, joints: Array, torques: bool = True) -> float:
    """The largest difference from Pinocchio in poses, Jacobian, torques and both measures.

    Args:
        torques: whether those that gravity and a push of 20 N need are compared as well.
    """
    gravity, task, poses = np.array([0.3, -1.0, -9.81]), robot.task, forward(robot, joints)
    linear, angular = poses.jacobian
    volume = manipulability(poses, task)
    determinant = task_determinant(poses, task)
    gravity_alone = static_torques(robot, poses, gravity, 0.0)
    pressed = static_torques(robot, poses, gravity, 20.0)
    model, data = robot.model, robot.model.createData()
    model.gravity.linear = gravity
    tip, around = model.getFrameId("tool_tip"), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    moved = [0, 1, 2] if task.lengths == 3 else [0, 1]
    rows = [*moved, *([3, 4] if task.direction else []), *([5] if task.turn else [])]
    worst = [0.0]
    for row, q in enumerate(joints):
        jacobian = pin.computeFrameJacobian(model, data, q, tip, around)
        pin.framesForwardKinematics(model, data, q)
        there = data.oMf[tip]
        # The directions that a task asks for are those of the tool's own frame.
        own = np.vstack([jacobian[:3], there.rotation.T @ jacobian[3:]])[:, : task.joints]
        pairs = [
            (poses.tip[row], there.translation),
            (poses.tool_axis[row], there.rotation[:, 2]),
            (np.vstack([linear[row], angular[row]]), jacobian),
            (volume[row], np.linalg.svd(own[moved], compute_uv=False).prod()),
            (determinant[row], abs(np.linalg.det(own[rows]))),
        ]
        if torques:
            still = pin.computeGeneralizedGravity(model, data, q)
            push = jacobian[:3].T @ (20.0 * there.rotation[:, 2])
            pairs += [
                (gravity_alone[row], still),
                (pressed[row], still + push),
            ]
        worst += [float(np.abs(ours - theirs).max()) for ours, theirs in pairs]
    return max(worst)


def arm_reason(robot: Robot, setup: Setup, q: Array) -> Reason:
    """The first test of the arm alone that a configuration fails."""
    model, data = robot.model, robot.model.createData()
    if np.isnan(q).any():
        return Reason.NO_SOLUTION
    if (q < robot.lower).any() or (q > robot.upper).any():
        return Reason.JOINT_LIMITS
    tip = model.getFrameId("tool_tip")
    jacobian = pin.computeFrameJacobian(model, data, q, tip, pin.ReferenceFrame.LOCAL)
    # In the tip's own frame the push is along z, and turning about z is the free direction.
    torque = pin.computeGeneralizedGravity(model, data, q)
    torque = torque + setup.task.normal_force_n * jacobian[2]
    if (np.abs(torque) > robot.effort).any():
        return Reason.TORQUE
    volume = np.linalg.svd(jacobian[:3, :5], compute_uv=False).prod()
    if volume < setup.thresholds.min_manipulability_m3:
        return Reason.MANIPULABILITY
    if abs(np.linalg.det(jacobian[:5, :5])) < setup.thresholds.min_task_determinant_m3:
        return Reason.TASK_DETERMINANT
    return Reason.VALID


def clearances(
    world: World, setup: Setup, ground: float, q: Array, obstacles: Standing = ()
) -> dict[Reason, float]:
    """Signed distances (m) of a configuration to all that it could hit, in the order of tests.

    The object is a shell and has no depths: what touches it is at minus infinity.
    """
    world.place(q)
    found = {
        Reason.GROUND: world.to_ground(ground, setup.robot.may_touch_ground),
        Reason.SELF_COLLISION: world.to_itself(PAIRS),
    }
    if obstacles:
        found[Reason.OBSTACLE_COLLISION] = min(world.to_solid(*each) for each in obstacles)
    outside = world.to_object()
    return found | {Reason.OBJECT_COLLISION: outside if outside > 0 else -np.inf}


def possible_reasons(first: Reason, distances: dict[Reason, float]) -> set[Reason]:
    """Reasons that may come out; more than one where a contact is too close to call.

    Args:
        first: of :func:`arm_reason`.
        distances: of :func:`clearances`.
    """
    if first is not Reason.VALID:
        return {first}
    possible = set()
    for reason, distance in distances.items():
        if abs(distance) <= CONTACT:
            possible.add(reason)
        elif distance <= 0:
            return possible | {reason}
    return possible | {Reason.VALID}
