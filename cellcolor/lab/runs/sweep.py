"""Many runs: instances × limits × repetitions × solvers, one instance after the other."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from fnmatch import fnmatchcase
from functools import partial
from itertools import product, zip_longest

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SearchSpace
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import CellcolorError, InputError, RefusedResult, SolverMissing, TooLarge
from cellcolor.lab.families.registry import GROWING, LARGE, MEDIUM, SMALL, Family
from cellcolor.lab.runs.row import Key, Row, Status
from cellcolor.lab.workers import Task, Workers, as_they_end
from cellcolor.processes import Ended, Limits
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import solver_version


@dataclass(frozen=True, slots=True)
class Contestant:
    """A solver that takes part.

    Attributes:
        solver: its registered name.
        workers: the number to use, None if it chooses itself.
        version: what answers.
    """

    solver: str
    workers: int | None
    version: str


def contestant(text: str) -> Contestant:
    """A solver from its name, or from ``NAME@WORKERS``.

    Raises:
        InputError: there is no such solver, or no such number of workers.
        SolverMissing: what it needs is not installed.
    """
    name, at, number = text.partition("@")
    workers = None
    if at:
        try:
            workers = Options(workers=int(number)).workers
        except (ValueError, InputError) as error:
            raise InputError(None, "solver", f"{text}: no number of workers after @") from error
    return Contestant(name, workers, solver_version(name))


SETS: Mapping[str, Mapping[str, Family]] = {
    "small": SMALL,
    "medium": MEDIUM,
    "large": LARGE,
    "growing": GROWING,
}
"""The families, by the name of their set and their own."""


@dataclass(frozen=True, slots=True)
class Specimen:
    """An instance that is made when its turn comes.

    Attributes:
        family: what it is from.
        seed: within the family, None for a file.
        name: for messages.
        make: makes it, and may raise a :class:`~cellcolor.errors.CellcolorError`.
    """

    family: str
    seed: int | None
    name: str
    make: Callable[[], Instance]


def family_names() -> list[str]:
    """All families, as ``set/family``."""
    return [f"{group}/{name}" for group, families in SETS.items() for name in families]


def families_like(pattern: str) -> list[str]:
    """The families meant by the name of a set, or by ``set/family`` with ``*`` and ``?`` in it."""
    wanted = f"{pattern}/*" if pattern in SETS else pattern
    return [name for name in family_names() if fnmatchcase(name, wanted)]


def of_family(name: str, seeds: Iterable[int]) -> list[Specimen]:
    """Instances of a family, such as ``medium/thin``."""
    group, _, family = name.partition("/")
    recipe = SETS[group][family]
    return [
        Specimen(name, seed, f"{name}, seed {seed}", partial(_made, recipe, seed)) for seed in seeds
    ]


def taking_turns(groups: Sequence[Sequence[Specimen]]) -> Iterator[Specimen]:
    """The first of each group, then the second of each, …: a part of the runs is of use as well."""
    for turn in zip_longest(*groups):
        yield from (subject for subject in turn if subject is not None)


def _made(family: Family, seed: int) -> Instance:
    made = family(seed)
    return made if isinstance(made, Instance) else decompose(made)


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


_STATUS: dict[str, Status] = {"timeout": "timeout", "memory": "memory"}
"""Of runs that did not come back; all the others have crashed."""


@dataclass(frozen=True, slots=True)
class Experiment:
    """Which runs to make.

    Attributes:
        subjects: the instances, in their order.
        contestants: who solves each of them.
        limits: seconds for each solve, one limit or several.
        repetitions: of each run, with other random numbers in the solver.
        search_space: where to search.
        megabytes: of memory for each run.
        command: that asked for them, for the record.
    """

    subjects: Sequence[Specimen]
    contestants: Sequence[Contestant]
    limits: Sequence[float]
    repetitions: int
    search_space: SearchSpace
    megabytes: float
    command: str

    @property
    def runs_of_each(self) -> int:
        """Runs on one instance."""
        return len(self.limits) * self.repetitions * len(self.contestants)


@dataclass(frozen=True, slots=True)
class _Run:
    """One run that has been handed to a worker."""

    subject: Specimen
    instance: Instance
    contestant: Contestant
    how: Solve


class Sweep:
    """The runs of a plan.

    Attributes:
        skipped: runs that were there already, or whose instance could not be made.

    Args:
        plan: which runs to make.
        done: keys of runs that are not to be made again.
        complain: told of instances that cannot be made, each with its subject.
    """

    def __init__(
        self,
        plan: Experiment,
        done: Collection[Key],
        complain: Callable[[Specimen, CellcolorError], None],
    ) -> None:
        self.skipped = 0
        self._plan = plan
        self._done = set(done)
        self._complain = complain

    def run(self, workers: Workers) -> Iterator[Row]:
        """A row for each run, as they end."""
        for run, ended in as_they_end(workers, self._tasks()):
            yield self._row(run, ended)

    def _tasks(self) -> Iterator[tuple[_Run, Task]]:
        plan = self._plan
        for subject in plan.subjects:
            try:
                instance = subject.make()
            except CellcolorError as error:
                self._complain(subject, error)
                self.skipped += plan.runs_of_each
                continue
            for limit, repetition, contestant in product(
                plan.limits, range(plan.repetitions), plan.contestants
            ):
                solver, workers = contestant.solver, contestant.workers
                how = Solve(solver, workers, limit, repetition, plan.search_space)
                run = _Run(subject, instance, contestant, how)
                key = self._row(run, Ended("stopped")).key
                if key in self._done:
                    self.skipped += 1
                else:
                    self._done.add(key)
                    yield run, task_of(instance, how, plan.megabytes)

    def _row(self, run: _Run, ended: Ended) -> Row:
        instance, how, answered = run.instance, run.how, _answered(ended)
        return Row(
            family=run.subject.family,
            seed=run.subject.seed,
            instance=instance.name,
            sha256=instance.sha256,
            cells=len(instance.cells),
            edges=len(instance.edges),
            colors=len(instance.colors),
            live_darts=instance.most_live_darts,
            live_loops=instance.most_live_loops,
            search_space=how.search_space,
            solver=how.solver,
            solver_version=run.contestant.version,
            workers=how.workers,
            limit=how.limit,
            repetition=how.seed,
            status=answered.status,
            segments=answered.segments,
            lower_bound=answered.lower_bound,
            proved_for_surface=answered.proved_for_surface,
            seconds=None if answered.seconds is None else round(answered.seconds, 4),
            cpu_seconds=round(ended.cpu_seconds, 3),
            process_seconds=round(ended.seconds, 3),
            peak_mb=round(ended.peak_mb, 1),
            error=answered.error,
            **asdict(ended.machine),
            load=round(ended.load, 2),
            date=datetime.now(UTC).isoformat(timespec="seconds"),
            command=self._plan.command,
        )


def _answered(ended: Ended) -> Answered:
    if isinstance(ended.value, Answered):
        return ended.value
    return Answered(_STATUS.get(ended.end, "crashed"), error=ended.error)
