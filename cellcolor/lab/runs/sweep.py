"""Many runs: instances × limits × repetitions × solvers, one instance after the other."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from fnmatch import fnmatchcase
from functools import partial
from itertools import product, zip_longest
from typing import Any

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SearchSpace
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import CellcolorError, InputError, RefusedResult, SolverMissing, TooLarge
from cellcolor.lab.families.registry import GROWING, LARGE, MEDIUM, SMALL, Family
from cellcolor.lab.runs.table import LATE, Key, Row, Status
from cellcolor.machine import this_machine
from cellcolor.processes import Ended, Task, as_they_end
from cellcolor.solvers.interface import Options
from cellcolor.solvers.registry import solver_version


@dataclass(frozen=True, slots=True)
class Contestant:
    """A solver by its registered name, and its number of workers; None if it chooses itself."""

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


_SETS = {"small": SMALL, "medium": MEDIUM, "large": LARGE, "growing": GROWING}
FAMILIES = {f"{group}/{name}": own for group, all_ in _SETS.items() for name, own in all_.items()}
"""All families, by the name of their set and their own."""


@dataclass(frozen=True, slots=True)
class Specimen:
    """An instance that is made when its turn comes; ``seed`` is None for a file."""

    family: str
    seed: int | None
    name: str
    make: Callable[[], Instance]


def families(pattern: str, seeds: Iterable[int]) -> list[list[Specimen]]:
    """The instances of families: of a set by its name, or ``set/family`` with ``*`` and ``?``."""
    wanted = f"{pattern}/*" if pattern in _SETS else pattern
    return [
        [Specimen(name, n, f"{name}, seed {n}", partial(_made, family, n)) for n in seeds]
        for name, family in FAMILIES.items()
        if fnmatchcase(name, wanted)
    ]


def taking_turns(groups: Sequence[Sequence[Specimen]]) -> Iterator[Specimen]:
    """The first of each group, then the second of each, …: a part of the runs is of use as well."""
    for turn in zip_longest(*groups):
        yield from (subject for subject in turn if subject is not None)


def _made(family: Family, seed: int) -> Instance:
    made = family(seed)
    return made if isinstance(made, Instance) else decompose(made)


_START_UP, _CHECKING = 20.0, 10.0
"""Seconds for the start of a process and its imports on a busy machine; for the checker, and for
solvers that hear of the end of their time late."""

_WARM_UP = Instance("warm-up", ("any",), (Cell(0, (0,), ()),), ())


@dataclass(frozen=True, slots=True)
class Answered:
    """What a solver answered; see :class:`~cellcolor.lab.runs.table.Row`."""

    status: Status
    segments: int | None = None
    lower_bound: int | None = None
    proved_for_surface: bool | None = None
    seconds: float | None = None
    error: str | None = None


def answer(instance: Instance, solver: str, options: Options, limit: float) -> Answered:
    """Solve an instance within a limit in seconds; the checker sees the result."""
    from cellcolor.solvers.checked import solve

    try:
        # Solvers import what they need on first use, which is not what is measured here.
        solve(_WARM_UP, Options(search_space=options.search_space), solver)
        solution = solve(instance, replace(options, deadline=Deadline.after(limit)), solver)
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
        round(solution.seconds, 4),
    )


@dataclass
class Sweep:
    """Which runs to make, and making them.

    Attributes:
        limits: seconds for each solve, one limit or several.
        repetitions: of each run, with other random numbers in the solver.
        megabytes: of memory for each run.
        command: that asked for them, for the record.
        done: keys of runs that are not to be made again.
        complain: told of instances that cannot be made.
        skipped: runs that were there already, or whose instance could not be made.
    """

    subjects: Sequence[Specimen]
    contestants: Sequence[Contestant]
    limits: Sequence[float]
    repetitions: int
    search_space: SearchSpace
    megabytes: float
    command: str
    done: set[Key]
    complain: Callable[[Specimen, CellcolorError], None]
    skipped: int = 0

    @property
    def runs(self) -> int:
        """How many there are, those that are skipped among them."""
        return len(self.subjects) * self._of_each

    @property
    def _of_each(self) -> int:
        return len(self.limits) * self.repetitions * len(self.contestants)

    def run(self, jobs: int | None) -> Iterator[Row]:
        """A row for each run, as they end, so many processes at a time; None for no processes."""
        done = self._in_turn() if jobs is None else as_they_end(jobs, self._tasks())
        for known, ended in done:
            yield _row(known, ended)

    def _in_turn(self) -> Iterator[tuple[dict[str, Any], Ended]]:
        """Each run in this process, whose memory is not that of a run."""
        for known, task in self._tasks():
            begun, spent = time.monotonic(), time.process_time()
            value = task.function(*task.arguments)
            seconds, cpu_seconds = time.monotonic() - begun, time.process_time() - spent
            yield known, Ended("done", value, "", seconds, cpu_seconds)

    def _tasks(self) -> Iterator[tuple[dict[str, Any], Task]]:
        """What each run's row says before it is made, and what makes it."""
        for subject in self.subjects:
            try:
                instance = subject.make()
            except CellcolorError as error:
                self.complain(subject, error)
                self.skipped += self._of_each
                continue
            of_instance = {
                "family": subject.family,
                "seed": subject.seed,
                "instance": instance.name,
                "sha256": instance.sha256,
                "cells": len(instance.cells),
                "edges": len(instance.edges),
                "colors": len(instance.colors),
                "live_darts": instance.most_live_darts,
                "live_loops": instance.most_live_loops,
                "search_space": self.search_space,
                "command": self.command,
            }
            for limit, repetition, contestant in product(
                self.limits, range(self.repetitions), self.contestants
            ):
                solver, workers = contestant.solver, contestant.workers
                known = of_instance | {
                    "solver": solver,
                    "solver_version": contestant.version,
                    "workers": workers,
                    "limit": limit,
                    "repetition": repetition,
                }
                key = _row(known, Ended("stopped")).key
                if key in self.done:
                    self.skipped += 1
                    continue
                self.done.add(key)
                options = Options(self.search_space, workers=workers, seed=repetition)
                # The process's own limits are met only by what does not keep its own.
                seconds = _START_UP + limit + LATE + _CHECKING
                work = instance, solver, options, limit
                yield known, Task(answer, work, seconds, self.megabytes)


def _row(known: dict[str, Any], ended: Ended) -> Row:
    answered = ended.value
    if not isinstance(answered, Answered):
        killed: dict[str, Status] = {"timeout": "timeout", "memory": "memory"}
        answered = Answered(killed.get(ended.end, "crashed"), error=ended.error)
    return Row(
        **known,
        **asdict(answered),
        cpu_seconds=round(ended.cpu_seconds, 3),
        process_seconds=round(ended.seconds, 3),
        peak_mb=round(ended.peak_mb, 1),
        **asdict(this_machine()),
        load=round(os.getloadavg()[0], 2),
        date=datetime.now(UTC).isoformat(timespec="seconds"),
    )
