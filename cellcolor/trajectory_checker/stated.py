"""What a trajectory states of itself: points and normals, lift-offs.

What a table of another planner leaves out is added from the scene's arm.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, stretch_of, stretches, unit
from cellcolor.data.trajectory import ExtraLiftOff, RepeatedStretch, Trajectory, TrajectoryTable
from cellcolor.data.wording import count
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.arm.robot import Robot
from cellcolor.trajectory_checker.dense import angles, poses_of
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.tolerances import POSE_ANGLE, POSE_DISTANCE


def judge_poses(robot: Robot, axes: Array, faults: FaultList) -> None:
    """Note samples whose stated point or normal is another one.

    Joints only give the normal where the task holds the tool against it.

    Args:
        axes: (k, 3) of the tool, unit vectors, as forward kinematics gives them.
    """
    trajectory = faults.trajectory
    apart = np.linalg.norm(trajectory.points - faults.tips, axis=1)
    turned = np.zeros(len(axes))
    if robot.task.direction:
        lengths = np.linalg.norm(trajectory.normals, axis=1)
        turned = np.where(lengths > 0, angles(unit(trajectory.normals), -axes), np.pi)
    wrong = (apart > POSE_DISTANCE) | (turned > POSE_ANGLE)
    faults.add_stretches(
        "pose",
        wrong,
        np.maximum(apart / POSE_DISTANCE, turned / POSE_ANGLE),
        lambda k: (
            f"the joints put the tip {1000 * apart[k]:.4g} mm off the trajectory's own point, the "
            f"tool's axis {np.degrees(turned[k]):.4g} degrees off its own normal"
        ),
    )


def judge_lift_offs(minimum: int | None, faults: FaultList) -> None:
    """Note lift-offs that are stated but not there, and a number that the proof contradicts.

    The proof is for the whole surface. Where a segment is stated to be left out and is never
    touched, one fewer does not contradict it: with that segment the division would be whole again.
    """
    trajectory = faults.trajectory
    ends = {after - 1 for _, after in trajectory.strokes[:-1]}
    stated = {extra.sample for extra in trajectory.extra_lift_offs}
    for extra in trajectory.extra_lift_offs:
        if extra.sample not in ends:
            text = "an extra lift-off is announced after this sample, but there is none"
            faults.add("claim", text, extra.sample, place=np.array(extra.place))
    if minimum is None:
        return
    found = count(trajectory.lift_offs, "lift-off")
    said = f"{len(stated) or 'none'} announced as extra"
    needed = trajectory.lift_offs - len(stated & ends)
    touched = set(trajectory.segment[trajectory.contact].tolist())
    skipped = {part.segment for part in trajectory.left_out} - touched
    if needed < minimum - len(skipped):
        text = (
            f"{found}, {said}: that contradicts the proved minimum of {minimum}, so something is "
            "left out, or a place is covered twice in different branches"
        )
        faults.add("lift-offs", text)
    elif needed > minimum:
        faults.add("lift-offs", f"{found}, {said}, and {minimum} are proved to be enough")


_REASON = "stated in the table"


def completed(table: TrajectoryTable, robot: Robot, deadline: Deadline = NEVER) -> Trajectory:
    """A table as a trajectory of an arm.

    Points and normals that it does not have are those that its joints give, times the numbers of
    the samples, and segments those of the strokes.

    Raises:
        InputError: it has another number of joints.
    """
    joints, poses, columns = table.joints, table.poses, table.columns
    contact = table.marked("contact")
    if joints.shape[1] != robot.joints:
        message = f"there are {joints.shape[1]} joints, the arm has {robot.joints}"
        raise InputError(None, "line 1", message)
    if poses is None:
        points, axes = poses_of(robot, joints, deadline)
        normals = -axes
    else:
        points, normals = poses[:, :3], poses[:, 3:]
    segment = columns.get("segment", stretch_of(contact)).astype(np.int64)
    return Trajectory(
        name=table.name,
        joint_names=robot.joint_names,
        times=columns.get("time_s", np.arange(len(joints), dtype=np.float64)),
        joints=joints,
        points=points,
        normals=normals,
        contact=contact,
        segment=segment,
        unplanned=tuple(np.flatnonzero(table.marked("unplanned")).tolist()),
        extra_lift_offs=tuple(
            ExtraLiftOff(k, int(segment[k]), _REASON, _REASON, tuple(points[k].tolist()))
            for k in np.flatnonzero(table.marked("extra_lift_off")).tolist()
        ),
        repeated=tuple(
            RepeatedStretch(first, after - 1, _REASON)
            for first, after in stretches(table.marked("repeated"))
        ),
    )
