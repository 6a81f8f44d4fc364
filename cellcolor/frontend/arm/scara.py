"""SCARAs: joints that turn about parallel axes, and one that slides along them.

The tool is along these axes, always. Its height is that of the sliding joint, and what the others
do is what a planar arm does, whichever of the joints it is that slides: a shift along the axes
changes nothing about them. So the makers' two orders, turning joints 1, 2 and 4 or 1, 2 and 3, have
the same two solutions, and so has a column under the arm.

Where the tip is, is asked for, and with the third turning joint how the tool is turned. The tool's
direction is not: the part may be curved, as long as the tool comes from outside.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.last_joint import pose_at_zero
from cellcolor.frontend.arm.planar import PlanarTwo
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.task_space import POSITION, POSITION_AND_TURN, TaskSpace
from cellcolor.frontend.setup import RobotFiles

__all__ = ["Scara", "ScaraWithoutTurn"]


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
        """Positions of the prismatic joint are in m, whether it gets there or not.

        See :meth:`~cellcolor.frontend.arm.inverse.InverseKinematics.solve`.
        """
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

    def _check_locked(self, files: RobotFiles) -> None:
        """The third turning joint is solved for by who asks for the turn."""
