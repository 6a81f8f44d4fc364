"""The motion stroke by stroke, and the moves between: an archive with a table for each."""

from __future__ import annotations

import io
import math
import re
import zipfile
from itertools import pairwise

import numpy as np

from cellcolor.arrays import Array, unit
from cellcolor.exports.interface import PlannedMotion
from cellcolor.exports.samples import Samples, stretches
from cellcolor.exports.tool_poses import quaternions
from cellcolor.files.writing import FileKind

_MARK = b"cellcolor/strokes"
_WRITTEN = (1980, 1, 1, 0, 0, 0)  # the same motion gives the same bytes

KIND = FileKind(
    "an archive of strokes written by cellcolor", re.compile(rb"PK.*" + _MARK + rb"\Z", re.DOTALL)
)


def strokes_zip(planned: PlannedMotion) -> bytes:
    """``001_stroke_segment_0.csv``, ``002_move.csv``, …, in the order in which they are driven.

    The last row of a table is the first of the next one, unless the move there was not planned.
    """
    stream = io.BytesIO()
    number = 0
    with zipfile.ZipFile(stream, "w") as archive:
        for own in stretches(planned.trajectory, planned.step_s):
            cuts = np.flatnonzero(np.diff(own.contact))
            # A stroke has all its samples in contact, and a move both samples around it.
            bounds = [0, *(cuts + own.contact[cuts + 1]).tolist(), len(own.times) - 1]
            for first, last in pairwise(bounds):
                number += 1
                touching = bool(own.contact[first : last + 1].all())
                what = f"stroke_segment_{own.segment[first]}" if touching else "move"
                entry = zipfile.ZipInfo(f"{number:03d}_{what}.csv", _WRITTEN)
                table = _table(own, slice(first, last + 1), planned.force_n)
                archive.writestr(entry, table, zipfile.ZIP_DEFLATED, compresslevel=1)
        archive.comment = _MARK
    return stream.getvalue()


def _table(own: Samples, rows: slice, force_n: float) -> str:
    """Time, contact, feed, force asked for, the tool's pose, joints and their two derivatives."""
    joints = range(1, own.joints.shape[1] + 1)
    head = ["time_s", "contact", "feed_m_per_s", "force_n", "x", "y", "z", "qx", "qy", "qz", "qw"]
    head += [f"{name}{joint}" for name in ("q", "qd", "qdd") for joint in joints]
    points, times = own.points[rows], own.times[rows]
    feed = np.zeros(len(times))
    if len(times) > 1:
        feed = np.linalg.norm(np.gradient(points, times, axis=0), axis=1)
    along = np.column_stack(
        [
            feed, force_n * own.contact[rows], points, steady_frames(own.normals[rows]),
            own.joints[rows], own.velocities[rows], own.accelerations[rows],
        ]
    )  # fmt: skip
    row = "%.9f,%d" + ",%.9f" * along.shape[1]
    contact = own.contact[rows].tolist()
    lines = [
        row % (time, touching, *numbers)
        for time, touching, numbers in zip(times.tolist(), contact, along.tolist(), strict=True)
    ]
    return "\n".join([",".join(head), *lines, ""])


def steady_frames(normals: Array) -> Array:
    """(k, 4) unit quaternions x, y, z, w of tool frames along outward normals (k, 3).

    z points out of the surface. From a frame to the next the turn is the smallest that takes one
    normal to the other, so x does not swing with the line that the tool follows.
    """
    z = unit(normals)
    x = np.empty_like(z)
    start = np.eye(3)[np.argmin(np.abs(z[0]))]
    for row, own in enumerate(z):
        if row:
            before = z[row - 1]
            # The smallest turn from a unit vector to another, of a vector across the first.
            both = 1 + before @ own
            start = start - (start @ own / both) * (before + own) if both > 1e-9 else start
        start = start - (start @ own) * own
        start = start / math.sqrt(start @ start)
        x[row] = start
    return quaternions(x, z)
