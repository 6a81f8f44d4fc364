"""Families of arms, told by their inverse kinematics; a setup names one under ``[robot]``."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import Poses, farthest_reach, forward, nearest_points
from cellcolor.frontend.arm.robot import FREE_TURN, GIVEN_TURN, Robot, TaskSpace
from cellcolor.frontend.setup import RobotFiles
from cellcolor.frontend.tables import Registry


class InverseKinematics(ABC):
    """The inverse kinematics of one arm with its tool.

    A family is registered in ``KINEMATICS`` or by an entry point of the group
    ``cellcolor.kinematics``, under the name that setups have for it.

    Attributes:
        joints: how many joints the arms of the family have, between base and tip.
        prismatic: how many of these are prismatic; positions of these are in m wherever those of
            joints are in rad. The branches of such an arm have names.
        free_turn: what the task asks for if the tool's turn is free; None if the arm is redundant
            then.
        given_turn: the same if the turn is given; it may have more joints than the arm.
        branches: names of the branches. Along a motion without singularity the branch stays the
            same, and a pose has at most one solution of each. None, ``()``, where nothing but
            continuity tells the solutions of an arm apart.
        reach: the farthest that the tip gets from the arm's shoulder, joint limits aside, m;
            thresholds may be shares of its cube.
        lever: the farthest that turning the tool about its tip by one rad moves any joint's axis
            that has to give way, m per rad: the distance from the tip to the wrist.
        viewpoints: (v, 3) in the world, m; what none of them sees of an open mesh from the front
            probably has its outside inside.
    """

    joints: ClassVar[int]
    prismatic: ClassVar[int] = 0
    free_turn: ClassVar[TaskSpace | None] = FREE_TURN
    given_turn: ClassVar[TaskSpace] = GIVEN_TURN
    branches: tuple[str, ...]
    reach: float
    lever: float
    viewpoints: Array

    @abstractmethod
    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """From the arm as its files have it.

        Raises:
            InputError: the arm is not of this family, or a key of the setup does not fit it; names
                the joint or the key.
        """

    @abstractmethod
    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """All configurations that put the tip on a point with the tool along a direction.

        Args:
            points: (n, 3) tip positions in the world, m.
            directions: (n, 3) unit vectors from the flange to the tip; NaN where there is none, and
                there is no solution then.
            branches: (n,) the only one wanted of each point; all without it. A family without
                branches is never given any.

        Returns:
            (n, branches, joints), or (n, 1, joints) with ``branches``: angles in rad, NaN where a
            branch has no solution. Without branches (n, s, joints) in any order, each solution
            once, for an s of its own choice.
        """

    def taken(self, directions: Array) -> Array:
        """The directions that the tool takes where some are asked for, (n, 3).

        These themselves, but with a task that does not ask for the direction; NaN where the tool
        would come from behind.
        """
        return directions

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:  # noqa: ARG002
        """What a user should know of the solutions for some poses, a sentence each; nothing here.

        Args:
            points, directions: (n, 3) each, of all that is asked; see :meth:`solve`.
        """
        return ()


KINEMATICS: Registry[InverseKinematics] = Registry(
    "cellcolor.kinematics",
    InverseKinematics,  # type: ignore[type-abstract]
    {
        "ur": "cellcolor.frontend.arm.ur:UrKinematics",
        "eaik": "cellcolor.frontend.arm.eaik:EaikKinematics",
        "offset-wrist": "cellcolor.frontend.arm.offset_wrist:OffsetWrist",
        "planar-2r": "cellcolor.frontend.arm.planar:PlanarTwo",
        "planar-3r": "cellcolor.frontend.arm.planar:PlanarThree",
        "scara": "cellcolor.frontend.arm.planar:Scara",
        "scara-rrp": "cellcolor.frontend.arm.planar:ScaraWithoutTurn",
    },
)


_TOLERANCE = 1e-6  # m and rad


def check_lever(robot: Robot, files: RobotFiles, lever: float, arm: float) -> None:
    """Refuse a tool whose tip is farther from the wrist than an arm is long, both in m.

    Raises:
        InputError: names the link of the tip.
    """
    if lever > arm:
        message = f"the tool is longer than the arm: tip {lever:.3f} m from the wrist"
        raise InputError(str(robot.files[1]), f"link[{files.tip_link}]", message)


def pose_at_zero(robot: Robot) -> Poses:
    """Where everything is with all joints at zero, one configuration."""
    return forward(robot, np.zeros((1, robot.joints)))


def _tool_off_last_axis(poses: Poses) -> tuple[float, float]:
    """How far the tip is beside the last axis, m, and the sine of the tool's angle with it.

    Args:
        poses: of one configuration.
    """
    axis = poses.axis[0, -1]
    beside: Array = np.cross(poses.tip[0] - poses.origin[0, -1], axis)
    return float(np.linalg.norm(beside)), float(np.linalg.norm(np.cross(poses.tool_axis[0], axis)))


def is_tool_on_last_axis(robot: Robot) -> bool:
    """Whether turning the last joint moves neither the tip nor the tool's direction."""
    return max(_tool_off_last_axis(pose_at_zero(robot))) <= _TOLERANCE


class SixRevolute(InverseKinematics):
    """An arm of six revolute joints; joint 6, which the task leaves free, is locked."""

    joints = 6

    def __init__(self, robot: Robot, files: RobotFiles, kind: str) -> None:
        """The arm, and the angle of the locked joint.

        Args:
            kind: what an arm is not whose tool is beside the last axis, for the message.

        Raises:
            InputError: no angle inside the joint's limits is given, or the tool is not on the axis
                of the last joint.
        """
        locked = files.locked_joint_6_rad
        if locked is None:
            raise InputError(None, "robot.locked_joint_6_rad", "is missing")
        if not robot.lower[-1] <= locked <= robot.upper[-1]:
            message = "outside the limits of the sixth joint"
            raise InputError(None, "robot.locked_joint_6_rad", message)
        self._robot, self._locked, self._poses = robot, locked, pose_at_zero(robot)
        off, sine = _tool_off_last_axis(self._poses)
        if max(off, sine) > _TOLERANCE:
            message = (
                f"{kind}: the tool tip and its z axis must lie on this joint's axis, or the arm is "
                "redundant, since the tool's turn is free (the turn, or a finite set of turns, is "
                f"given under [task.turn]); the tip is {1e3 * off:.3g} mm off it, the axis "
                f"{np.degrees(np.arcsin(min(sine, 1.0))):.3g} degrees (mount_position_m and "
                "mount_rpy_rad under [robot] move the tool)"
            )
            raise robot.refused(-1, message)

    def _set_sizes(self, files: RobotFiles, directions: Array, points: Array) -> None:
        """Reach, lever and viewpoints of an arm with these axes; refused if the tool is too long.

        Args:
            directions, points: (6, 3) along the axes, and in m on them, all joints at zero.
        """
        lines = list(zip(points, directions, strict=True))
        shoulder = nearest_points(*lines[0], *lines[1])[0]
        wrist = nearest_points(*lines[5], *lines[4])[0]
        self.reach = farthest_reach(self._robot, shoulder)
        self.lever = float(np.linalg.norm(self._poses.tip[0] - wrist))
        check_lever(self._robot, files, self.lever, self.reach - self.lever)
        up = directions[0] * (-1.0 if directions[0, 2] < 0 else 1.0)
        self.viewpoints = np.array([shoulder, shoulder + (self.reach - self.lever) * up])
