"""Tables of other planners made whole: what they leave out is added from the scene's arm."""

from __future__ import annotations

import numpy as np

from cellcolor.data.trajectory import ExtraLiftOff, RepeatedStretch, Trajectory
from cellcolor.data.trajectory_csv import TrajectoryTable
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.robot import Robot
from cellcolor.trajectory_checker.dense import poses_of, strokes_of
from cellcolor.trajectory_checker.fault_list import stretches

_REASON = "stated in the table"


def completed(table: TrajectoryTable, robot: Robot, deadline: Deadline = NEVER) -> Trajectory:
    """A table as a trajectory of an arm.

    Points and normals that it does not have are those that its joints give, times the numbers of
    the samples, and segments those of the strokes.

    Raises:
        InputError: it has another number of joints.
    """
    joints, count = table.joints, len(table.joints)
    if joints.shape[1] != robot.joints:
        message = f"there are {joints.shape[1]} joints, the arm has {robot.joints}"
        raise InputError(None, "line 1", message)
    if table.poses is None:
        points, axes = poses_of(robot, joints, deadline)
        normals = -axes
    else:
        points, normals = table.poses[:, :3], table.poses[:, 3:]
    segment = strokes_of(table.contact) if table.segment is None else table.segment
    return Trajectory(
        name=table.name,
        joint_names=robot.joint_names,
        times=np.arange(count, dtype=np.float64) if table.times is None else table.times,
        joints=joints,
        points=points,
        normals=normals,
        contact=table.contact,
        segment=segment,
        unplanned=tuple(np.flatnonzero(table.unplanned).tolist()),
        extra_lift_offs=tuple(
            ExtraLiftOff(k, int(segment[k]), _REASON, _REASON, tuple(points[k].tolist()))
            for k in np.flatnonzero(table.extra_lift_off).tolist()
        ),
        repeated=tuple(
            RepeatedStretch(first, after - 1, _REASON) for first, after in stretches(table.repeated)
        ),
    )
