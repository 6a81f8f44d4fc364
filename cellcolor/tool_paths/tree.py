"""The pattern ``tree``: a walk round a spanning tree of strips, whatever the region is like."""

from __future__ import annotations

import numpy as np

from cellcolor.deadline import Deadline
from cellcolor.tool_paths.contour import FINEST, lay_loops
from cellcolor.tool_paths.interface import Laid
from cellcolor.tool_paths.level_lines import slice_along
from cellcolor.tool_paths.sweep import sweep_field
from cellcolor.tool_paths.triangles import Triangles


def lay_tree(mesh: Triangles, spacing: float, deadline: Deadline) -> Laid:
    """Cut the region in strips of two spacings, go round each, and join these along a tree."""
    mesh, field = sweep_field(mesh.refined(FINEST * spacing))
    deadline.check()
    low, high = float(field.min()), float(field.max())
    strips = max(1, round((high - low) / (2 * spacing)))
    sliced = slice_along(mesh, field, np.linspace(low, high, strips + 1)[1:-1])
    mesh = sliced.mesh
    ends = np.flatnonzero(mesh.border | (sliced.level >= 0))
    distances = mesh.distances_from(ends if len(ends) else np.array([0]))
    return lay_loops(mesh, distances, spacing, deadline)
