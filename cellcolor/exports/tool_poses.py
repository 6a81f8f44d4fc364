"""Tool paths as YAML in the layout of Noether, ROS-Industrial's planner of tool paths.

Three lists in each other: Noether's "tool paths" are here the segments of the painting, a "tool
path" is what is driven on one segment, and a "tool path segment" is one path without a lift-off, a
list of poses ``x y z qx qy qz qw`` (m, unit quaternion). A pose's z axis is the surface's outward
normal, and its x axis the direction of travel.
"""

from __future__ import annotations

import re

import numpy as np

from cellcolor.arrays import Array, unit
from cellcolor.exports.interface import PlannedMotion
from cellcolor.files.writing import FileKind

_MARK = "# cellcolor: tool paths, a list of paths for each segment, poses in m\n"

KIND = FileKind("a file of tool paths written by cellcolor", re.compile(re.escape(_MARK).encode()))


def tool_paths_yaml(planned: PlannedMotion) -> bytes:
    """The poses of all paths, segment by segment."""
    lines = [_MARK]
    for segment in range(len(planned.fills)):
        paths = [path for path in planned.paths.paths if path.segment == segment]
        if not paths:
            lines.append("- []\n")
        for number, path in enumerate(paths):
            z = unit(path.normals)
            turns = quaternions(_travel(path.points, z), z)
            poses = np.concatenate([path.points, turns], axis=1)
            for row, pose in enumerate(poses.tolist()):
                outer = "- " if number == row == 0 else "  "
                middle = "- " if row == 0 else "  "
                keys = zip(("x", "y", "z", "qx", "qy", "qz", "qw"), pose, strict=True)
                members = ", ".join(f"{key}: {value:.9f}" for key, value in keys)
                lines.append(f"{outer}{middle}- {{{members}}}\n")
    return "".join(lines if len(lines) > 1 else [_MARK, "[]\n"]).encode()


def _travel(points: Array, z: Array) -> Array:
    """(k, 3) unit vectors across the normals: the way to the next point, at the end from the last.

    Where there is none, because points coincide or follow each other along the normal, it is the
    way at the last point that has one, or else any.
    """
    steps = np.diff(points, axis=0)
    ahead = _across(np.concatenate([steps, steps[-1:]]), z)
    rows = np.arange(len(z))
    last = np.maximum.accumulate(np.where(ahead.any(axis=1), rows, 0))
    for other in (ahead[last], np.eye(3)[np.argmin(np.abs(z), axis=1)]):
        ahead = np.where(ahead.any(axis=1, keepdims=True), ahead, _across(other, z))
    return ahead


def _across(vectors: Array, z: Array) -> Array:
    """(k, 3) the part of each vector across z as a unit vector, zero where there is none."""
    part = vectors - np.sum(vectors * z, axis=1, keepdims=True) * z
    lengths = np.linalg.norm(part, axis=1, keepdims=True)
    clear = lengths > 1e-9
    return np.asarray(np.where(clear, part / np.where(clear, lengths, 1), 0))


def quaternions(x: Array, z: Array) -> Array:
    """Quaternions (k, 4) x, y, z, w of the rotations with columns x, z cross x, and z (k, 3).

    Of the two that are one rotation, each is the one nearer to the one before; the first has no
    negative w.
    """
    matrix = np.stack([x, np.cross(z, x), z], axis=2)
    # Each row of this symmetric matrix is the quaternion times four of its own members (Shepperd,
    # 1978); the row of the largest member is the one to divide by.
    xx, yy, zz = matrix[:, 0, 0], matrix[:, 1, 1], matrix[:, 2, 2]
    products = np.empty((len(x), 4, 4))
    products[:, 0, 0] = 1 + xx - yy - zz
    products[:, 1, 1] = 1 - xx + yy - zz
    products[:, 2, 2] = 1 - xx - yy + zz
    products[:, 3, 3] = 1 + xx + yy + zz
    for a, b in ((0, 1), (0, 2), (1, 2)):
        products[:, a, b] = products[:, b, a] = matrix[:, a, b] + matrix[:, b, a]
    for a, (row, column) in enumerate(((2, 1), (0, 2), (1, 0))):
        products[:, a, 3] = products[:, 3, a] = matrix[:, row, column] - matrix[:, column, row]
    largest = np.argmax(np.diagonal(products, axis1=1, axis2=2), axis=1)
    turns = unit(products[np.arange(len(x)), largest])
    nearer = np.sum(turns[1:] * turns[:-1], axis=1)
    first = np.where(turns[:1, 3] < 0, -1.0, 1.0)
    signs = np.cumprod(np.concatenate([first, np.where(nearer < 0, -1.0, 1.0)]))
    return np.asarray(turns * signs[:, None])
