"""Pieces of work, so many at a time on this machine, each in a process of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import AbstractContextManager
from dataclasses import dataclass
from itertools import islice
from threading import Event
from typing import Any, TypeVar

from cellcolor.processes import MOST_MB, Ended, run_alone

_Name = TypeVar("_Name")


@dataclass(frozen=True, slots=True)
class Task:
    """One piece of work; see :func:`~cellcolor.processes.run_alone`."""

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    most_seconds: float
    most_mb: float = MOST_MB


class Workers(AbstractContextManager["Workers"]):
    """Threads that watch a process each, used in a ``with`` block.

    Whatever ends the block early, such as Ctrl-C, ends the work.

    Attributes:
        slots: how many pieces of work they do at a time.
    """

    def __init__(self, slots: int) -> None:
        self.slots = slots
        self._watchers = ThreadPoolExecutor(slots)
        self._stop = Event()

    def submit(self, task: Task) -> Future[Ended]:
        """Hand in a piece of work; what comes of it is in the future sooner or later."""
        limits = task.most_seconds, task.most_mb
        return self._watchers.submit(
            run_alone, task.function, task.arguments, *limits, self._stop.is_set
        )

    def __exit__(self, *_: object) -> None:
        """End what is still being done, at once."""
        self._stop.set()
        self._watchers.shutdown(cancel_futures=True)


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
            yield names.pop(future), future.result()
