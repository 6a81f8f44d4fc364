"""Pieces of work, and what came of them, whoever does them; the workers of this machine.

Each piece of work is done in a process of its own. ``cluster`` has the workers of a Dask cluster.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager
from dataclasses import dataclass
from itertools import islice
from threading import Event
from typing import Any, Protocol, TypeVar

from cellcolor.errors import CellcolorError
from cellcolor.processes import Ended, Limits, run_alone

_Name = TypeVar("_Name")


@dataclass(frozen=True, slots=True)
class Task:
    """One piece of work: a function of a module that workers can import, what can be pickled."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    limits: Limits


class Workers(AbstractContextManager["Workers"], Protocol):
    """Processes that work is handed to.

    They are used in a ``with`` block: whatever ends it early, such as Ctrl-C, ends the work.
    """

    @property
    def slots(self) -> int:
        """How many pieces of work they do at a time."""

    def submit(self, task: Task, /) -> Future[Ended]:
        """Hand in a piece of work; what comes of it is in the future sooner or later."""


def as_they_end(
    workers: Workers, tasks: Iterable[tuple[_Name, Task]]
) -> Iterator[tuple[_Name, Ended]]:
    """What came of each task, by its name of any kind, in the order in which they end.

    A task is taken only when a worker is free for it, so that making the next one, which may take
    a while, does not disturb the work where there is one worker.
    """
    left = iter(tasks)
    names: dict[Future[Ended], _Name] = {}
    while True:
        for name, task in islice(left, workers.slots - len(names)):
            names[workers.submit(task)] = name
        if not names:
            return
        for future in wait(names, return_when=FIRST_COMPLETED).done:
            yield names.pop(future), _ended(future)


def _ended(future: Future[Ended]) -> Ended:
    """The result of a future; what went wrong outside of the work's own process is a result too."""
    try:
        return future.result()
    except CancelledError as error:
        raise CellcolorError("the cluster has dropped the work; is its scheduler gone?") from error
    except Exception as error:  # a cluster gives up work whose workers die again and again
        return Ended("crashed", error=" ".join(f"{type(error).__name__}: {error}".split())[:300])


class LocalWorkers(Workers):
    """So many pieces of work at a time on this machine, each watched by a thread."""

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self._watchers = ThreadPoolExecutor(jobs)
        self._stop = Event()

    @property
    def slots(self) -> int:
        return self._jobs

    def submit(self, task: Task, /) -> Future[Ended]:
        work = (task.function, task.arguments, task.limits, self._stop.is_set)
        return self._watchers.submit(run_alone, *work)

    def __exit__(self, *_: object) -> None:
        """End what is still being done, at once."""
        self._stop.set()
        self._watchers.shutdown(cancel_futures=True)
