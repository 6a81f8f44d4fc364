"""Workers that do everything in this process, where a test can change what they use."""

from __future__ import annotations

from concurrent.futures import Future
from types import TracebackType

from cellcolor.lab.executors.alone import Ended
from cellcolor.lab.executors.work import Task, Workers


class HereWorkers(Workers):
    """One piece of work at a time, done when it is handed in."""

    @property
    def slots(self) -> int:
        return 1

    def submit(self, task: Task, /) -> Future[Ended]:
        future: Future[Ended] = Future()
        future.set_result(Ended("done", task.function(*task.arguments)))
        return future

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        pass
