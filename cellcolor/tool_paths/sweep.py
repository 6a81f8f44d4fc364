"""A field to sweep a part along: its level lines are parallel, and as few as possible."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.tool_paths.level_lines import slice_along
from cellcolor.tool_paths.triangles import Triangles


def sweep_field(mesh: Triangles) -> tuple[Triangles, Array]:
    """A mesh and the distance of its vertices from a line through its middle, m, with a sign.

    For two points p and q at distances a and b, (a² - b²) / (2 pq) is in a plane how far a point
    is along the line from p to q. Four such coordinates are tried: along the part, across it and
    between the two. The one that the part is narrowest along is kept, and its line 0 is where
    distances are measured from, so that level lines are parallel on a curved surface as well.

    Returns:
        The mesh with the middle line among its edges, and the field, from its least to its
        greatest value where the part is narrow.
    """
    far = mesh.distances_from(np.array([0]))
    first = int(far.argmax())
    along = _coordinate(mesh, first, int(mesh.distances_from(np.array([first])).argmax()))
    middle = np.flatnonzero(np.abs(along) <= mesh.lengths.max())
    if len(middle) < 2:
        return mesh, along
    one = int(middle[mesh.distances_from(middle[:1])[middle].argmax()])
    other = int(middle[mesh.distances_from(np.array([one]))[middle].argmax()])
    across = _coordinate(mesh, one, other) if one != other else along
    tried = [across, along, (along + across) / np.sqrt(2), (along - across) / np.sqrt(2)]
    chosen = min(tried, key=lambda field: float(np.ptp(field)))
    # Line 0 lies midway between both ends, if the part has something there.
    chosen = chosen - (chosen.min() + chosen.max()) / 2
    sliced = slice_along(mesh, chosen, np.array([0.0]))
    line = np.flatnonzero(sliced.level == 0)
    if not len(line):
        return mesh, chosen
    return sliced.mesh, np.sign(sliced.values) * sliced.mesh.distances_from(line)


def _coordinate(mesh: Triangles, p: int, q: int) -> Array:
    """How far each vertex is along the line from one vertex to another, 0 midway."""
    a, b = (mesh.distances_from(np.array([end])) for end in (p, q))
    return np.asarray((a**2 - b**2) / (2 * max(float(a[q]), 1e-12)))
