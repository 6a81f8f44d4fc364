"""CP-SAT models solved so that Ctrl-C is heard, within a deadline."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite
from threading import Event, Thread

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline

__all__ = ["make_cp_solver", "solve_interruptibly"]


def make_cp_solver(
    deadline: Deadline, workers: int, seed: int, effort: float | None = None
) -> cp_model.CpSolver:
    """A solver with limits.

    Args:
        deadline: when to stop.
        workers: its search workers.
        seed: of everything random.
        effort: deterministic seconds a worker, None for as long as there is time.
    """
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = workers
    solver.parameters.random_seed = seed
    # Left to itself, OR-Tools makes the next Ctrl-C kill the process.
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
    """Solve in a thread, so that an interrupt here ends the search with its best.

    Args:
        solver: see above.
        model: what to solve.
        found: called with the objective of each better solution, in a thread of the solver.

    Returns:
        The solver's status, and the interrupt that ended it, if one did.
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
            solver.stop_search()
    return status[0], interrupt


class _Watcher(cp_model.CpSolverSolutionCallback):
    def __init__(self, found: Callable[[int], None]) -> None:
        super().__init__()
        self._found = found

    def on_solution_callback(self) -> None:
        self._found(round(self.objective_value))
