"""The same questions to other people's code: EAIK for inverse kinematics, Pinocchio for the
rest of the arm, coal (in :mod:`world`) for contacts."""

from __future__ import annotations

from collections.abc import Sequence

import coal
import numpy as np
import pinocchio as pin
from eaik.IK_HP import HPRobot
from reasons import Reason
from world import PAIRS, World

from cellcolor.arrays import Array
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import Setup

CONTACT = 0.0005  # m; verdicts may differ nearer to contact than this
SINGULAR = 1e-6  # m^3; two solutions with a smaller task determinant are about to meet
Standing = Sequence[tuple[coal.ShapeBase, coal.Transform3s]]


def wrapped(angle: Array) -> Array:
    """Size of an angle modulo 2 pi."""
    return np.abs(np.remainder(angle + np.pi, 2 * np.pi) - np.pi)


def shorter_way(first: Array, second: Array) -> tuple[Array, Array]:
    """How far each joint gets below and above where it starts, on the shorter way, rad."""
    step = np.remainder(second - first + np.pi, 2 * np.pi) - np.pi
    return np.minimum(step, 0), np.maximum(step, 0)


class Eaik:
    """EAIK's robot from Pinocchio's joint axes at zero."""

    def __init__(self, robot: Robot) -> None:
        data = robot.model.createData()
        jacobian = pin.computeJointJacobians(robot.model, data, np.zeros(6))
        origins = np.array([data.oMi[i].translation for i in range(1, 7)])
        steps = np.diff(origins, axis=0, prepend=np.zeros((1, 3)))
        self._robot = HPRobot(jacobian[3:].T, np.vstack([steps, np.zeros((1, 3))]))
        self._at_zero, self._tip = data.oMi[6].rotation, robot.tip[2, 3]

    def solutions(self, point: Array, direction: Array, roll: float) -> Array:
        """Joints 1 to 5 of all solutions; any roll about the tool must give the same.

        What EAIK marks as least squares does not reach the pose and is left out.
        """
        z = direction
        x = np.cross(z, np.eye(3)[np.argmin(np.abs(z))])
        x /= np.linalg.norm(x)
        x = np.cos(roll) * x + np.sin(roll) * np.cross(z, x)
        pose = np.eye(4)
        pose[:3, :3] = np.column_stack([x, np.cross(z, x), z]) @ self._at_zero.T
        pose[:3, 3] = point - self._tip * z
        answer = self._robot.IK(pose)
        exact = ~np.array(answer.is_LS, dtype=bool)
        return np.array(answer.Q).reshape(-1, 6)[exact][:, :5]


def set_distance(first: Array, second: Array) -> float:
    """How far two sets of joint angles (k, 5) are apart, rad modulo 2 pi; of one size only."""
    if len(first) != len(second):
        return float("inf")
    if not len(first):
        return 0.0
    gap = wrapped(first[:, None] - second[None]).max(axis=2)
    return float(max(gap.min(axis=0).max(), gap.min(axis=1).max()))


def regular(robot: Robot, five: Array) -> Array:
    """Those of some joint angles (k, 5) that are not next to a singularity of the task."""
    model, data = robot.model, robot.model.createData()
    tip = model.getFrameId("tool_tip")
    volumes = []
    for q in five:
        jacobian = pin.computeFrameJacobian(
            model, data, np.append(q, 0.0), tip, pin.ReferenceFrame.LOCAL
        )
        volumes.append(abs(np.linalg.det(jacobian[:5, :5])))
    return five[np.array(volumes, dtype=float) > SINGULAR]


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
