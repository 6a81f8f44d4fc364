"""The trajectory as ROS 2 messages ``trajectory_msgs/msg/JointTrajectory``, as YAML.

One document for each stretch that was planned. So where a move could not be planned the file ends
one message and begins another, and nobody who plays a message drives that move.
"""

from __future__ import annotations

import json
import re

import numpy as np

from cellcolor.exports.interface import PlannedMotion
from cellcolor.exports.samples import Samples, stretches
from cellcolor.files.writing import FileKind

_MARK = "# cellcolor: trajectory_msgs/msg/JointTrajectory, rad, rad/s, s\n"
_NANO = 1_000_000_000

KIND = FileKind("a joint trajectory written by cellcolor", re.compile(re.escape(_MARK).encode()))


def joint_trajectory_yaml(planned: PlannedMotion) -> bytes:
    """Positions, velocities, accelerations and times, one message for each planned stretch.

    Raises:
        InputError: two samples have the same nanosecond, or the later one comes first.
    """
    names = json.dumps(list(planned.trajectory.joint_names))  # in YAML as well
    found = stretches(planned.trajectory, planned.step_s)
    return (_MARK + "---\n".join(_message(own, names) for own in found)).encode()


def _message(own: Samples, names: str) -> str:
    lines = [
        'header: {stamp: {sec: 0, nanosec: 0}, frame_id: ""}\n',
        f"joint_names: {names}\n",
        "points:\n",
    ]
    nanoseconds = np.round(own.times * _NANO).astype(np.int64)
    numbers = (own.joints, own.velocities, own.accelerations)
    for time, *row in zip(nanoseconds.tolist(), *(a.tolist() for a in numbers), strict=True):
        members = zip(("positions", "velocities", "accelerations"), row, strict=True)
        lines += [
            f"{'  ' if place else '- '}{name}: [{_listed(values)}]\n"
            for place, (name, values) in enumerate(members)
        ]
        lines.append(f"  time_from_start: {{sec: {time // _NANO}, nanosec: {time % _NANO}}}\n")
    return "".join(lines)


def _listed(numbers: list[float]) -> str:
    return ", ".join(f"{number:.9f}" for number in numbers)
