"""Points on a triangle mesh, so many that distances to them say how far the mesh is.

The way from a point in space to the nearest one of a mesh is at right angles to the face or the
edge that this lies on. So a sample of the same face or edge at most ``slack`` aside of it is known
to be hardly farther away; all corners are samples.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.parts.surface import Faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

__all__ = ["sample_mesh"]


def sample_mesh(vertices: Array, faces: Faces, slack: float, most: int) -> tuple[Array, float]:
    """Points (k, 3) on all faces and edges, and how far these can be from the nearest of their own.

    Edges are cut into equal parts. A face is crossed by rows of points along its longest side, so
    that a long thin face has about as many as its edges, and never as many as a square of its
    length. Between two rows a point is nearer than half their distance to one of them, or to the
    side where the upper one ends, since the angles at the longest side are acute; along rows and
    edges it is nearer than half their step to a point. So with steps of s the slack is s / sqrt(2).

    Args:
        vertices: (n, 3) in m.
        faces: (m, 3), none of them without area.
        slack: wanted, m.
        most: about so many points besides the vertices; more slack is taken to stay below.
    """
    edges = TriangleMesh(vertices, faces).edges
    corners = vertices[faces]
    sides = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)  # ab, bc, ca
    # Turned so that the longest side is the one from a to b.
    order = (np.argmax(sides, axis=1)[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(corners, order[:, :, None], axis=1).swapaxes(0, 1)
    double_area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    height = double_area / sides.max(axis=1)
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    # Of n points at steps of s about length / s lie on edges and area / s^2 on faces.
    half = (lengths.sum() + 2 * height.sum()) / (2 * most)
    step = float(max(np.sqrt(2) * slack, half + np.sqrt(half**2 + double_area.sum() / (2 * most))))

    along_edges = _between(vertices[edges[:, 0]], vertices[edges[:, 1]], lengths, step)
    face, place = _parts(height, step)
    row_start = a[face] + place[:, None] * (c - a)[face]
    row_end = b[face] + place[:, None] * (c - b)[face]
    on_rows = _between(row_start, row_end, np.linalg.norm(row_end - row_start, axis=1), step)
    return np.concatenate([vertices, along_edges, row_start, row_end, on_rows]), step / np.sqrt(2)


def _parts(lengths: Array, step: float) -> tuple[Faces, Array]:
    """Where to cut lengths (k,) into the fewest equal parts of at most ``step``.

    Returns:
        which length, and at what part of it (0 to 1, ends left out).
    """
    counts = np.maximum(np.ceil(lengths / step).astype(np.int64), 1)
    which = np.repeat(np.arange(len(counts)), counts - 1)
    number = np.arange(len(which)) - np.repeat(np.cumsum(counts - 1) - (counts - 1), counts - 1) + 1
    return which, number / counts[which]


def _between(start: Array, end: Array, lengths: Array, step: float) -> Array:
    """Points inside segments (k, 3), at most ``step`` from each other and from the ends."""
    which, place = _parts(lengths, step)
    return np.asarray(start[which] + place[:, None] * (end - start)[which])
