"""The paper's depth-first enumerative solver, to be read with the paper.

- ``graph``: section III-C, cells as cyclic lists of topological edges
- ``cell_schemes``: section IV, the codes of 0, 1, × and brackets of one cell
- ``search``: section V, the graph solved cell by cell, with the cost of section V-A; and of section
  IV-C, zeros are moved outside the brackets. Not in the paper: a lower bound from a set cover
  (solver ``dfs-cover``)
"""

from cellcolor.solvers.dfs.solver import CoverReferenceSolver, ReferenceSolver

__all__ = ["CoverReferenceSolver", "ReferenceSolver"]
