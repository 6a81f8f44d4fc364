"""Workers of a Dask cluster: a thin adapter.

Each task is watched on the machine that does it, in the same way as on this one. When a worker is
lost Dask hands its tasks to another one, and gives up what has lost several of them.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future

from distributed import Client, Worker, get_worker

from cellcolor.errors import InputError
from cellcolor.lab.workers import Task, Workers
from cellcolor.processes import Ended, run_alone

_PATIENCE = 10.0
"""Seconds in which a scheduler has to answer."""


class ClusterWorkers(Workers):
    """The workers that a scheduler knows; its threads say how many tasks are done at a time.

    Args:
        address: of the scheduler, such as ``tcp://10.0.0.1:8786``.

    Raises:
        InputError: nobody answers there, or there are no workers.
    """

    def __init__(self, address: str) -> None:
        try:
            self._client = Client(address, timeout=_PATIENCE)
        except (OSError, ValueError) as error:
            raise InputError(None, "cluster", f"{address} does not answer: {error}") from error
        if not self.slots:
            self._client.close()
            raise InputError(None, "cluster", f"{address} has no workers")
        self._executor = self._client.get_executor(pure=False)

    @property
    def slots(self) -> int:
        threads: dict[str, int] = self._client.nthreads()
        return sum(threads.values())

    def submit(self, task: Task, /) -> Future[Ended]:
        future: Future[Ended] = self._executor.submit(_work, task)
        return future

    def __exit__(self, *_: object) -> None:
        """End what is still being done, and leave the cluster."""
        self._executor.shutdown(wait=False)
        self._client.close()


def _work(task: Task) -> Ended:
    return run_alone(task.function, task.arguments, task.limits, _dropped(get_worker()))


def _dropped(worker: Worker) -> Callable[[], bool]:
    """Whether nobody wants the result of the task that this thread does any more."""
    key = worker.get_current_task()

    def ask() -> bool:
        known = worker.state.tasks.get(key)
        return known is None or known.state == "cancelled"

    return ask
