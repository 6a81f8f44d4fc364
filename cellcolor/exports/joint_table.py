"""The trajectory as a table: one line a sample, comma-separated, with a header."""

from __future__ import annotations

import csv
import io
import re

import numpy as np

from cellcolor.exports.interface import PlannedMotion
from cellcolor.files.writing import FileKind

_COLUMNS = ("time_s", "segment", "contact", "x", "y", "z", "nx", "ny", "nz")
_STATED = ("repeated", "unplanned", "extra_lift_off")

KIND = FileKind(
    "a table of joints written by cellcolor", re.compile(re.escape(",".join(_COLUMNS)).encode())
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
    writer.writerow([*_COLUMNS, *(f"q{number + 1}" for number in range(joints)), *_STATED])
    stated = np.zeros((len(trajectory.times), len(_STATED)), dtype=int)
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
