"""What planners pay that choose the path first and the branches of the arm along it.

The count is optimistic: going from one point to the next in the same branch is taken for
continuous, and passing what is out of reach costs nothing. So a planner that follows this path pays
at least that much.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Index, Mask
from cellcolor.data.surface import LabelledSurface

__all__ = ["fewest_lift_offs", "raster"]


def raster(surface: LabelledSurface, angle: float) -> Index:
    """The vertices in the order of a raster path.

    Args:
        surface: the surface. It is seen from where its normals point to on average.
        angle: of the strips, in the plane of that view, rad. They are as wide as the vertices are
            apart on average.
    """
    corners = surface.vertices[surface.faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).sum(axis=0)
    # The two other right singular vectors of the normal are a basis of the plane.
    plane = np.linalg.svd(normal[None])[2][1:]
    x, y = plane @ (surface.vertices - surface.vertices.mean(axis=0)).T
    along, across = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
    width = np.sqrt(surface.vertex_areas.sum() / len(surface.vertices))
    # Strips without a vertex are not counted, so that every next one runs the other way.
    strip = np.unique(np.floor((across - across.min()) / width), return_inverse=True)[1]
    return np.lexsort((np.where(strip % 2, -along, along), strip))


def fewest_lift_offs(valid: Mask) -> int:
    """The fewest changes of branch along a path.

    Staying in a branch for as long as any lasts is best: whoever changes earlier is not further on
    at the next change.

    Args:
        valid: (n, branches) which branches reach each point of the path, one at least.
    """
    lift_offs = 0
    left = valid[0]
    for here in valid:
        left = left & here
        if not left.any():
            lift_offs += 1
            left = here
    return lift_offs
