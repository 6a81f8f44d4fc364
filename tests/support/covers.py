"""The fewest color regions that a surface needs, by trying all choices."""

from __future__ import annotations

import itertools

from cellcolor.data.surface import LabelledSurface


def covers(surface: LabelledSurface, count: int) -> list[set[str]]:
    """All choices of so many colors that together reach every reachable vertex."""
    needs = {frozenset(colors) for colors in surface.vertex_colors if colors}
    chosen = itertools.combinations(range(len(surface.colors)), count)
    return [
        {surface.colors[color] for color in colors}
        for colors in chosen
        if all(need & set(colors) for need in needs)
    ]
