"""Workers of this machine."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from threading import Event
from types import TracebackType

from cellcolor.lab.executors.alone import Ended, run_alone
from cellcolor.lab.executors.work import Task, Workers


class LocalWorkers(Workers):
    """Each piece of work in a process of its own on this machine, watched by a thread.

    Args:
        jobs: pieces of work at a time.
    """

    def __init__(self, jobs: int) -> None:
        self._jobs = jobs
        self._watchers = ThreadPoolExecutor(jobs)
        self._stop = Event()

    @property
    def slots(self) -> int:
        """How many pieces of work are done at a time."""
        return self._jobs

    def submit(self, task: Task, /) -> Future[Ended]:
        """Hand in a piece of work."""
        work = (task.function, task.arguments, task.limits, self._stop.is_set)
        return self._watchers.submit(run_alone, *work)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End what is still being done, at once."""
        self._stop.set()
        self._watchers.shutdown(cancel_futures=True)
