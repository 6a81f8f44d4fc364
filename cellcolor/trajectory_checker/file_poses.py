"""Whether the points and normals that a trajectory states are those that its joints give."""

from __future__ import annotations

import itertools

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.trajectory import Trajectory
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.trajectory_checker.dense import angles
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.tolerances import POSE_ANGLE, POSE_DISTANCE

_ASKED = 50  # samples that a guess at swapped columns has to fit


def judge_poses(
    trajectory: Trajectory, robot: Robot, tips: Array, axes: Array, faults: FaultList
) -> None:
    """Note samples whose stated point or normal is another one.

    Joints only give the normal where the task holds the tool against it.

    Args:
        tips, axes: (k, 3) what forward kinematics gives, m and unit vectors.
    """
    apart = np.linalg.norm(trajectory.points - tips, axis=1)
    turned = _turned(robot, trajectory.normals, axes)
    wrong = (apart > POSE_DISTANCE) | (turned > POSE_ANGLE)
    if not wrong.any():
        return
    swapped, joint = _swapped(trajectory, robot, np.flatnonzero(wrong))
    faults.add_stretches(
        "pose",
        wrong,
        np.maximum(apart / POSE_DISTANCE, turned / POSE_ANGLE),
        lambda k: (
            f"the joints put the tip {1000 * apart[k]:.4g} mm off the stated point, the tool's "
            f"axis {np.degrees(turned[k]):.4g} degrees off the stated normal{swapped}"
        ),
        tips,
        joint,
    )


def _turned(robot: Robot, normals: Array, axes: Array) -> Array:
    """How far stated normals (k, 3) are off those that tool axes give, (k,) in rad; pi for none."""
    if not robot.task.direction:
        return np.zeros(len(normals))
    length = np.linalg.norm(normals, axis=1)
    unit = normals / np.where(length > 0, length, 1.0)[:, None]
    return np.where(length > 0, angles(unit, -axes), np.pi)


def _swapped(trajectory: Trajectory, robot: Robot, wrong: Index) -> tuple[str, int | None]:
    """Which two columns were probably swapped, and which joint the first one of them is."""
    asked = wrong[np.unique(np.linspace(0, len(wrong) - 1, _ASKED).astype(int))]
    joints, points, normals = (
        getattr(trajectory, name)[asked] for name in ("joints", "points", "normals")
    )

    def fits(joints: Array, points: Array, normals: Array) -> bool:
        poses = forward(robot, joints)
        near = np.linalg.norm(points - poses.tip, axis=1) <= POSE_DISTANCE
        return bool((near & (_turned(robot, normals, poses.tool_axis) <= POSE_ANGLE)).all())

    def exchanged(columns: Array, i: int, j: int) -> Array:
        order = np.arange(columns.shape[1])
        order[[i, j]] = j, i
        return columns[:, order]

    names = trajectory.joint_names
    for i, j in itertools.combinations(range(joints.shape[1]), 2):
        if fits(exchanged(joints, i, j), points, normals):
            return f"; it fits with {names[i]} and {names[j]} exchanged", i
    poses = np.concatenate([points, normals], axis=1)
    titles = ("x", "y", "z", "nx", "ny", "nz")
    for i, j in itertools.combinations(range(6), 2):
        other = exchanged(poses, i, j)
        if fits(joints, other[:, :3], other[:, 3:]):
            return f"; it fits with {titles[i]} and {titles[j]} exchanged", None
    return "", None
