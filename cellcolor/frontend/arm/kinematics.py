"""Forward kinematics, Jacobians, static torques and reach of many configurations at once (numpy).

Everything is in the world frame; ``n`` is the number of configurations. Held against Pinocchio
in the tests.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask, unit
from cellcolor.errors import InputError
from cellcolor.frontend.arm.robot import FREE_TURN, Robot, TaskSpace
from cellcolor.frontend.setup import Setup

TASK_JOINTS = FREE_TURN.joints  # a sixth turns about the tool's own axis and does not move the task


@dataclass(frozen=True)
class Poses:
    """Where everything is: frame 0 is the world, frame i the one behind joint i.

    Attributes:
        rotation, origin: (n, joints + 1, 3, 3), and (n, joints + 1, 3) in m.
        axis: (n, joints, 3) joint axes.
        tip: (n, 3) tool tip in m.
        tool_axis: (n, 3) the tool's z axis, from the flange to the tip.
        slides: (joints,) which joints are prismatic.
    """

    rotation: Array
    origin: Array
    axis: Array
    tip: Array
    tool_axis: Array
    slides: Mask

    @cached_property
    def jacobian(self) -> tuple[Array, Array]:
        """Linear and angular Jacobian of the tip, (n, 3, joints) each: m and rad per rad.

        Per m of a prismatic joint, which moves the tip along its axis and turns nothing.
        """
        linear, angular = np.cross(self.axis, self.tip[:, None] - self.origin[:, 1:]), self.axis
        if self.slides.any():
            slides = self.slides[:, None]
            linear, angular = np.where(slides, angular, linear), np.where(slides, 0.0, angular)
        return linear.transpose(0, 2, 1), angular.transpose(0, 2, 1)

    def take(self, rows: NDArray[np.intp]) -> Poses:
        """The poses of some of the configurations."""
        return Poses(
            self.rotation[rows],
            self.origin[rows],
            self.axis[rows],
            self.tip[rows],
            self.tool_axis[rows],
            self.slides,
        )


def forward(robot: Robot, configurations: Array) -> Poses:
    """Poses of all frames for configurations (n, joints) in rad, prismatic joints in m."""
    n = len(configurations)
    # In memory joint after joint, so that one frame of all configurations is one piece.
    rotation = np.empty((robot.joints + 1, n, 3, 3)).swapaxes(0, 1)
    origin = np.empty((robot.joints + 1, n, 3)).swapaxes(0, 1)
    axis = np.empty((n, robot.joints, 3))
    rotation[:, 0], origin[:, 0] = np.eye(3), 0.0
    for joint in range(robot.joints):
        fixed, (x, y, z) = robot.placement[joint], robot.axis[joint]
        # Rodrigues' formula, its constant matrices multiplied for all configurations at once.
        cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        before, once, twice = (
            turned(rotation[:, joint], fixed[:3, :3] @ turn)
            for turn in (np.eye(3), cross, cross @ cross)
        )
        turn = configurations[:, joint] * (not robot.slides[joint])
        once *= np.sin(turn)[:, None, None]
        twice *= (1.0 - np.cos(turn))[:, None, None]
        before += once
        before += twice
        rotation[:, joint + 1] = before
        origin[:, joint + 1] = origin[:, joint] + turned(rotation[:, joint], fixed[:3, 3])
        # The axis stays where it is when the joint turns.
        axis[:, joint] = turned(before, robot.axis[joint])
        if robot.slides[joint]:
            origin[:, joint + 1] += configurations[:, joint, None] * axis[:, joint]
    tip = origin[:, -1] + turned(rotation[:, -1], robot.tip[:3, 3])
    tool_axis = turned(rotation[:, -1], robot.tip[:3, 2])
    return Poses(rotation, origin, axis, tip, tool_axis, robot.slides)


def turned(rotation: Array, columns: Array) -> Array:
    """Rotations (n, 3, 3) times the same vector (3,) or matrix (3, m), as one large product."""
    product: Array = (rotation.reshape(-1, 3) @ columns).reshape(-1, 3, *columns.shape[1:])
    return product


def tool_across(robot: Robot, poses: Poses) -> Array:
    """The tool's x axis (n, 3) in the world, across the tool."""
    return turned(poses.rotation[:, -1], robot.tip[:3, 0])


def manipulability(poses: Poses, task: TaskSpace = FREE_TURN) -> Array:
    """Translational manipulability sqrt(det(J J^T)) of the task's joints, (n,), m^3.

    Yoshikawa, Translational and rotational manipulability of robotic manipulators, 1990. In a plane
    J has two rows, whichever two directions they are for, and the unit is m^2. For each prismatic
    joint there is a meter less in the unit, if all minors of J that are not zero have its column.
    """
    columns = _position_rows(poses, task)[:, :, : task.joints]
    gram = columns @ columns.transpose(0, 2, 1)
    return np.asarray(np.sqrt(np.maximum(np.linalg.det(gram), 0.0)))


def task_determinant(poses: Poses, task: TaskSpace = FREE_TURN) -> Array:
    """Absolute determinant (n,) of the task's Jacobian, m^3; m^2 in a plane.

    For each prismatic joint there is a meter less.

    Its rows are those that the task asks for: of the tip's position, of the tool's direction, of
    the tool's turn. The direction has two rows, the angular velocity across the tool axis; which
    two perpendicular ones does not change the absolute value. Unlike translational manipulability
    it vanishes at every singularity of the task, the aligned wrist included. With fewer joints than
    rows it is the volume that their columns span, lengths in m and angles in rad mixed.
    """
    return np.asarray(np.abs(signed_task_determinant(poses, task)))


def signed_task_determinant(poses: Poses, task: TaskSpace = FREE_TURN) -> Array:
    """The task determinant (n,) in m^3 with its sign, which no motion without singularity changes.

    The rows of the direction are two that make a right-handed frame with the tool. With fewer
    joints than rows there is no sign.
    """
    rows, angular = [_position_rows(poses, task)], poses.jacobian[1]
    if task.direction:
        rows.append(two_across(poses.tool_axis) @ angular)
    if task.turn:
        rows.append(poses.tool_axis[:, None] @ angular)
    whole = np.concatenate(rows, axis=1)[:, :, : task.joints]
    if whole.shape[2] == task.dimensions:
        return np.asarray(np.linalg.det(whole))
    gram = whole.transpose(0, 2, 1) @ whole
    return np.asarray(np.sqrt(np.maximum(np.linalg.det(gram), 0.0)))


def _position_rows(poses: Poses, task: TaskSpace) -> Array:
    """How the tip moves with all joints, (n, 3, joints); (n, 2, joints) in a plane."""
    linear = poses.jacobian[0]
    return two_across(poses.tool_axis) @ linear if task.plane else linear


def task_jacobian(poses: Poses) -> tuple[Array, Array]:
    """How tip position and tool direction move with the joints that a free turn takes, m and rad.

    Returns:
        (n, 5, task joints), three rows of the position and two of the direction; and (n, 2, 3) the
        unit vectors across the tool that the last two are angular velocities about.
    """
    (linear, angular), across = poses.jacobian, two_across(poses.tool_axis)
    return np.concatenate([linear, across @ angular], axis=1)[:, :, :TASK_JOINTS], across


def two_across(tool_axis: Array) -> Array:
    """Two unit vectors (n, 2, 3) that make a right-handed frame with the tool axis (n, 3)."""
    # A perpendicular that is never near zero: cross with the coordinate axis farthest off.
    farthest = np.eye(3)[np.argmin(np.abs(tool_axis), axis=1)]
    first = unit(np.cross(tool_axis, farthest))
    return np.stack([first, np.cross(tool_axis, first)], axis=1)


def static_torques(robot: Robot, poses: Poses, gravity: Array, normal_force: float) -> Array:
    """Torques (n, joints) in N m that hold arm and tool still; forces in N of prismatic joints.

    Args:
        gravity: (3,) in m/s^2.
        normal_force: with which the tip presses along the tool axis, N.
    """
    centers = poses.origin[:, 1:] + np.einsum("njab,jb->nja", poses.rotation[:, 1:], robot.center)
    # Mass and first moment of all that hangs behind each joint.
    behind = np.cumsum(robot.mass[::-1])[::-1]
    moments = np.cumsum((robot.mass[:, None] * centers)[:, ::-1], axis=1)[:, ::-1]
    lever = moments - behind[:, None] * poses.origin[:, 1:]
    loads = np.cross(lever, gravity)
    loads[:, poses.slides] = (behind[:, None] * gravity)[poses.slides]
    push = normal_force * np.einsum("naj,na->nj", poses.jacobian[0], poses.tool_axis)
    return np.asarray(push - np.einsum("nja,nja->nj", poses.axis, loads))


_TRIES = 4096
_CLIMBED = 16
_ROUNDS = 500
_GAIN = 1e-13  # m; a round that brings less is the last


def farthest_reach(robot: Robot, shoulder: Array) -> float:
    """The farthest that the tip gets from a point (3,) on the first joint's axis, m.

    Prismatic joints stand at zero. From the best of many configurations, always the same ones, one
    joint after the other is turned to where the tip is farthest: opposite to the point, as seen
    along the joint's axis.
    """
    tries = np.random.default_rng(0).uniform(-np.pi, np.pi, (_TRIES, robot.joints))
    tries[:, robot.slides] = 0.0
    best = np.argsort(-_distances(robot, tries, shoulder), kind="stable")[:_CLIMBED]
    q, farthest = tries[best], 0.0
    for _ in range(_ROUNDS):
        for joint in robot.turning[1:]:
            poses = forward(robot, q)
            axis, start = poses.axis[:, joint], poses.origin[:, joint + 1]
            moved, away = poses.tip - start, start - shoulder
            q[:, joint] += angle_about(axis, moved, away)
        reached = float(_distances(robot, q, shoulder).max())
        if reached - farthest <= _GAIN:
            break
        farthest = reached
    return farthest


def _distances(robot: Robot, configurations: Array, shoulder: Array) -> Array:
    return np.asarray(np.linalg.norm(forward(robot, configurations).tip - shoulder, axis=1))


@dataclass(frozen=True)
class Conditioning:
    """Thresholds in m^3, or with fewer meters (:func:`conditioning`).

    Attributes:
        min_manipulability, min_task_determinant: what is below is not valid.
        near_singular_determinant: from here on down motions are looked into.
    """

    min_manipulability: float
    min_task_determinant: float
    near_singular_determinant: float


def conditioning(setup: Setup, reach: float, robot: Robot) -> Conditioning:
    """The thresholds of a setup for an arm of a reach in m, whichever way the setup has them.

    The measures are products of so many lengths as the task has rows that are lengths, less one
    for each prismatic joint, whose column of the Jacobian has none.

    Raises:
        InputError: one is in cubic meters and the measures are not; names the key.
    """
    lengths, found = robot.task.lengths - int(robot.slides.sum()), {}
    for table, name in _MEASURES:
        given = getattr(setup, table)
        share, absolute = getattr(given, name), getattr(given, f"{name}_m3")  # the setup has one
        if absolute is not None and lengths != 3:
            message = (
                f"of this arm it is no volume, but m^{lengths}: give a share of that power of the "
                f"reach, {name}"
            )
            raise InputError(None, f"{table}.{name}_m3", message)
        found[name] = float(share * reach**lengths if absolute is None else absolute)
    return Conditioning(**found)


_MEASURES = (
    ("thresholds", "min_manipulability"),
    ("thresholds", "min_task_determinant"),
    ("continuity", "near_singular_determinant"),
)


def nearest_points(p: Array, u: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """The nearest points (3,) of two lines: through p along u, and through q along v.

    If the lines are parallel, p and the point of the other line beside it.
    """
    cosine = u @ v
    sine = 1.0 - cosine**2
    along = ((q - p) @ u - cosine * ((q - p) @ v)) / sine if sine > 1e-12 else 0.0
    here = p + along * u
    return here, q + ((here - q) @ v) * v


def angle_about(axes: Array, first: Array, second: Array) -> Array:
    """The angle (...,) in rad, in (-pi, pi], by which axes turn the first vector into the second.

    All are (..., 3), axes of unit length. Parts of both vectors along the axes do not count.
    """
    sine = np.einsum("...i,...i->...", axes, np.cross(first, second))
    along = np.einsum("...i,...i->...", axes, first) * np.einsum("...i,...i->...", axes, second)
    return np.asarray(np.arctan2(sine, np.einsum("...i,...i->...", first, second) - along))


def turned_about(axes: Array, vectors: Array, angles: Array) -> Array:
    """Vectors (..., 3) turned about unit vectors (..., 3) by angles (...,) in rad."""
    sine, cosine = np.sin(angles)[..., None], np.cos(angles)[..., None]
    along = np.einsum("...i,...i->...", vectors, axes)[..., None] * axes
    return np.asarray(along + cosine * (vectors - along) + sine * np.cross(axes, vectors))


def frames_along(directions: Array) -> Array:
    """Right-handed frames (n, 3, 3) with unit vectors (n, 3) as their z axes."""
    return np.concatenate([two_across(directions), directions[:, None]], axis=1).transpose(0, 2, 1)


def one_across(direction: Array) -> Array:
    """A unit vector (3,) at right angles to another one."""
    return np.asarray(two_across(direction[None])[0, 0])
