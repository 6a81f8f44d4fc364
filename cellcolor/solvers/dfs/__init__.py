"""The paper's depth-first enumerative solver, to be read with sections IV and V.

- ``graph``: the topological graph, prepared for the search.
- ``cell_schemes``: enumerates the schemes of one cell (section IV).
- ``search``: paints the graph cell by cell (section V) and keeps the cost up to date (section V-A).
  It also checks the edges in state 0 of each complete painting.
"""

from cellcolor.solvers.dfs.solver import ReferenceSolver

__all__ = ["ReferenceSolver"]
