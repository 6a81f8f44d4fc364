"""An arm whose tool has its turn by a rule, with a family of branches for each turn of a set.

A whole pose of the tool is one of the frame behind the last joint, hence one of another tool that
is on the last joint's axis. Its tip and its direction leave the last joint free, so the other
joints are those that the arm's family finds for them, and there are no more solutions. The last
joint makes the turn, in exactly one way.
"""

from __future__ import annotations

import copy
import dataclasses

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array
from cellcolor.errors import InputError
from cellcolor.frontend.arm.inverse import InverseKinematics, check_lever, pose_at_zero
from cellcolor.frontend.arm.kinematics import (
    angle_about,
    farthest_reach,
    forward,
    nearest_points,
    one_across,
    turned,
    turned_about,
)
from cellcolor.frontend.arm.robot import FREE_TURN, Robot
from cellcolor.frontend.setup import RobotFiles, Turn

_LEAST_SHARE = 1e-6  # of a vector's length that its projection has to have, for a direction
_LEAST_LENGTH = 1e-6  # m; the same of the way to a point


def turn_at(turn: Turn, points: Array, directions: Array) -> Array:
    """Where the rule wants the tool's x axis, (n, 3) unit vectors across the tool.

    Args:
        turn: the rule; the first of its turns is not added.
        points: (n, 3) the tip, in the world, m.
        directions: (n, 3) unit vectors of the tool's z axis.

    Returns:
        NaN where the rule says nothing, since what it points along is along the tool.
    """
    if turn.along is not None:
        wanted = np.broadcast_to(np.array(turn.along) / np.linalg.norm(turn.along), points.shape)
        least = _LEAST_SHARE
    else:
        wanted, least = np.array(turn.towards_m) - points, _LEAST_LENGTH
    across = wanted - np.einsum("ni,ni->n", wanted, directions)[:, None] * directions
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    return np.asarray(np.where(lengths > least, across / np.maximum(lengths, least), np.nan))


_PARALLEL = 1e-6  # rad
_SAME_HEIGHT = 1e-6  # m
_LEAST = 0.01  # m; no tool on the axis ends nearer to the wrist than this


_WRIST, _SHOULDER = (-1, -2), (0, 1)  # axes that turn, as they are counted


def _where_near(robot: Robot, pair: tuple[int, int]) -> Array:
    """Where the first axis of a pair is nearest to the second, (3,) with all joints at zero, m.

    If they are parallel, where it is nearest to the tip.
    """
    poses = pose_at_zero(robot)
    (joint, other), origins = robot.turning[list(pair)], poses.origin[0, 1:]
    point, axis, beside = origins[joint], poses.axis[0, joint], poses.axis[0, other]
    if np.linalg.norm(np.cross(axis, beside)) < _PARALLEL:
        return np.asarray(point + ((poses.tip[0] - point) @ axis) * axis)
    return nearest_points(point, axis, origins[other], beside)[0]


def on_last_axis(robot: Robot) -> Robot:
    """The same arm with another tool, whose turn is free: on the last axis, beside the true tip.

    Its z axis goes along the last axis, away from the wrist, to the true tip's side. A tip at the
    wrist's height has no side, as behind two parallel axes: there the true tool's z axis decides,
    since an arm whose axes are all parallel points its tool one way only.
    """
    poses, wrist = pose_at_zero(robot), _where_near(robot, _WRIST)
    axis = poses.axis[0, robot.turning[-1]]
    out = float((poses.tip[0] - wrist) @ axis)
    side = out if abs(out) > _SAME_HEIGHT else float(poses.tool_axis[0] @ axis)
    sense = -1.0 if side < 0 else 1.0
    foot = wrist + sense * max(abs(out), _LEAST) * axis
    within = poses.rotation[0, -1].T
    tip = np.eye(4)
    z = within @ (sense * axis)
    x = one_across(z)
    tip[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    tip[:3, 3] = within @ (foot - poses.origin[0, -1])
    return dataclasses.replace(robot, tip=tip, task=FREE_TURN)


def with_last_joint(robot: Robot, configurations: Array, rotation: Array) -> Array:
    """Configurations (k, joints) with the last joint turned so that the frame behind it fits.

    Args:
        configurations: in rad; their last turning joint is not looked at.
        rotation: (k, 3, 3) the frame as it shall be; about the last axis it is turned to.
    """
    found, last = configurations.copy(), robot.turning[-1]
    found[:, last] = 0.0
    poses = forward(robot, found)
    axis = robot.axis[last]
    for placement in robot.placement[last + 1 :]:  # nothing turns behind it
        axis = placement[:3, :3].T @ axis
    across = one_across(axis)
    have, wanted = turned(poses.rotation[:, -1], across), turned(rotation, across)
    found[:, last] = angle_about(poses.axis[:, last], have, wanted)
    return found


class TurnedKinematics(InverseKinematics):
    """Inverse kinematics of a point and a direction, where a rule adds the tool's turn.

    Its branches are those of the arm's family, or those of each turn of a set, one turn after the
    other: along a motion the tool does not get from one turn to another.

    Attributes:
        own: the arm's family, for a tool on the last joint's axis.
        turn: the rule.
    """

    def __init__(
        self, family: type[InverseKinematics], robot: Robot, files: RobotFiles, turn: Turn
    ) -> None:
        """An arm of a family with any tool, and the rule.

        Raises:
            InputError: as the family; the last joint is locked; the tool is longer than the arm;
                or the solutions of the arm have no names, and a set of turns needs some.
        """
        if files.locked_joint_6_rad is not None:
            message = "no joint is locked with the tool's turn given (task.turn): leave it out"
            raise InputError(None, "robot.locked_joint_6_rad", message)
        _check_last_axis(robot, tilted=family.given_turn.direction)
        self._robot, self.turn = robot, turn
        self.straight = on_last_axis(robot)
        # What the last joint is locked at does not matter: it is solved for afterwards.
        locked = float(np.clip(0.0, robot.lower[-1], robot.upper[-1]))
        self.own = family(self.straight, files.varied(locked_joint_6_rad=locked))
        poses = pose_at_zero(robot)
        self.reach = farthest_reach(robot, _where_near(robot, _SHOULDER))
        self.viewpoints = self.own.viewpoints
        self.lever = float(np.linalg.norm(poses.tip[0] - _where_near(robot, _WRIST)))
        check_lever(robot, files, self.lever, self.reach - self.lever)
        self._angles = np.radians(turn.degrees)
        self.branches = self.own.branches
        if turn.is_choice:
            if not self.own.branches:
                message = "the solutions of this arm have no names, which a set of turns needs"
                raise InputError(None, "task.turn", message)
            self.branches = tuple(
                f"turn {degrees:.10g}° {name}"
                for degrees in turn.degrees
                for name in self.own.branches
            )

    def solve(
        self, points: Array, directions: Array, branches: NDArray[np.intp] | None = None
    ) -> Array:
        """No solution where the rule says nothing."""
        if branches is not None:
            number, branch = np.divmod(branches, len(self.own.branches))
            tools = self._tools(points, directions, self._angles[number])
            return self.solve_pose(points, *tools, branch)
        every = [
            self.solve_pose(points, *self._tools(points, directions, angle))
            for angle in self._angles
        ]
        return np.concatenate(every, axis=1)

    def solve_pose(
        self,
        points: Array,
        directions: Array,
        across: Array,
        branches: NDArray[np.intp] | None = None,
    ) -> Array:
        """All configurations that put the whole tool into a pose, its turn included.

        Args:
            points, directions: as in
                :meth:`~cellcolor.frontend.arm.inverse.InverseKinematics.solve`.
            across: (n, 3) unit vectors of the tool's x axis, at right angles to the directions; NaN
                where there is none, and there is no solution then.
            branches: (n,) the only one of the family's wanted of each pose; all without it.
        """
        rotation, tips, axes = self._on_last_axis(points, directions, across)
        found = self.own.solve(tips, axes, branches)
        row, branch = np.nonzero(~np.isnan(found[:, :, 0]))
        found[row, branch] = with_last_joint(self._robot, found[row, branch], rotation[row])
        return found

    def taken(self, directions: Array) -> Array:
        return self.own.taken(directions)

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:
        """Those of the arm's family on all turns of the tool together."""
        every = [self.straightened(points, directions, angle) for angle in self._angles]
        tips, axes = (np.concatenate(each) for each in zip(*every, strict=True))
        told = ~np.isnan(axes[:, 0])
        return self.own.remarks(tips[told], axes[told])

    def straightened(
        self, points: Array, directions: Array, angle: float | None = None
    ) -> tuple[Array, Array]:
        """Tips and directions (n, 3) of the tool on the last axis, for a turn of the set in rad.

        Without one it is the first.

        Both are NaN where the rule says nothing.
        """
        angle = self._angles[0] if angle is None else angle
        return self._on_last_axis(points, *self._tools(points, directions, angle))[1:]

    def _tools(self, points: Array, directions: Array, angle: Array | float) -> tuple[Array, Array]:
        """The tool's z and x axes, (n, 3) each, turned by angles (n,) or one from the rule's."""
        directions = self.taken(directions)
        across = turn_at(self.turn, points, directions)
        return directions, turned_about(directions, across, np.asarray(angle))

    def with_own(self, own: InverseKinematics) -> TurnedKinematics:
        """The same with other branches; there is one turn."""
        named = copy.copy(self)
        named.own, named.branches = own, own.branches
        return named

    def _on_last_axis(
        self, points: Array, directions: Array, across: Array
    ) -> tuple[Array, Array, Array]:
        """Rotations of the last frame, and tips and directions of the tool on the last axis."""
        tools = np.stack([across, np.cross(directions, across), directions], axis=2)
        rotation = tools @ self._robot.tip[:3, :3].T
        origin = points - turned(rotation, self._robot.tip[:3, 3])
        tip = self.straight.tip
        return rotation, origin + rotation @ tip[:3, 3], rotation @ tip[:3, 2]


def _check_last_axis(robot: Robot, tilted: bool) -> None:
    """Refuse an arm if a tool cannot be thought on its last axis that turns, instead of its own.

    What slides behind that joint has to slide along its axis, or no tool stays on it. And if no
    joint can tilt the tool (``tilted``), its own is along the axis as well: it would be taken for
    the one on the axis.
    """
    if not len(robot.turning):
        raise InputError(str(robot.files[0]), "robot", "no joint turns, so none can turn the tool")
    poses, last = pose_at_zero(robot), robot.turning[-1]
    off = np.linalg.norm(np.cross(poses.axis[0], poses.axis[0, last]), axis=1)
    for joint in range(last + 1, robot.joints):
        if off[joint] > _PARALLEL:
            message = "slides across the last axis that turns, so the tool's turn cannot be given"
            raise robot.refused(joint, message)
    if not tilted and np.linalg.norm(np.cross(poses.tool_axis[0], poses.axis[0, last])) > _PARALLEL:
        message = "not parallel to the tool's z axis, which arms of this family keep along their "
        message += "axes (mount_rpy_rad under [robot] turns the tool)"
        raise robot.refused(last, message)
