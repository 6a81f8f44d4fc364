"""Work in processes of its own: limits, what is killed, and that nothing is left behind."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import odd_jobs
import pytest

from cellcolor.processes import Ended, Task, as_they_end, run_alone

pytestmark = pytest.mark.second

LONG = 60.0


def alone(
    function: Callable[..., Any], *arguments: Any, limits: tuple[float, ...] = (LONG,)
) -> Ended:
    return run_alone(function, arguments, *limits)


class TestOneProcess:
    def test_comes_back(self) -> None:
        ended = alone(odd_jobs.double, 21)
        assert (ended.end, ended.value, ended.error) == ("done", 42, "")
        assert ended.seconds > 0 and ended.cpu_seconds > 0

    def test_an_error_is_a_line(self) -> None:
        ended = alone(odd_jobs.fail, "two\nlines")
        assert (ended.end, ended.error) == ("failed", "ValueError: two lines")

    def test_what_cannot_be_handed_back_is_an_error(self) -> None:
        assert "pickle" in alone(compile, "1", "no file", "eval").error

    def test_killed_by_somebody(self) -> None:
        ended = alone(odd_jobs.die)
        assert (ended.end, ended.error) == ("crashed", "ended by SIGKILL")

    def test_ending_without_a_result_is_no_result(self) -> None:
        ended = alone(os._exit, 0)
        assert ended.end == "crashed" and ended.error.startswith("left no result")
        assert alone(os._exit, 7).error == "exit code 7"

    @pytest.mark.skipif(sys.platform != "linux", reason="memory is looked at on Linux only")
    def test_memory(self) -> None:
        ended = alone(odd_jobs.swell, limits=(LONG, 200.0))
        assert (ended.end, ended.error) == ("memory", "killed at more than 200 MB")
        assert 200 < ended.peak_mb < 1000

    @pytest.mark.parametrize("apart", [False, True])
    def test_time_and_no_orphans(self, tmp_path: Path, apart: bool) -> None:
        pids = tmp_path / "pids"
        ended = alone(odd_jobs.hang, str(pids), apart, limits=(2.0,))
        assert (ended.end, ended.error) == ("timeout", "killed after 2 s")
        assert ended.seconds >= 2.0
        odd_jobs.wait_until_ended(pids)

    def test_children_do_not_outlive_what_came_back(self, tmp_path: Path) -> None:
        pids = tmp_path / "pids"
        assert alone(odd_jobs.leave_behind, str(pids)).end == "done"
        odd_jobs.wait_until_ended(pids)


class TestManyProcesses:
    def test_lost_ones_leave_the_others(self) -> None:
        jobs = [(odd_jobs.die, ()), (odd_jobs.double, (1,)), (odd_jobs.fail, ("!",))]
        tasks = [(n, Task(function, arguments, LONG)) for n, (function, arguments) in
                 enumerate(jobs)]  # fmt: skip
        ends = [(name, ended.end) for name, ended in as_they_end(1, tasks)]
        assert ends == [(0, "crashed"), (1, "done"), (2, "failed")]

    def test_leaving_ends_the_work(self, tmp_path: Path) -> None:
        pids = tmp_path / "pids"
        tasks = [Task(odd_jobs.double, (1,), LONG), Task(odd_jobs.hang, (str(pids),), 600.0)]
        with pytest.raises(KeyboardInterrupt):
            for _ in as_they_end(2, enumerate(tasks)):
                odd_jobs.wait_until_noted(pids, 2)
                raise KeyboardInterrupt
        odd_jobs.wait_until_ended(pids)
