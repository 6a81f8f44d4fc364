"""CP-SAT models solved within a deadline, so that Ctrl-C ends the search and not the process."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from threading import Event, Thread

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import CellcolorError
from cellcolor.solvers.interface import PORTFOLIO, Options

FEW_WORKERS = 2
"""Up to how many workers search in our ``STRATEGIES``, in turns. With more of them OR-Tools
chooses; one or two would have its default strategy alone, which hardly ever proves a bound around
hubs."""

STRATEGIES = "no_lp", "default_lp", "core"
"""Without a linear relaxation divisions are found, with it bounds; the last one raises the bound by
cores, sets of literals of which some must cost a segment."""

Solve = Callable[[cp_model.CpModel], tuple[cp_model.CpSolver, cp_model.CpSolverStatus]]
"""Solves a model within limits that it knows; hands back the solver and its status."""


def make_cp_solver(
    deadline: Deadline, workers: int, seed: int, effort: float | None = None
) -> cp_model.CpSolver:
    """A CP-SAT solver with limits; one worker searches in OR-Tools' default strategy.

    Args:
        effort: the limit for each worker in OR-Tools' deterministic time, which measures the work
            done and not the clock; None for as long as there is time.
    """
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = workers
    solver.parameters.random_seed = seed
    # If OR-Tools caught the signal, the next Ctrl-C would kill the process.
    solver.parameters.catch_sigint_signal = False
    if isfinite(deadline.moment):
        solver.parameters.max_time_in_seconds = deadline.left
    if effort is not None:
        solver.parameters.max_deterministic_time = effort
    return solver


def solve_interruptibly(
    solver: cp_model.CpSolver,
    model: cp_model.CpModel,
    found: Callable[[int], None] | None = None,
) -> tuple[cp_model.CpSolverStatus, KeyboardInterrupt | None]:
    """Solve in a thread of its own, so that Ctrl-C here ends the search and keeps the best found.

    Args:
        found: called with the objective of each better solution, in a thread of the solver.

    Returns:
        The solver's status, and the interrupt that ended the search, None if none did.

    Raises:
        CellcolorError: OR-Tools considers the model invalid.
    """
    status: list[cp_model.CpSolverStatus] = []
    finished = Event()

    def work() -> None:
        try:
            status.append(solver.solve(model, None if found is None else _Watcher(found)))
        finally:
            finished.set()

    Thread(target=work).start()
    # Thread.join cannot be used: in Python 3.11, once it has been interrupted, it takes a thread
    # that is still running for a finished one.
    interrupt: KeyboardInterrupt | None = None
    while not finished.is_set():
        try:
            finished.wait()
        except KeyboardInterrupt as error:
            interrupt = error
            solver.stop_search()
    if status and status[0] == cp_model.MODEL_INVALID:
        raise CellcolorError(f"OR-Tools refuses the model: {model.validate()}")
    return status[0], interrupt


class _Watcher(cp_model.CpSolverSolutionCallback):
    """Hands the objective of each better solution on to a function."""

    def __init__(self, found: Callable[[int], None]) -> None:
        super().__init__()
        self._found = found

    def on_solution_callback(self) -> None:
        self._found(round(self.objective_value))


class Runner:
    """Solves models one after the other, with the options' deadline, workers and seed."""

    def __init__(self, options: Options) -> None:
        self._options = options
        self._stopped = False

    @property
    def over(self) -> bool:
        """Whether there is no time left, or Ctrl-C came."""
        return self._stopped or self._options.deadline.over

    def portfolio(self, deadline: Deadline | None = None) -> cp_model.CpSolver:
        """A solver with the options' workers, ``PORTFOLIO`` if they name none.

        Args:
            deadline: of this model, if it is not that of the options.
        """
        workers = self._options.workers or PORTFOLIO
        solver = make_cp_solver(deadline or self._options.deadline, workers, self._options.seed)
        if workers <= FEW_WORKERS:
            solver.parameters.interleave_search = True
            solver.parameters.subsolvers.extend(STRATEGIES)
        return solver

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
        """Solve a model; after an interrupt that ends the search there is no time left."""
        status, interrupt = solve_interruptibly(solver, model, found)
        if interrupt is not None:
            self._stopped = True
            if not isinstance(interrupt, OutOfTime):
                raise interrupt
        return status
