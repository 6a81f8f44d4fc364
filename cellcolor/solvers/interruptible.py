"""CP-SAT models solved within a deadline, so that Ctrl-C ends the search and not the process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from threading import Event, Thread

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.errors import CellcolorError
from cellcolor.solvers.interface import PORTFOLIO

FEW_WORKERS = 2
"""Up to how many workers search in strategies that we name, in turns. With more of them OR-Tools
chooses; one or two would have its default strategy alone, which hardly ever proves a bound around
hubs."""


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


def make_portfolio(
    deadline: Deadline,
    workers: int | None,
    seed: int,
    strategies: Sequence[str],
    effort: float | None = None,
) -> cp_model.CpSolver:
    """A CP-SAT solver for a model that is worth several strategies, whatever the workers.

    Args:
        workers: its search workers, None for ``PORTFOLIO``.
        strategies: OR-Tools' names of those for ``FEW_WORKERS`` or fewer.
    """
    solver = make_cp_solver(deadline, workers or PORTFOLIO, seed, effort)
    if solver.parameters.num_workers <= FEW_WORKERS:
        solver.parameters.interleave_search = True
        solver.parameters.subsolvers.extend(strategies)
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
