"""The last joint of six, which a tool on its axis leaves free and a setup locks.

With the tip on the last joint's axis and the tool along it, turning that joint moves neither the
tip nor the tool's direction: a task of five dimensions is solved by the other five joints.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.kinematics import Poses, forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import RobotFiles

_TOLERANCE = 1e-6  # m and rad
MUST_LIE = (
    "the tool tip and its z axis must lie on this joint's axis, or the arm is redundant, since the "
    "tool's turn is free (the turn, or a finite set of turns, is given under [task.turn])"
)
"""What a tool beside the last axis is refused with."""


def locked_angle(robot: Robot, files: RobotFiles) -> float:
    """The angle in rad at which a setup locks the last joint.

    Raises:
        InputError: there is none, or it is outside the joint's limits.
    """
    locked = files.locked_joint_6_rad
    if locked is None:
        raise InputError(None, "robot.locked_joint_6_rad", "is missing")
    if not robot.lower[-1] <= locked <= robot.upper[-1]:
        message = "outside the limits of the sixth joint"
        raise InputError(None, "robot.locked_joint_6_rad", message)
    return locked


def pose_at_zero(robot: Robot) -> Poses:
    """Where everything is with all joints at zero, one configuration."""
    return forward(robot, np.zeros((1, robot.joints)))


def is_tool_on_last_axis(poses: Poses) -> bool:
    """Whether turning the last joint moves neither the tip nor the tool's direction.

    Args:
        poses: of one configuration.
    """
    axis, tool = poses.axis[0, -1], poses.tool_axis[0]
    off: Array = np.cross(poses.tip[0] - poses.origin[0, -1], axis)
    return bool(max(np.linalg.norm(np.cross(tool, axis)), np.linalg.norm(off)) <= _TOLERANCE)


def check_tool_on_last_axis(robot: Robot, poses: Poses, kind: str) -> None:
    """Refuse a tool that is not on the axis of the last joint.

    Args:
        poses: of one configuration.
        kind: what the arm then is not, for the message.

    Raises:
        InputError: names the joint.
    """
    if is_tool_on_last_axis(poses):
        return
    axis, tool = poses.axis[0, -1], poses.tool_axis[0]
    off = 1e3 * np.linalg.norm(np.cross(poses.tip[0] - poses.origin[0, -1], axis))
    # Either sense of the axis will do.
    turned = np.degrees(np.arctan2(np.linalg.norm(np.cross(tool, axis)), abs(tool @ axis)))
    raise InputError(
        str(robot.files[0]),
        f"joint[{robot.joint_names[-1]}]",
        f"{kind}: {MUST_LIE}; the tip is {off:.3g} mm off it, the axis {turned:.3g} degrees "
        "(mount_position_m and mount_rpy_rad under [robot] move the tool)",
    )
