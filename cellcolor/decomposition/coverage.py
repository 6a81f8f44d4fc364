"""What part of a surface has colors, by the areas of the barycentric dual of its mesh."""

from __future__ import annotations

import numpy as np

from cellcolor.data.coverage import Coverage
from cellcolor.data.surface import LabelledSurface


def coverage_of(surface: LabelledSurface) -> Coverage | None:
    """How much of a surface is unreachable or given up; None if it has no area at all."""
    areas = surface.vertex_areas
    total = float(areas.sum())
    if not 0 < total < np.inf:
        return None
    given_up = list(surface.given_up)
    unreachable = np.array([not colors for colors in surface.vertex_colors])
    unreachable[given_up] = False
    shares = (float(areas[own].sum()) / total for own in (unreachable, given_up))
    first, second = (round(min(share, 1.0), 12) for share in shares)
    return Coverage(float(f"{total:.12g}"), first, second)
