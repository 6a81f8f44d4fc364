"""Whole poses of the tool, its turn about its axis included.

A setup's rule gives the turn (docs/frontend.md). A whole pose is reduced to the pose of a tool on
the last joint's axis. The last joint is the last one that turns: a prismatic one behind it only
moves the tool along.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import forward, turned
from cellcolor.frontend.arm.last_joint import pose_at_zero
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import nearest_points
from cellcolor.frontend.arm.task_space import FREE_TURN
from cellcolor.frontend.setup import Turn

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


def turned_about(directions: Array, across: Array, angles: Array) -> Array:
    """Vectors (n, 3) across unit vectors (n, 3), turned about these by angles (n,) in rad."""
    cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
    return np.asarray(cosine * across + sine * np.cross(directions, across))


def angle_about(directions: Array, first: Array, second: Array) -> Array:
    """By which angle (n,) in rad, in (-pi, pi], second follows from first about unit vectors.

    All (n, 3); the first and the second may have parts along the unit vectors, which do not count.
    """
    sine = np.einsum("ni,ni->n", directions, np.cross(first, second))
    along = np.einsum("ni,ni->n", directions, first) * np.einsum("ni,ni->n", directions, second)
    return np.asarray(np.arctan2(sine, np.einsum("ni,ni->n", first, second) - along))


_PARALLEL = 1e-6  # rad
_SAME_HEIGHT = 1e-6  # m
_LEAST = 0.01  # m; no tool on the axis ends nearer to the wrist than this


def wrist_of(robot: Robot) -> Array:
    """Where the last axis is nearest to the one before it, (3,) with all joints at zero, m.

    If they are parallel, where it is nearest to the tip.
    """
    poses = pose_at_zero(robot)
    axes, origins = poses.axis[0, robot.turning], poses.origin[0, 1:][robot.turning]
    if np.linalg.norm(np.cross(axes[-1], axes[-2])) < _PARALLEL:
        return np.asarray(origins[-1] + ((poses.tip[0] - origins[-1]) @ axes[-1]) * axes[-1])
    return nearest_points(origins[-1], axes[-1], origins[-2], axes[-2])[0]


def shoulder_of(robot: Robot) -> Array:
    """The same of the first axis and the second."""
    poses = pose_at_zero(robot)
    axes, origins = poses.axis[0, robot.turning], poses.origin[0, 1:][robot.turning]
    if np.linalg.norm(np.cross(axes[0], axes[1])) < _PARALLEL:
        return np.asarray(origins[0] + ((poses.tip[0] - origins[0]) @ axes[0]) * axes[0])
    return nearest_points(origins[0], axes[0], origins[1], axes[1])[0]


def last_frames(
    robot: Robot, points: Array, directions: Array, across: Array
) -> tuple[Array, Array]:
    """Where the frame behind the last joint is, with the tool in some poses.

    Args:
        points: (n, 3) of the tip, m.
        directions, across: (n, 3) unit vectors of the tool's z and x axis, at right angles.

    Returns:
        Rotations (n, 3, 3) and origins (n, 3) in m.
    """
    tools = np.stack([across, np.cross(directions, across), directions], axis=2)
    rotation = tools @ robot.tip[:3, :3].T
    return rotation, points - turned(rotation, robot.tip[:3, 3])


def on_last_axis(robot: Robot) -> Robot:
    """The same arm with another tool, whose turn is free: on the last axis, beside the true tip.

    Its z axis goes along the last axis, away from the wrist, to the true tip's side. A tip at the
    wrist's height has no side, as behind two parallel axes: there the true tool's z axis decides,
    since an arm whose axes are all parallel points its tool one way only.
    """
    poses, wrist = pose_at_zero(robot), wrist_of(robot)
    axis = poses.axis[0, robot.turning[-1]]
    out = float((poses.tip[0] - wrist) @ axis)
    side = out if abs(out) > _SAME_HEIGHT else float(poses.tool_axis[0] @ axis)
    sense = -1.0 if side < 0 else 1.0
    foot = wrist + sense * max(abs(out), _LEAST) * axis
    within = poses.rotation[0, -1].T
    tip = np.eye(4)
    z = within @ (sense * axis)
    x = _any_across(z)
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
    across = _any_across(axis)
    have, wanted = turned(poses.rotation[:, -1], across), turned(rotation, across)
    found[:, last] = angle_about(poses.axis[:, last], have, wanted)
    return found


def _any_across(direction: Array) -> Array:
    """A unit vector (3,) at right angles to another one."""
    across = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
    return np.asarray(across / np.linalg.norm(across))
