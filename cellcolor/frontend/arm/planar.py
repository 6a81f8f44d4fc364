"""Planar arms and SCARAs: joints with parallel axes, and the tool along them.

A planar arm has two or three joints that turn. Its tip moves in a plane across the tool, so the
part is flat and lies in that plane. A SCARA whose prismatic joint is fixed is one.

Tip and elbow make a triangle with the shoulder, which has two solutions: elbow left and elbow
right of the straight line from shoulder to tip, seen from where the tool comes from. The task
determinant is twice the triangle's area, so along a motion without singularity the elbow stays.

A SCARA has a joint that slides along the axes as well. The height of the tool is that of the
sliding joint, and the other joints do what a planar arm does. It does not matter which of the
joints slides, since a shift along the axes changes nothing about them: the makers' two orders
(turning joints 1, 2 and 4, or 1, 2 and 3) have the same two solutions, and so has a column under
the arm. The task gives the tip's position and, with a third turning joint, the tool's turn. It does
not give the tool's direction: the part may be curved, as long as the tool comes from outside.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import InverseKinematics, pose_at_zero
from cellcolor.frontend.arm.kinematics import frames_along
from cellcolor.frontend.arm.robot import (
    FREE_IN_PLANE,
    GIVEN_IN_PLANE,
    POSITION,
    POSITION_AND_TURN,
    Robot,
    TaskSpace,
)
from cellcolor.frontend.setup import RobotFiles

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
        # Where the turn is given, the joint that makes it is solved for: what locks it is ignored.
        if files.locked_joint_6_rad is not None and self.free_turn is not None:
            message = "a planar arm has no joint 6: leave it out"
            raise InputError(None, "robot.locked_joint_6_rad", message)
        poses, self._turning = pose_at_zero(robot), robot.turning
        axes, origins, tip = poses.axis[0], poses.origin[0, 1:][self._turning], poses.tip[0]
        up = -poses.tool_axis[0]
        for joint, axis in enumerate(axes):
            if np.linalg.norm(np.cross(axis, up)) > _TOLERANCE:
                message = "not a planar arm: its axis is not parallel to the tool's z axis"
                raise robot.refused(joint, message)
        self._frame = frames_along(up[None])[0]
        self._tool, self._height = -up, float(tip @ up)
        self._shoulder, elbow, end = (
            (place @ self._frame)[:2] for place in (origins[0], origins[1], tip)
        )
        upper, fore = elbow - self._shoulder, end - elbow
        self._upper, self._fore = float(np.linalg.norm(upper)), float(np.linalg.norm(fore))
        if min(self._upper, self._fore) < _TOLERANCE:
            joint = self._turning[int(self._upper >= _TOLERANCE)]
            raise robot.refused(joint, "not a planar arm: the link behind it has no length")
        first = np.arctan2(upper[1], upper[0])
        self._zero = np.array([first, np.arctan2(fore[1], fore[0]) - first])
        self._sign = np.sign(axes[self._turning[:2]] @ up)
        self.lever, self.reach = self._fore, self._upper + self._fore
        above = np.array([*self._shoulder, self._height + self.reach])
        self.viewpoints = (self._frame @ above)[None]

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """Only points in the plane have solutions."""
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


class ScaraWithoutTurn(PlanarTwo):
    """Two turning joints and a prismatic one; the tool's turn follows."""

    joints = 3
    prismatic: ClassVar[int] = 1
    free_turn: ClassVar[TaskSpace | None] = POSITION
    given_turn: ClassVar[TaskSpace] = POSITION_AND_TURN

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """As of a planar arm, and which joint slides, which way."""
        super().__init__(robot, files)
        self._slide = int(np.flatnonzero(robot.slides)[0])
        self._along = float(np.sign(pose_at_zero(robot).axis[0, self._slide] @ -self._tool))
        self.lever = 0.0  # no joint gives way to a normal that turns

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """Positions of the prismatic joint are in m, whether it gets there or not."""
        found = super().solve(points, directions, branches)
        heights = points @ -self._tool
        lift = self._along * (heights - self._height)[:, None]
        found[:, :, self._slide] = np.where(np.isnan(found[:, :, 0]), np.nan, lift)
        return found

    def taken(self, directions: Array) -> Array:
        """The only direction that the tool has."""
        return np.where(self._never(np.zeros(0), directions)[:, None], np.nan, self._tool)

    def _never(self, heights: Array, directions: Array) -> Mask:  # noqa: ARG002
        return np.asarray(~(directions @ self._tool > 0))


class Scara(ScaraWithoutTurn):
    """Three turning joints and a prismatic one; the turn of the tool is given."""

    joints = 4
    free_turn: ClassVar[TaskSpace | None] = None
