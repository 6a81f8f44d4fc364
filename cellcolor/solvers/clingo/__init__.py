"""Somebody else's solver on another model of the same problem: clingo and answer set programming.

The model is ``models/constraints/coloring.lp``. Nothing is shared with the other solvers, which
makes it a witness beside them and something to be compared with (docs/benchmarks.md). It needs the
extra ``peers``.
"""

from cellcolor.solvers.clingo.solver import ClingoSolver, asp_facts

__all__ = ["ClingoSolver", "asp_facts"]
