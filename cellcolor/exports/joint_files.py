"""The trajectory itself for other programs: as a table, and as ROS 2 messages in YAML.

The table has a line for each sample, comma-separated, with a header. The messages
``trajectory_msgs/msg/JointTrajectory`` are one document for each stretch that was planned: where a
move could not be planned the file ends one message and begins another, and nobody who plays a
message drives that move.
"""

from __future__ import annotations

import csv
import io
import json
import re

import numpy as np

from cellcolor.data.trajectory import COLUMNS, STATED
from cellcolor.exports.interface import PlannedMotion, Samples, stretches
from cellcolor.files.writing import FileKind

TABLE = FileKind(
    "a table of joints written by cellcolor", re.compile(re.escape(",".join(COLUMNS)).encode())
)


def joints_csv(planned: PlannedMotion) -> bytes:
    """Times (s), segment (-1 between), contact (0 or 1), tip (m), normal, joints (rad).

    The last columns hold what the trajectory states about its samples (repeated, not planned, extra
    lift-off after it), so that the table is judged like the trajectory.
    """
    trajectory = planned.trajectory
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    joints = len(trajectory.joint_names)
    writer.writerow([*COLUMNS, *(f"q{number + 1}" for number in range(joints)), *STATED])
    stated = np.zeros((len(trajectory.times), len(STATED)), dtype=int)
    for stretch in trajectory.repeated:
        stated[stretch.sample : stretch.last_sample + 1, 0] = 1
    stated[list(trajectory.unplanned), 1] = 1
    stated[[extra.sample for extra in trajectory.extra_lift_offs], 2] = 1
    numbers = np.column_stack([trajectory.points, trajectory.normals, trajectory.joints])
    rows = zip(
        trajectory.times.tolist(),
        trajectory.segment.tolist(),
        trajectory.contact.astype(int).tolist(),
        numbers.tolist(),
        stated.tolist(),
        strict=True,
    )
    # Nine decimals: a nanosecond, a nanometer, a nanoradian.
    writer.writerows(
        [f"{time:.9f}", segment, contact, *(f"{number:.9f}" for number in row), *said]
        for time, segment, contact, row, said in rows
    )
    return text.getvalue().encode()


_MARK = "# cellcolor: trajectory_msgs/msg/JointTrajectory, rad, rad/s, s\n"
_NANO = 1_000_000_000

MESSAGES = FileKind(
    "a joint trajectory written by cellcolor", re.compile(re.escape(_MARK).encode())
)


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
