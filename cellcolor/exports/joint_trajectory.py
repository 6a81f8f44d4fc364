"""The trajectory as ROS 2 messages ``trajectory_msgs/msg/JointTrajectory``, as YAML.

One document for each stretch that was planned. So where a move could not be planned the file ends
one message and begins another, and nobody who plays a message drives that move.
"""

from __future__ import annotations

import json
import re
from itertools import pairwise

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.trajectory import Trajectory
from cellcolor.errors import InputError
from cellcolor.exports.interface import PlannedMotion
from cellcolor.files.writing import FileKind

_MARK = "# cellcolor: trajectory_msgs/msg/JointTrajectory, rad, rad/s, s\n"
_NANO = 1_000_000_000

KIND = FileKind("a joint trajectory written by cellcolor", re.compile(re.escape(_MARK).encode()))


def joint_trajectory_yaml(planned: PlannedMotion) -> bytes:
    """Positions, velocities and times of all samples, one message for each planned stretch.

    A message begins and ends at rest. In between, velocities are those of the parabola through a
    sample and its two neighbors.

    Raises:
        InputError: two samples have the same nanosecond, or the later one comes first.
    """
    trajectory = planned.trajectory
    cuts = [0, *(sample + 1 for sample in trajectory.unplanned), len(trajectory.times)]
    names = json.dumps(list(trajectory.joint_names))  # in YAML as well
    messages = [
        _message(trajectory, names, first, last) for first, last in pairwise(cuts) if last > first
    ]
    return (_MARK + "---\n".join(messages)).encode()


def _message(trajectory: Trajectory, names: str, first: int, last: int) -> str:
    """The samples from the first up to the one before the last, from time zero on."""
    times, joints = trajectory.times[first:last], trajectory.joints[first:last]
    nanoseconds = np.round((times - times[0]) * _NANO).astype(np.int64)
    early = np.flatnonzero(np.diff(nanoseconds) <= 0)
    if len(early):
        field = f"times[{first + int(early[0]) + 1}]"
        raise InputError(None, field, "is not later than the one before")
    lines = [
        'header: {stamp: {sec: 0, nanosec: 0}, frame_id: ""}\n',
        f"joint_names: {names}\n",
        "points:\n",
    ]
    for time, position, velocity in zip(
        nanoseconds.tolist(), joints.tolist(), _velocities(times, joints).tolist(), strict=True
    ):
        lines.append(
            f"- positions: [{_listed(position)}]\n"
            f"  velocities: [{_listed(velocity)}]\n"
            f"  time_from_start: {{sec: {time // _NANO}, nanosec: {time % _NANO}}}\n"
        )
    return "".join(lines)


def _velocities(times: Array, joints: Array) -> Array:
    """(k, joints) in rad/s."""
    found = np.zeros_like(joints)
    if len(times) > 2:
        found[1:-1] = np.gradient(joints, times, axis=0)[1:-1]
    return found


def _listed(numbers: list[float]) -> str:
    return ", ".join(f"{number:.9f}" for number in numbers)
