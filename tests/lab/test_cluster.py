"""A Dask cluster of two workers does the work as well, and loses none of it."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any

import odd_jobs
import pytest
from commands import run
from library import PAPER

import cellcolor
from cellcolor.errors import InputError
from cellcolor.lab.runs.row import Row
from cellcolor.lab.runs.table import read_table
from cellcolor.lab.workers import Task, as_they_end
from cellcolor.processes import Ended, Limits

distributed = pytest.importorskip("distributed", reason="the extra 'cluster' is not installed")

from cellcolor.lab.cluster import ClusterWorkers  # noqa: E402

pytestmark = pytest.mark.second

LIMITS = Limits(60.0)


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Of a scheduler with two workers, each a process of its own that is replaced when it dies."""
    settings: dict[str, Any] = {"n_workers": 2, "threads_per_worker": 1, "processes": True}
    with distributed.LocalCluster(**settings, dashboard_address=None) as cluster:
        yield cluster.scheduler_address


def test_work_comes_back(address: str) -> None:
    tasks = [(n, Task(odd_jobs.double, (n,), LIMITS)) for n in range(4)]
    tasks.append((4, Task(odd_jobs.die, (), LIMITS)))
    with ClusterWorkers(address) as workers:
        assert workers.slots == 2
        found = {name: (ended.end, ended.value) for name, ended in as_they_end(workers, tasks)}
    assert found == {**{n: ("done", 2 * n) for n in range(4)}, 4: ("crashed", None)}


def test_a_command_gives_its_runs_to_the_cluster(address: str, tmp_path: Path) -> None:
    """The ring has two cells that share no color, and is covered by two segments."""
    table = tmp_path / "runs.csv"
    solvers = ("--solver", "dfs", "--solver", "cp-sat@1")
    command = ("bench", "run", PAPER / "ring.json", *solvers, "--cluster", address, "-o", table)
    assert run(*command) == 0
    rows = {row.contestant: (row.status, row.segments) for row in read_table(table, Row)}
    assert rows == {"dfs": ("optimal", 2), "cp-sat@1": ("optimal", 2)}


def test_a_lost_worker_loses_nothing(address: str, tmp_path: Path) -> None:
    mark = str(tmp_path / "mark")
    tasks = [("killer", Task(odd_jobs.kill_the_worker_once, (mark,), LIMITS))]
    tasks += [(str(n), Task(odd_jobs.double, (n,), LIMITS)) for n in range(4)]
    with ClusterWorkers(address) as workers:
        found = {name: ended.value for name, ended in as_they_end(workers, tasks)}
    assert found == {"killer": "came back", **{str(n): 2 * n for n in range(4)}}


class Killing(ClusterWorkers):
    """The first piece of work ends the worker that it is on, the first time."""

    mark: str

    def submit(self, task: Task, /) -> Future[Ended]:
        arguments = (self.mark, task.function, task.arguments)
        return super().submit(Task(odd_jobs.kill_the_worker_once_before, arguments, task.limits))


@pytest.mark.slow
def test_placements_are_the_same_with_a_worker_lost(address: str, tmp_path: Path) -> None:
    from shipped import shipped

    asked: dict[str, Any] = {"x": (0.3, 0.6), "points": 2, "best": 1, "vertices": 50}
    scene = shipped("wok_obstacle", 60)
    workers = Killing(address)
    workers.mark = str(tmp_path / "mark")
    found = cellcolor.place(scene, **asked, jobs=workers)
    assert Path(workers.mark).exists() and found.complete
    assert list(found) == list(cellcolor.place(scene, **asked))


def test_leaving_ends_the_work(address: str, tmp_path: Path) -> None:
    pids = tmp_path / "pids"
    with pytest.raises(KeyboardInterrupt), ClusterWorkers(address) as workers:
        workers.submit(Task(odd_jobs.hang, (str(pids),), Limits(600.0)))
        odd_jobs.wait_until_noted(pids, 2)
        raise KeyboardInterrupt
    odd_jobs.wait_until_ended(pids)


def test_nobody_there(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cellcolor.lab.cluster._PATIENCE", 0.2)
    with pytest.raises(InputError, match=r"cluster: tcp://127\.0\.0\.1:9 does not answer"):
        ClusterWorkers("tcp://127.0.0.1:9")
