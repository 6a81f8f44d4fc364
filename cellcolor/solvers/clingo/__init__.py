"""An independent solver on another model of the same problem: clingo, answer set programming.

The model is ``models/constraints/coloring.lp``. It shares nothing with the other solvers, so its
answers are independent evidence, and it can be compared with them (docs/benchmarks.md). It needs
the extra ``peers``.
"""

from cellcolor.solvers.clingo.solver import ClingoSolver, asp_facts

__all__ = ["ClingoSolver", "asp_facts"]
