"""Planar arms: two or three joints with parallel axes, and the tool along them.

A SCARA is one if its prismatic joint is fixed: it works at one height then (one that moves has a
family of its own, :mod:`cellcolor.frontend.arm.scara`). The tip moves in a plane across the tool,
so the part is flat and lies in that plane.

Tip and elbow make a triangle with the shoulder, which has two solutions: elbow left and elbow
right of the straight line from shoulder to tip, seen from where the tool comes from. The task
determinant is twice the triangle's area, so along a motion without singularity the elbow stays.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.last_joint import pose_at_zero
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.task_space import FREE_IN_PLANE, GIVEN_IN_PLANE, TaskSpace
from cellcolor.frontend.setup import RobotFiles

__all__ = ["PlanarThree", "PlanarTwo"]

_TOLERANCE = 1e-6  # m and rad; of the arm
_OFF_PLANE = 1e-4  # m; a point farther from the tip's plane is out of reach
_TILT = np.radians(0.1)  # the same of a direction
_ROUNDING = 1e-12  # how far a cosine may exceed 1 and still count as 1


class PlanarTwo(InverseKinematics):
    """Two parallel joints; the tool is fixed on the second one, and its turn follows."""

    joints = 2
    free_turn: ClassVar[TaskSpace | None] = FREE_IN_PLANE
    given_turn: ClassVar[TaskSpace] = GIVEN_IN_PLANE
    branches = ("elbow-left", "elbow-right")

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """The lengths of both links, and their angles with the joints at zero."""
        self._check_locked(files)
        poses, self._turning = pose_at_zero(robot), robot.turning
        axes, origins, tip = poses.axis[0], poses.origin[0, 1:][self._turning], poses.tip[0]
        up = -poses.tool_axis[0]
        for name, axis in zip(robot.joint_names, axes, strict=True):
            if np.linalg.norm(np.cross(axis, up)) > _TOLERANCE:
                message = "not a planar arm: its axis is not parallel to the tool's z axis"
                raise InputError(str(robot.files[0]), f"joint[{name}]", message)
        across = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
        across /= np.linalg.norm(across)
        self._frame = np.column_stack([across, np.cross(up, across), up])
        self._tool, self._height = -up, float(tip @ up)
        self._shoulder, elbow, end = (
            (place @ self._frame)[:2] for place in (origins[0], origins[1], tip)
        )
        upper, fore = elbow - self._shoulder, end - elbow
        self._upper, self._fore = float(np.linalg.norm(upper)), float(np.linalg.norm(fore))
        if min(self._upper, self._fore) < _TOLERANCE:
            name = robot.joint_names[self._turning[int(self._upper >= _TOLERANCE)]]
            message = "not a planar arm: the link behind it has no length"
            raise InputError(str(robot.files[0]), f"joint[{name}]", message)
        first = np.arctan2(upper[1], upper[0])
        self._zero = np.array([first, np.arctan2(fore[1], fore[0]) - first])
        self._sign = np.sign(axes[self._turning[:2]] @ up)
        self.lever, self.reach = self._fore, self._upper + self._fore
        above = np.array([*self._shoulder, self._height + self.reach])
        self.viewpoints = (self._frame @ above)[None]

    def _check_locked(self, files: RobotFiles) -> None:
        if files.locked_joint_6_rad is not None:
            message = "a planar arm has no joint 6: leave it out"
            raise InputError(None, "robot.locked_joint_6_rad", message)

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """Only points in the plane have solutions.

        See :meth:`~cellcolor.frontend.arm.inverse.InverseKinematics.solve`.
        """
        place = points @ self._frame
        x, y = (place[:, :2] - self._shoulder).T
        far = self._never(place[:, 2], directions)
        cosine = (x**2 + y**2 - self._upper**2 - self._fore**2) / (2 * self._upper * self._fore)
        cosine[far | (np.abs(cosine) > 1 + _ROUNDING)] = np.nan
        bend = np.arccos(np.clip(cosine, -1, 1))
        found = []
        for sign in (-1.0, 1.0):  # with a bend to the left the elbow is on the right
            turned = sign * bend
            ahead = np.arctan2(self._fore * np.sin(turned), self._upper + self._fore * cosine)
            found.append(np.column_stack([np.arctan2(y, x) - ahead, turned]))
        two = (np.stack(found, axis=1) - self._zero) * self._sign
        every = np.zeros((len(points), 2, self.joints))
        every[:, :, self._turning[:2]] = np.pi - np.mod(np.pi - two, 2 * np.pi)  # (-pi, pi]
        every[np.isnan(two).any(axis=2)] = np.nan
        return every if branches is None else every[np.arange(len(points)), branches][:, None]

    def _never(self, heights: Array, directions: Array) -> Mask:
        """Where there is no solution, whatever the elbow does, (n,)."""
        off = np.abs(heights - self._height) > _OFF_PLANE
        return np.asarray(off | ~(np.linalg.norm(directions - self._tool, axis=1) <= _TILT))


class PlanarThree(PlanarTwo):
    """Three parallel joints; the turn of the tool is given, and the third one makes it."""

    joints = 3
    free_turn: ClassVar[TaskSpace | None] = None

    def _check_locked(self, files: RobotFiles) -> None:
        """The third joint is solved for by who asks for the turn."""
