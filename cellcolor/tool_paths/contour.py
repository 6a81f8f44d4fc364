"""The pattern ``contour``: lines at equal distances from the border, joined into one path."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.tool_paths.joined_loops import join_loops
from cellcolor.tool_paths.registry import Laid
from cellcolor.tool_paths.triangles import (
    Sliced,
    Triangles,
    evened,
    level_lines,
    slice_along,
    with_room_inside,
)

FINEST = 0.5
"""Longest edge of the meshes that level lines are drawn on, in spacings."""
EVENED = 0.3
"""Spacings. Waves of six times that length are made half as high."""
_SMOOTHED = 0.5  # spacings; deviation of the bell curve that a ragged border is smoothed with
_MOVED = 0.3  # spacings; so far the smoothed border is off the true one at most
_FINE = 0.1  # spacings; between the points that it is smoothed at
_NARROWEST, _WIDEST = 0.85, 1.05  # between which spacings are made to fit, in wanted spacings
_CORE = 0.7  # where a core reaches so far, in spacings, inside the last loop, there is one more


def lay_contours(mesh: Triangles, spacing: float, deadline: Deadline) -> Laid:
    """Loops at half a spacing from the border, one and a half, and so on, joined.

    On a closed mesh the distance is from a vertex, and the first loop goes round it.
    """
    mesh = mesh.refined(FINEST * spacing)
    deadline.check()
    bordered = bool(mesh.border.any())
    if bordered:
        distances = mesh.distances_from(*_straight_border(mesh, spacing))
    else:
        distances = mesh.distances_from(np.array([0]))
    distances = evened(mesh, distances, EVENED * spacing)
    # No line ends at the border.
    distances = np.where(mesh.border, np.minimum(distances, _MOVED * spacing), distances)
    return _lay_loops(mesh, distances, spacing, deadline)


def _straight_border(mesh: Triangles, spacing: float) -> tuple[Index, Array]:
    """The vertices of the border, and how far inside of a straighter one they are, m.

    A border that runs between the vertices of a mesh is ragged. Lines at equal distances from it
    would copy every notch inward, up to the middle.
    """
    vertices, offsets = [], []
    for loop in map(np.array, mesh.border_loops()):
        points = mesh.points[[*loop, loop[0]]]
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        count = max(8, int(np.ceil(along[-1] / (_FINE * spacing))))
        grid = along[-1] * np.arange(count + 1) / count
        even = np.stack([np.interp(grid[:-1], along, axis) for axis in points.T], axis=1)
        waves = 2 * np.pi * np.fft.rfftfreq(count, along[-1] / count)
        kept = np.exp(-((_SMOOTHED * spacing * waves) ** 2) / 2)[:, None]
        smooth = np.fft.irfft(kept * np.fft.rfft(even, axis=0), count, axis=0)
        tangent = np.roll(smooth, -1, axis=0) - np.roll(smooth, 1, axis=0)
        there, ahead = (
            np.stack([np.interp(along[:-1], grid, [*axis, axis[0]]) for axis in rows.T], axis=1)
            for rows in (smooth, tangent)
        )
        inward = np.cross(ahead, mesh.normals[loop])  # loops go against the winding
        inward /= np.maximum(np.linalg.norm(inward, axis=1, keepdims=True), 1e-12)
        vertices.append(loop)
        offsets.append(((points[:-1] - there) * inward).sum(axis=1))
    most = _MOVED * spacing
    return np.concatenate(vertices), np.clip(np.concatenate(offsets), -most, most)


def _lay_loops(mesh: Triangles, distances: Array, spacing: float, deadline: Deadline) -> Laid:
    """Join the loops at half a spacing, one and a half, and so on of a field of distances.

    Args:
        mesh: a connected part of a segment, refined.
        distances: (n,) at the border less than ``_NARROWEST`` / 2 spacings, m.
    """
    deadline.check()
    spacing = _fitting(float(distances.max()), spacing)
    levels = spacing * (0.5 + np.arange(int(distances.max() / spacing) + 1))
    levels = levels[levels < distances.max()]
    sliced = slice_along(mesh, distances, levels)
    deadline.check()
    rows = [row for row, _ in level_lines(sliced) if len(row) > 2]
    if not rows:
        return Laid(mesh, [])
    heights = _heights_of_cores(sliced, levels)
    cores = slice_along(sliced.mesh, heights, np.array([_CORE * spacing]))
    rows += [row for row, _ in level_lines(cores) if len(row) > 2]
    deadline.check()
    mesh = with_room_inside(cores.mesh)
    return Laid(mesh, join_loops(mesh, rows, spacing, deadline))


def _fitting(farthest: float, spacing: float) -> float:
    """A spacing near the wanted one with which the innermost lines leave half of it inside.

    Args:
        farthest: from the border, m.
        spacing: the wanted one, m; it is kept where none that fits is near.
    """
    fitting = farthest / max(np.ceil(farthest / (_WIDEST * spacing)), 1.0)  # 0 if all is border
    return float(fitting) if fitting >= _NARROWEST * spacing else spacing


def _heights_of_cores(sliced: Sliced, levels: Array) -> Array:
    """How far each vertex inside an innermost loop is from it; 0 for all other vertices."""
    between = sliced.level < 0
    ends = sliced.mesh.edges
    part = grouped(len(between), ends[between[ends].all(axis=1)])
    number = np.searchsorted(levels, sliced.values) - 1  # the level below a vertex
    inner = ends[(between[ends[:, 0]] != between[ends[:, 1]])]
    inner = np.where(between[inner[:, :1]], inner, inner[:, ::-1])  # from between onto a line
    onward = inner[sliced.level[inner[:, 1]] > number[inner[:, 0]], 0]
    core = between & (number >= 0) & ~np.isin(part, part[onward])
    return np.where(core, sliced.values - levels[np.maximum(number, 0)], 0.0)
