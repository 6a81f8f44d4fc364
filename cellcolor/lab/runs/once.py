"""One solve: what happens in the process that is made for it."""

from __future__ import annotations

from dataclasses import dataclass

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SearchSpace
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError, RefusedResult, SolverMissing, TooLarge
from cellcolor.lab.executors.alone import Limits
from cellcolor.lab.executors.work import Task
from cellcolor.lab.runs.row import Status

_START_UP = 20.0
"""Seconds for the start of a process and its imports, on a busy machine."""

_CHECKING = 10.0
"""Seconds for the checker, and for solvers that hear of the end of their time late."""

_WARM_UP = Instance("warm-up", ("any",), (Cell(0, (0,), ()),), ())


@dataclass(frozen=True, slots=True)
class Solve:
    """How to solve.

    Attributes:
        solver: a registered name.
        workers: None for as many as the solver likes.
        limit: seconds.
        seed: of what is random in the solver.
        search_space: where to search.
    """

    solver: str
    workers: int | None
    limit: float
    seed: int
    search_space: SearchSpace


@dataclass(frozen=True, slots=True)
class Answered:
    """What a solver answered.

    Attributes:
        status: how the run ended.
        segments: of the best division, None without one.
        lower_bound: that was proved in the search space, None without an answer.
        proved_for_surface: whether the minimum is proved for any division of the surface.
        seconds: of solving.
        error: a line, None if nothing went wrong.
    """

    status: Status
    segments: int | None = None
    lower_bound: int | None = None
    proved_for_surface: bool | None = None
    seconds: float | None = None
    error: str | None = None


def task_of(instance: Instance, solve: Solve, megabytes: float) -> Task:
    """A solve as a piece of work, with limits that only what does not keep its own will meet."""
    seconds = _START_UP + 1.1 * solve.limit + 1.0 + _CHECKING
    return Task(answer, (instance, solve), Limits(seconds, megabytes))


def answer(instance: Instance, how: Solve) -> Answered:
    """Solve an instance; the checker sees the result."""
    from cellcolor.solvers.checked import solve
    from cellcolor.solvers.interface import Options

    try:
        # Solvers import what they need on first use, which is not what is measured here.
        solve(_WARM_UP, Options(search_space=how.search_space), how.solver)
        deadline = Deadline.after(how.limit)
        options = Options(how.search_space, deadline=deadline, workers=how.workers, seed=how.seed)
        solution = solve(instance, options, how.solver)
    except (InputError, SolverMissing) as error:
        return Answered("unsupported", error=str(error))
    except TooLarge as error:
        return Answered("memory", error=str(error))
    except OutOfTime as error:
        return Answered("unknown", error=str(error))
    except RefusedResult as error:
        return Answered("refused", error=str(error))
    return Answered(
        solution.status,
        solution.segments,
        solution.lower_bound,
        solution.proved_for_surface,
        solution.seconds,
    )
