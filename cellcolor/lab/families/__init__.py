"""Random instance families, made on demand: labelled surfaces, and graphs without a surface.

All of them are functions of a seed and a few numbers; the same arguments give the same instance.
``registry`` has those that need a seed only, by name, for campaigns and benchmarks.
"""

from cellcolor.lab.families.blobs import blobs
from cellcolor.lab.families.graphs import planar_graph
from cellcolor.lab.families.hubs import (
    cover_tree,
    hub,
    hub_grid,
    hub_minimum,
    hub_with_loops,
    wide_hub,
)
from cellcolor.lab.families.meshes import SHAPES, Topology
from cellcolor.lab.families.parts import part
from cellcolor.lab.families.registry import GROWING, LARGE, MEDIUM, SMALL, Family
from cellcolor.lab.families.voronoi import voronoi

__all__ = [
    "GROWING",
    "LARGE",
    "MEDIUM",
    "SHAPES",
    "SMALL",
    "Family",
    "Topology",
    "blobs",
    "cover_tree",
    "hub",
    "hub_grid",
    "hub_minimum",
    "hub_with_loops",
    "part",
    "planar_graph",
    "voronoi",
    "wide_hub",
]
