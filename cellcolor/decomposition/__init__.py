"""From a labelled surface to its topological graph (paper, section III-C)."""

from cellcolor.decomposition.cells import Decomposition, decompose, decomposition_of
from cellcolor.decomposition.on_mesh import locate

__all__ = ["Decomposition", "decompose", "decomposition_of", "locate"]
