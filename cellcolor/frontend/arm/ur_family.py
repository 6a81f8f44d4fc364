"""The family of UR-type arms, calibrated ones included.

The axes of a calibrated arm are a little off those that the closed form stands on
(:mod:`cellcolor.frontend.arm.ur`). From the solutions of the ideal arm Newton's method leads to
those of the true one, which keep their names (:mod:`cellcolor.frontend.arm.candidates`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.candidates import (
    CALIBRATION,
    branches_of_calibrated,
    solutions_of_calibrated,
)
from cellcolor.frontend.arm.ideal import Axes, idealized, remark_on_calibration
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.last_joint import check_tool_on_last_axis, locked_angle, pose_at_zero
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import Signs, signs_of
from cellcolor.frontend.arm.ur import BRANCHES, UrGeometry, solve_inverse, ur_geometry
from cellcolor.frontend.setup import RobotFiles

__all__ = ["UrKinematics"]

_SLACK = 0.05  # by so much a cosine may exceed 1 where the ideal arm just does not reach


class UrKinematics(InverseKinematics):
    """UR-type arms; joint 6, which the task leaves free, is locked."""

    joints = 6
    branches = BRANCHES

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """The constants of the arm, or of the ideal one, and the angle of the locked joint."""
        self._robot, self._locked = robot, locked_angle(robot, files)
        self._calibrated: _Calibrated | None = None
        try:
            self.geometry = ur_geometry(robot)
        except InputError:
            # A refusal with the larger tolerance is the one to be seen.
            self.geometry = ur_geometry(robot, CALIBRATION)
            self._calibrated = _Calibrated(robot, self.geometry)
        self.lever, self.viewpoints = self.geometry.reach, self.geometry.viewpoints
        self.reach = self.geometry.arm_reach
        if self.lever > abs(self.geometry.a2) + abs(self.geometry.a3):
            raise InputError(
                str(robot.files[1]),
                f"link[{files.tip_link}]",
                f"the tool is longer than the arm: tip {self.lever:.3f} m from the wrist",
            )

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """See :func:`~cellcolor.frontend.arm.ur.solve_inverse`."""
        if self._calibrated is None:
            return solve_inverse(self.geometry, points, directions, self._locked, branches)
        return self._calibrated.solve(points, directions, self._locked, branches)

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        """How a calibrated arm is solved, and what is missing."""
        if self._calibrated is None:
            return ()
        found, off = self.solve(points, directions), self._calibrated.off
        return (remark_on_calibration(self._robot, off, found),)


class _Calibrated:
    """A UR-type arm whose axes are a little off.

    Attributes:
        off: the largest angle in rad and the largest distance in m of an axis from the ideal one.
    """

    def __init__(self, robot: Robot, geometry: UrGeometry) -> None:
        check_tool_on_last_axis(robot, pose_at_zero(robot), "not a UR-type arm")
        self._robot, self._geometry = robot, geometry
        poses = pose_at_zero(robot)
        axes = Axes(poses.axis[0], poses.origin[0, 1:])
        self.off = idealized(axes, CALIBRATION).off(axes)
        signs = signs_of(robot, geometry.arm_reach, 2 * CALIBRATION)
        assert signs is not None  # a UR-type arm has them
        self._signs = signs
        self._of_sign = self._names(signs)

    def solve(
        self,
        points: Array,
        directions: Array,
        locked: float,
        branches: NDArray[np.intp] | None,
    ) -> Array:
        """All solutions (n, 8, 6) in rad by branch, or some (n, 1, 6); see ``solve_inverse``."""

        def ideal(
            points: Array, directions: Array, wanted: NDArray[np.intp] | None = None
        ) -> Array:
            return solve_inverse(self._geometry, points, directions, locked, wanted, _SLACK)

        of = points, directions, self._signs, self.off
        if branches is None:
            return solutions_of_calibrated(self._robot, ideal, *of)[:, self._of_sign]
        one = branches_of_calibrated(self._robot, ideal, *of, branches, self._of_sign)
        return one[:, None]

    def _names(self, signs: Signs) -> NDArray[np.intp]:
        """For each of ``BRANCHES`` the index that the signs have for it, (8,).

        Asked of the ideal arm's solutions for the pose among many that is farthest from any change
        of sign: there the true arm's factors have the same signs.
        """
        tries = np.random.default_rng(0).uniform(-np.pi, np.pi, (1000, 6))
        poses = forward(self._robot, tries)
        found = solve_inverse(self._geometry, poses.tip, poses.tool_axis, 0.0)
        found = found[~np.isnan(found).any(axis=(1, 2))]
        factors = signs.factors(forward(self._robot, found.reshape(-1, 6)))
        clearest = np.argmax(np.abs(factors).reshape(len(found), -1).min(axis=1))
        return signs.branches(self._robot, found[clearest])[0]
