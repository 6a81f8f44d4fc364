"""Arms with an offset wrist: six revolute joints, axes 2 and 3 parallel, and axes 4 and 5 meeting.

Most cobots are built so: xArm6, HC10, CRX, Gen3 with six joints. Their last three axes do not meet
in one point, so there is no closed form for all of them; a pose has up to 16 solutions.

One number is searched for: the angle by which the link before joint 6 is turned about the tool,
which the task leaves free. With it this link is known, and so is axis 5 with the point where axis 4
meets it. Joints 1 to 3 bring that point there in up to four ways, in closed form: joint 1 to the
right distance from the plane of the arm, then a triangle of two links. What remains is one
equation, that axes 4 and 5 enclose the angle that they have. Its left side is followed round the
circle for each of the four ways (shoulder, elbow) and changes its sign at a solution. Two ways meet
where the arm just reaches, and there the left side goes over from one into the other.

Newton's method leads from there to the solutions of the arm as its URDF has it. So the axes have to
be parallel and meet within a millimeter and a milliradian only.

Newton's method starts at angles beside a change of sign, beside the end of a way, and where the
left side comes nearest to zero. Where a solution is missing still, by the signs of the determinants
(:mod:`cellcolor.frontend.arm.calibrated`), the angles are many more. Two that are nearer to each
other than two angles may be missed together: they are about to meet in a singularity then. In how
far that happens is measured in ``docs/arms.md``.
"""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.calibrated import missing, remark_on_missing
from cellcolor.frontend.arm.inverse import SixRevolute
from cellcolor.frontend.arm.kinematics import (
    angle_about,
    frames_along,
    nearest_points,
    one_across,
    turned_about,
)
from cellcolor.frontend.arm.newton import Polished, stacked
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import RobotFiles

_TOLERANCE = 1e-3  # m and rad; vendors write 1.5708 for a right angle
_LEAST = 1e-6  # m; of a length, and of a sine
_ANGLES = 256  # at which the equation is evaluated
_FINER = 4096  # the same of poses of which a solution is missing
_FARTHEST = 0.5  # m, and for unit vectors; by how much a start may miss the pose


class OffsetWrist(SixRevolute):
    """An arm whose wrist has an offset.

    Its solutions have no names: nothing but continuity tells them apart.
    """

    branches = ()

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """The arm's axes at zero."""
        super().__init__(robot, files, "not an arm with an offset wrist")
        poses = self._poses
        self._axes, points = poses.axis[0], poses.origin[0, 1:]
        n = self._axes[1]
        if np.linalg.norm(np.cross(self._axes[2], n)) > _TOLERANCE:
            raise self._refused(2, "its axis is not parallel to that of joint 2")
        if np.linalg.norm(np.cross(self._axes[0], n)) < _TOLERANCE:
            raise self._refused(1, "its axis is parallel to that of joint 1")
        here, there = nearest_points(points[3], self._axes[3], points[4], self._axes[4])
        parallel = np.linalg.norm(np.cross(self._axes[3], self._axes[4])) < _TOLERANCE
        if parallel or np.linalg.norm(here - there) > _TOLERANCE:
            raise self._refused(4, "its axis does not meet that of joint 4")
        self._center, self._tip, self._tool = here, poses.tip[0], poses.tool_axis[0]
        self._base, self._shoulder = nearest_points(
            points[0], self._axes[0], points[1], self._axes[1]
        )
        # In the plane across axes 2 and 3, from the shoulder: the elbow, and on to the center.
        self._flat = np.eye(3) - np.outer(n, n)
        self._upper = self._flat @ (points[2] - self._shoulder)
        self._fore = self._flat @ (self._center - points[2])
        self._lengths = np.linalg.norm(self._upper), np.linalg.norm(self._fore)
        for joint, length in zip((2, 3), self._lengths, strict=True):
            if length < _LEAST:
                raise self._refused(joint, "the link before it has no length")
        self._set_sizes(files, self._axes, points)
        self.lever = float(np.linalg.norm(self._tip - self._center))

    def _refused(self, joint: int, why: str) -> InputError:
        return self._robot.refused(joint, f"not an arm with an offset wrist: {why}")

    def solve(
        self,
        points: Array,
        directions: Array,
        branches: NDArray[np.intp] | None = None,  # noqa: ARG002
    ) -> Array:
        found = self._polished(points, directions, _ANGLES)
        lost = np.flatnonzero(missing(self._robot, found))
        finer = self._polished(points[lost], directions[lost], _FINER)
        both = stacked([found, finer])
        found = both[: len(points)]
        found[lost] = both[len(points) :]
        return found

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        return (remark_on_missing(self._robot, self.solve(points, directions)),)

    def _polished(self, points: Array, directions: Array, angles: int) -> Array:
        """The solutions (n, s, 6) that starts at so many angles lead to."""
        starts = partial(self._starts, angles=angles)
        polished = Polished(
            robot=self._robot, closed_form=starts, farthest=_FARTHEST, at_a_time=angles
        )
        return polished.solve(points, directions)

    def _starts(self, points: Array, directions: Array, angles: int) -> Array:
        """Configurations (n, s, 6) next to solutions, NaN for none."""
        pose, number = np.divmod(np.arange(len(points) * angles), angles)
        link = self._link(points[pose], directions[pose], 2 * np.pi / angles * number)
        off, joints = self._off(*link)
        off = off.reshape(len(points), angles, 4)
        beside = np.stack([np.roll(off, 1, axis=1), np.roll(off, -1, axis=1)])
        with np.errstate(invalid="ignore"):
            near = (off * beside <= 0).any(axis=0)
            near |= (np.isnan(beside) | (np.abs(off) <= np.abs(beside))).all(axis=0)
        near |= np.isnan(beside).any(axis=0)
        near |= np.roll(near, 1, axis=1) | np.roll(near, -1, axis=1)
        at, number, way = np.nonzero(near & ~np.isnan(off))
        row = at * angles + number
        found = self._joints(link[0][row], joints[row, way])
        place = np.arange(len(at)) - np.searchsorted(at, at)
        starts = np.full((len(points), int(place.max(initial=-1)) + 1, 6), np.nan)
        starts[at, place] = found
        return starts

    def _link(self, points: Array, directions: Array, turns: Array) -> tuple[Array, Array]:
        """The link before joint 6 with the tool in poses (k,), turned about it by angles (k,).

        Returns:
            How the link is turned, (k, 3, 3), and where the center of axes 4 and 5 is, (k, 3).
        """
        x = turned_about(directions, frames_along(directions)[:, :, 0], turns)
        there = np.stack([x, np.cross(directions, x), directions], axis=2)
        rotation: Array = there @ frames_along(self._tool[None])[0].T
        return rotation, points + rotation @ (self._center - self._tip)

    def _off(self, rotation: Array, center: Array) -> tuple[Array, Array]:
        """For each way by how much the angle of axes 4 and 5 is off, and joints 1 to 3.

        Args:
            rotation, center: see :meth:`_link`.

        Returns:
            The cosine's error (k, 4), and joints (k, 4, 3) in rad; NaN where there is no such way.
        """
        z, n, fourth, fifth = self._axes[0], self._axes[1], self._axes[3], self._axes[4]
        center = center - self._base
        # Joint 1: the center keeps its distance along axis 2, which turns about axis 1.
        out = n - (n @ z) * z
        wanted = (self._center - self._base) @ n - (n @ z) * (center @ z)
        x, y = center @ out, center @ np.cross(z, n)
        with np.errstate(divide="ignore", invalid="ignore"):
            spread = np.arccos(wanted / np.hypot(x, y))
        first = np.arctan2(y, x)[:, None] + spread[:, None] * np.array([1, 1, -1, -1])
        # Joints 2 and 3: a triangle in the plane across axis 2, seen with joint 1 at zero.
        back = turned_about(z, center[:, None], -first)
        goal = (back - (self._shoulder - self._base)) @ self._flat
        far = np.einsum("kwi,kwi->kw", goal, goal)
        upper, fore = self._lengths
        with np.errstate(invalid="ignore", divide="ignore"):
            bend = np.arccos((far - upper**2 - fore**2) / (2 * upper * fore))
        third = bend * np.array([1, -1, 1, -1]) - angle_about(n, self._upper, self._fore)  # about n
        second = angle_about(n, self._upper + turned_about(n, self._fore, third), goal)
        joints = np.stack([first, second, np.sign(self._axes[2] @ n) * third], axis=2)
        turned = turned_about(z, turned_about(n, fourth, second + third), first)
        cosine = np.einsum("kwi,ki->kw", turned, rotation @ fifth)
        return cosine - fourth @ fifth, joints

    def _joints(self, rotation: Array, three: Array) -> Array:
        """All joints (k, 6) in rad, as if axes 4 and 5 fitted.

        Args:
            rotation: (k, 3, 3) of the link before joint 6.
            three: (k, 3) joints 1 to 3.
        """
        z, n, fourth, fifth = self._axes[0], self._axes[1], self._axes[3], self._axes[4]
        both = three[:, 1] + np.sign(self._axes[2] @ n) * three[:, 2]
        across = one_across(fifth)

        def behind_third(vector: Array) -> Array:
            """A vector of the link before joint 6, seen from behind joint 3 at zero."""
            return turned_about(n, turned_about(z, rotation @ vector, -three[:, 0]), -both)

        q4 = angle_about(fourth, fifth, behind_third(fifth))
        q5 = angle_about(fifth, across, turned_about(fourth, behind_third(across), -q4))
        return np.column_stack([three, q4, q5, np.full(len(three), self._locked)])
