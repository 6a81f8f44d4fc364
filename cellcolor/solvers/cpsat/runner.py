"""Running CP-SAT models one after the other until the deadline or Ctrl-C."""

from __future__ import annotations

from collections.abc import Callable

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.interface import Options
from cellcolor.solvers.interruptible import make_cp_solver, make_portfolio, solve_interruptibly

STRATEGIES = "no_lp", "default_lp", "core"
"""Of one or two workers, in turns. Without a linear relaxation divisions are found, with it bounds;
the last one raises the bound by cores, sets of literals of which some must cost a segment."""

Solve = Callable[[cp_model.CpModel], tuple[cp_model.CpSolver, cp_model.CpSolverStatus]]
"""Solves a model within limits that it knows; hands back the solver and its status."""


class Runner:
    """Solves models with the options' workers and seed.

    Args:
        options: how to solve.
    """

    def __init__(self, options: Options) -> None:
        self._options = options
        self._stopped = False

    @property
    def over(self) -> bool:
        """Whether there is no time left, or Ctrl-C came."""
        return self._stopped or self._options.deadline.over

    def portfolio(self, deadline: Deadline) -> cp_model.CpSolver:
        """A solver with the options' workers."""
        return make_portfolio(deadline, self._options.workers, self._options.seed, STRATEGIES)

    def single(self, effort: float, deadline: Deadline) -> cp_model.CpSolver:
        """A solver with one worker, for models that are too small for a portfolio.

        Args:
            effort: deterministic seconds.
        """
        return make_cp_solver(deadline, 1, self._options.seed, effort)

    def solve(
        self,
        solver: cp_model.CpSolver,
        model: cp_model.CpModel,
        found: Callable[[int], None] | None = None,
    ) -> cp_model.CpSolverStatus:
        """Solve a model; after an interrupt that ends the search there is no time left.

        Args:
            solver: see above.
            found: called with the objective of each better solution, in a thread of the solver.
        """
        status, interrupt = solve_interruptibly(solver, model, found)
        if interrupt is not None:
            self._stopped = True
            if not isinstance(interrupt, OutOfTime):
                raise interrupt
        return status
