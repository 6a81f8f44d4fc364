"""Running CP-SAT models one after the other within one time limit, and Ctrl-C meanwhile."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from threading import Event, Thread

from ortools.sat.python import cp_model

from cellcolor.deadline import OutOfTime
from cellcolor.solvers.interface import PORTFOLIO, Options

__all__ = ["Runner"]


class Runner:
    """Solves models until the deadline."""

    def __init__(self, options: Options) -> None:
        self._options = options
        self._stopped = False

    @property
    def over(self) -> bool:
        """Whether there is no time left, or Ctrl-C came."""
        return self._stopped or self._options.deadline.over

    def solver(self, effort: float | None) -> cp_model.CpSolver:
        """A solver with the options' limits, workers and seed.

        Args:
            effort: deterministic seconds a worker, None for as long as there is time.
        """
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = self._options.workers or PORTFOLIO
        solver.parameters.random_seed = self._options.seed
        # Left to itself, OR-Tools makes the next Ctrl-C kill the process.
        solver.parameters.catch_sigint_signal = False
        if isfinite(self._options.deadline.moment):
            solver.parameters.max_time_in_seconds = self._options.deadline.left
        if effort is not None:
            solver.parameters.max_deterministic_time = effort
        return solver

    def solve(
        self,
        solver: cp_model.CpSolver,
        model: cp_model.CpModel,
        found: Callable[[int], None] | None = None,
    ) -> cp_model.CpSolverStatus:
        """Solve in a thread, so that an interrupt here ends the search with its best.

        Args:
            solver: see above.
            model: what to solve.
            found: called with the objective of each better solution, in a thread of the solver.
        """
        status: list[cp_model.CpSolverStatus] = []
        finished = Event()

        def work() -> None:
            try:
                status.append(solver.solve(model, None if found is None else _Watcher(found)))
            finally:
                finished.set()

        Thread(target=work).start()
        # Not Thread.join: interrupted, it takes a running thread for a finished one (Python 3.11).
        interrupt: KeyboardInterrupt | None = None
        while not finished.is_set():
            try:
                finished.wait()
            except KeyboardInterrupt as error:
                interrupt = error
                self._stopped = True
                solver.stop_search()
        if interrupt is not None and not isinstance(interrupt, OutOfTime):
            raise interrupt
        return status[0]


class _Watcher(cp_model.CpSolverSolutionCallback):
    def __init__(self, found: Callable[[int], None]) -> None:
        super().__init__()
        self._found = found

    def on_solution_callback(self) -> None:
        self._found(round(self.objective_value))
