"""Many runs: instances × limits × repetitions × solvers, one instance after the other."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import asdict, dataclass
from datetime import UTC, datetime
from itertools import product

from cellcolor.data.instance import Instance
from cellcolor.data.solution import SearchSpace
from cellcolor.errors import CellcolorError
from cellcolor.lab.executors.alone import Ended
from cellcolor.lab.executors.work import Task, Workers, as_they_end
from cellcolor.lab.runs.contestants import Contestant
from cellcolor.lab.runs.once import Answered, Solve, task_of
from cellcolor.lab.runs.row import Key, Row, Status
from cellcolor.lab.runs.subjects import Specimen

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
