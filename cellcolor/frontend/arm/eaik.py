"""Arms of six revolute joints that EAIK solves in closed form, all solutions, in batches.

EAIK finds out by itself which axes meet and which are parallel, and takes the inverse kinematics
apart into subproblems (Ostermeier, Kuelz and Althoff, Automatic Geometric Decomposition for
Analytical Inverse Kinematics, 2025): spherical wrists, three parallel axes, and others.

It solves for a whole pose. A task of five dimensions leaves the turn of the tool about its axis
free; with the tool on the axis of joint 6 and this joint locked, any one turn will do: a
configuration that has the tip on the point and the tool along the direction is turned by joint 6
alone to the turn that is asked for, with the same first five joints. So the first five joints of
all solutions for one turn are those for every turn, and no solution of the task is missed. Two
solutions that differ in joint 6 only would be the same; they are merged.

Of a calibrated arm, whose axes nearly meet or are nearly parallel, EAIK solves the ideal one, and
Newton's method does the rest (:mod:`cellcolor.frontend.arm.calibrated`).
"""

from __future__ import annotations

import os
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.calibrated import CALIBRATION, Axes, NearIdeal, idealized
from cellcolor.frontend.arm.inverse import SixRevolute
from cellcolor.frontend.arm.kinematics import frames_along
from cellcolor.frontend.arm.newton import Polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import BRANCHES, signs_of
from cellcolor.frontend.setup import RobotFiles

_EXACT = 1e-4  # m, and for unit vectors; by how much one of EAIK's answers may miss
_TOLERANCE = 1e-6  # m and rad; axes farther off are neither parallel nor do they meet


class EaikKinematics(SixRevolute):
    """Any arm that EAIK knows.

    The branches have names where the signs of shoulder, elbow and wrist tell the solutions apart
    (:mod:`cellcolor.frontend.arm.signs`), and none otherwise.
    """

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """The arm's closed form, or that of the ideal arm."""
        super().__init__(robot, files, "not an arm of the family eaik")
        poses = self._poses
        axes = Axes(poses.axis[0], poses.origin[0, 1:])
        self._solver = _solver(axes)
        off: tuple[float, float] | None = None
        if self._solver is None:
            ideal = idealized(axes, CALIBRATION)
            self._solver, off = _solver(ideal), ideal.off(axes)
            if self._solver is None or max(off) > CALIBRATION:
                raise InputError(str(robot.files[0]), "robot", _UNKNOWN)
            axes = ideal
        along = np.sign(axes.directions[5] @ poses.tool_axis[0])
        self._tool_at_zero = frames_along(along * axes.directions[5:6])[0]
        # The tip as it is on the ideal arm: at its height on the last axis.
        height = float((poses.tip[0] - axes.points[5]) @ axes.directions[5])
        self._tip = height * axes.directions[5]
        self._set_sizes(files, axes.directions, axes.points)
        tolerance = _TOLERANCE if off is None else 2 * CALIBRATION
        signs = signs_of(robot, self.reach, tolerance)
        solved = partial(NearIdeal, off=off) if off else partial(Polished, farthest=_EXACT)
        self._solution = solved(robot=robot, closed_form=self._closed_form, signs=signs)
        self.branches = () if signs is None else BRANCHES

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """See :meth:`~cellcolor.frontend.arm.inverse.InverseKinematics.solve`.

        What EAIK finds is held by forward kinematics, after steps of Newton's method where it is
        not exact. Its own mark of least-squares answers is not asked: of arms with a spherical
        wrist and no parallel axes it marks exact solutions as well.
        """
        return self._solution.solve(points, directions, branches)

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        return self._solution.remarks(points, directions)

    def _closed_form(
        self,
        points: Array,
        directions: Array,
        *,
        branches: NDArray[np.intp] | None = None,  # noqa: ARG002
    ) -> Array:
        """EAIK's answers (n, s, 6) in rad, joint 6 locked, NaN after the last of each pose.

        It has no names for them, so that all are given whichever branches are wanted.
        """
        counts = np.zeros(len(points), dtype=np.int64)
        asked = np.flatnonzero(np.isfinite(points + directions).all(axis=1))
        if not len(asked):
            return np.empty((len(points), 0, 6))
        # Poses of the last frame, turned as the world at zero, for any one turn of the tool.
        flanges = np.tile(np.eye(4), (len(asked), 1, 1))
        flanges[:, :3, :3] = frames_along(directions[asked]) @ self._tool_at_zero.T
        flanges[:, :3, 3] = points[asked] - flanges[:, :3, :3] @ self._tip
        answers = self._solver.IK_batched(list(flanges), os.cpu_count() or 1)
        every = [np.asarray(answer.Q).reshape(-1, 6) for answer in answers]
        counts[asked] = [len(each) for each in every]
        found = np.full((len(points), int(counts.max()), 6), np.nan)
        found[np.arange(found.shape[1]) < counts[:, None]] = np.concatenate(every)
        found[:, :, 5] = np.where(np.isnan(found[:, :, 0]), np.nan, self._locked)
        return found


_UNKNOWN = (
    "EAIK knows no closed form for this arm: its axes neither meet in a wrist nor are three of "
    "them parallel; 'offset-wrist' solves arms whose axes 2 and 3 are parallel and 4 and 5 meet, "
    "and an own solver can be named (docs/how-to/extend.md)"
)


def _solver(axes: Axes):  # type: ignore[no-untyped-def]  # EAIK has no types
    """EAIK's view of an arm, None if it knows no closed form.

    Raises:
        InputError: EAIK is not installed.
    """
    try:
        from eaik.IK_HP import HPRobot
    except ImportError as error:
        raise InputError(
            None,
            "robot.kinematics",
            "the family 'eaik' needs the package EAIK (the extra 'arms'), which has no wheel for "
            "every Python; 'ur' and own solvers work without it "
            "(docs/how-to/extend.md)",
        ) from error
    steps = np.diff(axes.points, axis=0, prepend=np.zeros((1, 3)))
    solver = HPRobot(axes.directions, np.vstack([steps, np.zeros((1, 3))]))
    return solver if solver.hasKnownDecomposition() else None
