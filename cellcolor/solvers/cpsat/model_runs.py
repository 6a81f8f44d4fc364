"""Running CP-SAT models one after the other until the deadline or Ctrl-C."""

from __future__ import annotations

from collections.abc import Callable

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.interface import Options
from cellcolor.solvers.interruptible import make_cp_solver, make_portfolio, solve_interruptibly

STRATEGIES = "core_max_lp", "max_lp"
"""Of one or two workers. Both use the full linear relaxation; the first one raises the bound by
cores, sets of literals of which some must cost a segment."""

SolveWithSeed = Callable[[cp_model.CpModel, int], tuple[cp_model.CpSolver, cp_model.CpSolverStatus]]
"""Solves a model with a seed, within limits that it knows; hands back the solver and its status."""


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

    def portfolio(
        self, effort: float | None = None, deadline: Deadline | None = None
    ) -> cp_model.CpSolver:
        """A solver with the options' workers.

        Args:
            effort: deterministic seconds per worker, None for all the time left.
            deadline: an earlier one than the options'.
        """
        its = self._options
        return make_portfolio(deadline or its.deadline, its.workers, its.seed, STRATEGIES, effort)

    def single(
        self, effort: float | None = None, seed: int = 0, deadline: Deadline | None = None
    ) -> cp_model.CpSolver:
        """A solver with one worker, for models that are too small for a portfolio.

        Args:
            effort: deterministic seconds, None for all the time left.
            seed: added to the options' seed.
            deadline: an earlier one than the options'.
        """
        its = self._options
        return make_cp_solver(deadline or its.deadline, 1, its.seed + seed, effort)

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
