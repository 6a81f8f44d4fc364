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

The equation is evaluated at many angles, so two solutions that are nearer to each other than two of
these angles may be missed, unless the left side comes near zero between them, where Newton's method
is started as well. They are about to meet in a singularity then. In how far that happens is
measured in ``docs/arms.md``.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.errors import InputError
from cellcolor.frontend.arm.calibrated import remark_on_missing
from cellcolor.frontend.arm.inverse import (
    InverseKinematics,
    check_lever,
    check_tool_on_last_axis,
    locked_angle,
    pose_at_zero,
)
from cellcolor.frontend.arm.kinematics import (
    angle_about,
    farthest_reach,
    frames_along,
    nearest_points,
    one_across,
    turned_about,
)
from cellcolor.frontend.arm.newton import Polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import RobotFiles

_TOLERANCE = 1e-3  # m and rad; vendors write 1.5708 for a right angle
_LEAST = 1e-6  # m; of a length, and of a sine
_ANGLES = 64  # at which the equation is evaluated
_PARTS = 16  # of the way between two of them where the equation changes fast or comes near zero
_HALVINGS = 24  # to where a way ends
_ROUNDS = 6  # of the method of the false position, before halving
_CLOSE = 1e-3  # so near to zero the equation is left to Newton's method
_ALMOST = 4.0  # times the step of the angles: less than the equation may change in between
_FARTHEST = 0.5  # m, and for unit vectors; by how much a start may miss the pose


class OffsetWrist(InverseKinematics):
    """An arm whose wrist has an offset; joint 6, which the task leaves free, is locked.

    Its solutions have no names: nothing but continuity tells them apart.
    """

    joints = 6
    branches = ()

    def __init__(self, robot: Robot, files: RobotFiles) -> None:
        """The arm's axes at zero, and the angle of the locked joint."""
        self._robot, self._locked = robot, locked_angle(robot, files)
        poses = pose_at_zero(robot)
        check_tool_on_last_axis(robot, poses, "not an arm with an offset wrist")
        self._axes, points = poses.axis[0], poses.origin[0, 1:].copy()
        n = self._axes[1]
        if np.linalg.norm(np.cross(self._axes[2], n)) > _TOLERANCE:
            raise self._refused(2, "its axis is not parallel to that of joint 2")
        if np.linalg.norm(np.cross(self._axes[0], n)) < _TOLERANCE:
            raise self._refused(1, "its axis is parallel to that of joint 1")
        here, there = nearest_points(points[3], self._axes[3], points[4], self._axes[4])
        parallel = np.linalg.norm(np.cross(self._axes[3], self._axes[4])) < _TOLERANCE
        if parallel or np.linalg.norm(here - there) > _TOLERANCE:
            raise self._refused(4, "its axis does not meet that of joint 4")
        self._center, self._tip, self.tool = here, poses.tip[0], poses.tool_axis[0]
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
        wrist = nearest_points(points[5], self._axes[5], points[4], self._axes[4])[0]
        self.reach = farthest_reach(robot, self._shoulder)
        self.lever = float(np.linalg.norm(self._tip - self._center))
        out = float(np.linalg.norm(self._tip - wrist))
        check_lever(robot, files, out, self.reach - out)
        up = self._axes[0] * (-1.0 if self._axes[0, 2] < 0 else 1.0)
        self.viewpoints = np.array([self._shoulder, self._shoulder + sum(self._lengths) * up])

    def _refused(self, joint: int, why: str) -> InputError:
        field = f"joint[{self._robot.joint_names[joint]}]"
        message = f"not an arm with an offset wrist: {why}"
        return InputError(str(self._robot.files[0]), field, message)

    def solve(
        self,
        points: Array,
        directions: Array,
        branches: NDArray[np.intp] | None = None,  # noqa: ARG002
    ) -> Array:
        arm, starts = self._robot, self._starts
        polished = Polished(robot=arm, closed_form=starts, farthest=_FARTHEST, at_a_time=_ANGLES)
        return polished.solve(points, directions)

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        """How many solutions are missing at least."""
        return (remark_on_missing(self._robot, self.solve(points, directions)),)

    def _starts(self, points: Array, directions: Array) -> Array:
        """Configurations (n, s, 6) next to solutions, NaN for none."""
        count = len(points)
        step = 2 * np.pi / _ANGLES
        search = _Search(self, points, directions)
        pose, number = np.divmod(np.arange(count * _ANGLES), _ANGLES)
        off, near = search.asked(pose, step * number)
        off, near = off.reshape(count, _ANGLES, 4), near.reshape(count, _ANGLES)
        after, before = np.roll(off, -1, axis=1), np.roll(off, 1, axis=1)
        size = np.abs(off)
        back = (size <= np.abs(after)) & (size <= np.abs(before)) & (size < _ALMOST * step)
        turning = (back & (off * after > 0) & (off * before > 0)).any(axis=2)
        fast = (np.abs(after - off) > _ALMOST * step).any(axis=2) | (near < _ALMOST * step)
        ends = (np.isnan(off) != np.isnan(after)).any(axis=2)
        fast |= ends | turning
        fast |= np.roll(fast, 1, axis=1) | np.roll(fast, -1, axis=1)
        pairs = np.stack([off, after], axis=2)[~fast]
        rows = np.flatnonzero(~fast)
        search.between(pose[rows], step * number[rows], step, pairs)
        rows = np.flatnonzero(fast)
        turns = step * (number[rows, None] + np.arange(_PARTS + 1) / _PARTS)
        fine = search.asked(np.repeat(pose[rows], _PARTS + 1), turns.ravel())[0]
        fine = fine.reshape(len(rows), _PARTS + 1, 4)
        search.between(pose[rows], step * number[rows], step / _PARTS, fine)
        at, way, turn = search.found()
        joints = self._joints(search.link(at, turn))[np.arange(len(at)), way]
        joints[np.isnan(joints).any(axis=1)] = np.nan
        order = np.argsort(at, kind="stable")
        at, joints = at[order], joints[order]
        place = np.arange(len(at)) - np.searchsorted(at, at)
        starts = np.full((count, int(place.max(initial=-1)) + 1, 6), np.nan)
        starts[at, place] = joints
        return starts

    def off(self, link: _Turned) -> tuple[Array, Array, Array]:
        """For each way by how much the angle of axes 4 and 5 is off, and joints 1 to 3.

        Returns:
            The cosine's error (k, 4), and joints (k, 4, 3) in rad; NaN where there is no such way.
            And how near (k,) the center is to axis 1 or to the shoulder, where joints turn fast, as
            a multiple of the circle on which it turns about the tool.
        """
        z, n, fourth, fifth = self._axes[0], self._axes[1], self._axes[3], self._axes[4]
        center = link.moved(self._center, self._tip) - self._base
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
        cosine = np.einsum("kwi,ki->kw", turned, link.rotation @ fifth)
        circle = np.linalg.norm(np.cross(self._center - self._tip, self.tool))
        near = np.minimum(np.hypot(x, y), np.sqrt(far.min(axis=1))) / max(circle, _LEAST)
        return cosine - fourth @ fifth, joints, near

    def _joints(self, link: _Turned) -> Array:
        """All joints (k, 4, 6) in rad, as if axes 4 and 5 fitted."""
        _, three, _ = self.off(link)
        z, n, fourth, fifth = self._axes[0], self._axes[1], self._axes[3], self._axes[4]
        both = three[..., 1] + np.sign(self._axes[2] @ n) * three[..., 2]
        across = one_across(fifth)

        def behind_third(vector: Array) -> Array:
            """A vector of the link before joint 6, seen from behind joint 3 at zero."""
            here = (link.rotation @ vector)[:, None]
            return turned_about(n, turned_about(z, here, -three[..., 0]), -both)

        q4 = angle_about(fourth, fifth, behind_third(fifth))
        q5 = angle_about(fifth, across, turned_about(fourth, behind_third(across), -q4))
        last = np.full((*q4.shape, 1), self._locked)
        return np.concatenate([three, q4[..., None], q5[..., None], last], axis=2)


_Columns = tuple[NDArray[Any], ...]


class _Search:
    """Where the equation is zero, of poses (n, 3) each: brackets, and turns next to zeros."""

    def __init__(self, arm: OffsetWrist, points: Array, directions: Array) -> None:
        self._arm, self._points, self._directions = arm, points, directions
        self._brackets: list[_Columns] = []
        self._near: list[_Columns] = []

    def link(self, at: Index, turns: Array) -> _Turned:
        return _Turned(self._points[at], self._directions[at], turns, self._arm.tool)

    def asked(self, at: Index, turns: Array) -> tuple[Array, Array]:
        """The equation (k, 4) of poses (k,) at turns (k,) in rad, and how near joints turn fast."""
        off, _, near = self._arm.off(self.link(at, turns))
        return off, near

    def _way(self, at: Index, way: Index, turns: Array) -> Array:
        return np.asarray(self.asked(at, turns)[0][np.arange(len(at)), way])

    def between(self, at: Index, first: Array, step: float, off: Array) -> None:
        """Note what is between equal steps of rows of turns.

        Args:
            at: (k,) the pose of each row.
            first: (k,) its first turn, rad.
            off: (k, c, 4) the equation.
        """
        here, after = off[:, :-1], off[:, 1:]
        row, number, way = np.nonzero(here * after <= 0)
        low = first[row] + step * number
        ends = here[row, number, way], after[row, number, way]
        self._brackets.append((at[row], way, low, low + step, *ends))
        # Where a way ends it goes over into another one: the end is one more turn.
        for side, one, other in ((step, here, after), (-step, after, here)):
            row, number, way = np.nonzero(~np.isnan(one) & np.isnan(other))
            start = first[row] + step * (number + (side < 0))
            inside, outside = start, start + side
            for _ in range(_HALVINGS):
                middle = (inside + outside) / 2
                known = ~np.isnan(self._way(at[row], way, middle))
                inside, outside = np.where(known, middle, inside), np.where(known, outside, middle)
            ends = one[row, number, way], self._way(at[row], way, inside)
            self._brackets.append((at[row], way, start, inside, *ends))
            self._near.append((at[row], way, inside))
        # Where it turns back close to zero there may be two solutions.
        size = np.abs(off)
        inner = size[:, 1:-1]
        back = (inner <= size[:, 2:]) & (inner <= size[:, :-2]) & (inner < _ALMOST * step)
        row, number, way = np.nonzero(back)
        center, here = first[row] + step * (number + 1), off[row, number + 1, way]
        for side in (-1, 1):
            middle, there = center + side * step / 2, off[row, number + 1 + side, way]
            value = self._way(at[row], way, middle)
            self._near.append((at[row], way, middle))
            self._brackets.append((at[row], way, center, middle, here, value))
            self._brackets.append((at[row], way, middle, center + side * step, value, there))

    def found(self) -> _Columns:
        """Pose, way and turn in rad, (s,) each, at or next to zeros."""
        every = [np.concatenate(each) for each in zip(*self._brackets, strict=True)]
        changes = every[4] * every[5] <= 0
        at, way, low, high, at_low, at_high = (each[changes] for each in every)
        turn = (low + high) / 2
        rows = np.arange(len(turn))
        # The method of the false position, the end that stays counting half (Illinois); halving
        # where joints turn so fast that the equation jumps.
        for step in range(_ROUNDS + _HALVINGS):
            a, b, left, right = low[rows], high[rows], at_low[rows], at_high[rows]
            with np.errstate(divide="ignore", invalid="ignore"):
                between = (a * right - b * left) / (right - left)
            halved = np.isnan(between) | (step >= _ROUNDS)
            turn[rows] = between = np.where(halved, (a + b) / 2, between)
            value = self._way(at[rows], way[rows], between)
            same = value * left > 0
            low[rows], high[rows] = np.where(same, between, a), np.where(same, b, between)
            at_low[rows] = np.where(same, value, left / 2)
            at_high[rows] = np.where(same, right / 2, value)
            if step >= _ROUNDS - 1:
                rows = rows[np.abs(value) > _CLOSE]
        near = zip((at, way, turn), *self._near, strict=True)
        at, way, turn = (np.concatenate(each) for each in near)
        return at, way, turn


class _Turned:
    """The link before joint 6 with the tool in poses, turned about it by angles (k,)."""

    def __init__(self, points: Array, directions: Array, angles: Array, tool: Array) -> None:
        x = turned_about(directions, frames_along(directions)[:, :, 0], angles)
        there = np.stack([x, np.cross(directions, x), directions], axis=2)
        self.points = points
        self.rotation: Array = there @ frames_along(tool[None])[0].T

    def moved(self, point: Array, tip: Array) -> Array:
        """Where a point (3,) of the link at zero is, (k, 3)."""
        return np.asarray(self.points + self.rotation @ (point - tip))
