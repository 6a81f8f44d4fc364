"""From a labelled surface to its topological graph (paper, section III-C)."""

from cellcolor.decomposition.cells import decompose

__all__ = ["decompose"]
