"""Every random family by name, and who draws from it (docs/how-to/add-a-family.md)."""

from __future__ import annotations

from collections.abc import Callable

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import growing, large, medium, small
from cellcolor.lab.families.blobs import blobs
from cellcolor.lab.families.meshes import SHAPES

Family = Callable[[int], Instance | LabelledSurface]
"""The instance that a family makes of a seed, always the same of the same seed."""

SMALL: dict[str, Family] = {
    "graphs": small.small_graph,
    "graphs with self-edges": small.small_graph_with_self_edges,
    "hubs": small.small_hub,
    "grids of hubs": small.small_hub_grid,
    "smooth blobs": small.small_blobs,
    "thin blobs": small.small_thin_blobs,
    "rim": small.small_rim,
    "cracks": small.small_cracks,
    "islands, holes": small.small_islands_and_holes,
}
"""What every solver can bear, a depth-first search among them: campaigns take them in turn."""

MEDIUM: dict[str, Family] = {
    "blobs": blobs,
    "more waves": medium.more_waves,
    "cracks": medium.cracks,
    "islands, holes": medium.islands_and_holes,
    "rim": medium.rim,
    "thin": medium.thin,
    "48 × 48 points, 8 colors": medium.points_48,
    "64 × 64 points, 10 colors": medium.points_64,
}
"""As hard as real scenes."""

LARGE: dict[str, Family] = {
    **{topology: large.large_voronoi(topology) for topology in SHAPES},
    "parts": large.large_part,
    "loops": large.large_hub_with_loops,
    "petals": large.large_hub,
    "trees": large.large_tree,
    "grids": large.large_hub_grid,
    "patches": large.large_patches,
}
"""At the limits of the solvers and beyond: ``benchmarks/limits.py``."""

GROWING: dict[str, Family] = {
    "blobs": growing.growing_blobs,
    "hubs": growing.growing_hub,
    "grids of hubs": growing.growing_hub_grid,
}
"""Larger and larger with the seed, to see where solvers reach their limits."""
