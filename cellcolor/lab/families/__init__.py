"""Random instance families, made on demand: labelled surfaces, and graphs without a surface.

All of them are functions of a seed and a few numbers; the same arguments give the same instance.
``registry`` has those that need a seed only, by name, for tests and benchmarks.
"""

from cellcolor.lab.families.graphs import hub as hub
from cellcolor.lab.families.graphs import hub_grid as hub_grid
from cellcolor.lab.families.graphs import hub_minimum as hub_minimum
from cellcolor.lab.families.graphs import hub_with_loops as hub_with_loops
from cellcolor.lab.families.graphs import planar_graph as planar_graph
from cellcolor.lab.families.meshes import SHAPES as SHAPES
from cellcolor.lab.families.meshes import Topology as Topology
from cellcolor.lab.families.registry import GROWING as GROWING
from cellcolor.lab.families.registry import LARGE as LARGE
from cellcolor.lab.families.registry import MEDIUM as MEDIUM
from cellcolor.lab.families.registry import SMALL as SMALL
from cellcolor.lab.families.registry import Family as Family
from cellcolor.lab.families.surfaces import blobs as blobs
from cellcolor.lab.families.surfaces import voronoi as voronoi
