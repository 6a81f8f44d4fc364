"""The paper's depth-first enumerative solver, to be read with sections IV and V.

``cell_schemes`` enumerates the schemes of one cell (section IV), ``search`` paints the graph cell
by cell (section V), carries the cost (section V-A), and checks what a complete painting shows
across its edges in state 0, ``graph`` is the topological graph as all of
them see it.
"""

from cellcolor.solvers.dfs.cell_schemes import code, divisions
from cellcolor.solvers.dfs.literal_cost import literal_cost
from cellcolor.solvers.dfs.solver import ReferenceSolver

__all__ = ["ReferenceSolver", "code", "divisions", "literal_cost"]
