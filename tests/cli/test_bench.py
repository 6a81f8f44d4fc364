"""``cellcolor bench``: runs, tables that are continued, summaries."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path

import odd_jobs
import pytest
from commands import run
from guides import install
from library import PAPER

import cellcolor.processes
from cellcolor.lab.runs.table import Row, read_table
from cellcolor.processes import Task
from cellcolor.solvers.registry import GROUP

pytestmark = pytest.mark.second

RING = PAPER / "ring.json"
ZEROS = PAPER / "crossing-zeros.json"
Capture = pytest.CaptureFixture[str]
Work = Callable[..., object]

FAKES = """
import os, time
from dataclasses import replace
from cellcolor.data.bounds import Bound
from cellcolor.solvers.dfs import ReferenceSolver

class Boaster(ReferenceSolver):
    def minimize(self, instance, options, progress=None):
        answer = super().minimize(instance, options, progress)
        if len(instance.cells) == 1:
            return answer
        bound = Bound("model", answer.lower_bound + 1, "strands")
        return replace(answer, division=None, bounds=(bound,))

class Forger(ReferenceSolver):
    def minimize(self, instance, options, progress=None):
        answer = super().minimize(instance, options, progress)
        return replace(answer, division=answer.division[:-1]) if answer.division[1:] else answer

class Deaf(ReferenceSolver):
    def minimize(self, instance, options, progress=None):
        if len(instance.cells) > 1:
            open(os.environ["PIDS"], "a").write(f"{os.getpid()}\\n")
            time.sleep(600)
        return super().minimize(instance, options, progress)
"""


@pytest.fixture
def fakes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Solvers of another package: one that claims too much, one that forges, one that is deaf."""
    names = {"boaster": "fakes:Boaster", "forger": "fakes:Forger", "deaf": "fakes:Deaf"}
    site = tmp_path / "site"
    install(site, "fakes", GROUP, names, fakes=FAKES)
    monkeypatch.syspath_prepend(str(site))
    monkeypatch.setenv("PIDS", str(tmp_path / "pids"))
    return site


def rows(path: Path) -> list[Row]:
    return read_table(path)


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Four runs: two solvers on two instances; what was printed is beside it."""
    path = tmp_path_factory.mktemp("runs") / "t.csv"
    solvers = ("--solver", "dfs", "--solver", "cp-sat@1")
    with redirect_stdout(StringIO()) as out:
        assert run("bench", "run", RING, "crossing-zeros", *solvers, "-o", path) == 0
    path.with_suffix(".txt").write_text(out.getvalue())
    return path


class TestRun:
    def test_table(self, table: Path) -> None:
        out = table.with_suffix(".txt").read_text()
        assert "| paper | 2/2 | 2/2 |" in out
        assert out.endswith("4 runs, 4 with a proved minimum\n")
        found = rows(table)
        # Cells, and live darts of the cell that has most of them.
        assert [(row.cells, row.live_darts) for row in found[::2]] == [(3, 2), (5, 6)]
        assert [(row.instance, row.contestant) for row in found] == [
            (name, solver) for name in ("ring", "crossing-zeros") for solver in ("dfs", "cp-sat@1")
        ]
        for row in found:
            assert (row.status, row.segments, row.lower_bound, row.family) == (
                "optimal",
                2,
                2,
                "paper",
            )
            assert min(row.process_seconds, row.cpu_seconds, row.peak_mb) > 0
        assert found[1].solver_version.startswith("OR-Tools ") and found[1].workers == 1

    def test_in_process(self, table: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        """The same answers, by no other process."""
        monkeypatch.setattr(cellcolor.processes, "run_alone", None)
        here = tmp_path / "here.csv"
        solvers = ("--solver", "dfs", "--solver", "cp-sat@1")
        subjects = (RING, "crossing-zeros")
        assert run("bench", "run", *subjects, *solvers, "--in-process", "-o", here) == 0
        assert [(row.key, row.segments) for row in rows(here)] == [
            (row.key, row.segments) for row in rows(table)
        ]
        assert all(row.peak_mb == 0 for row in rows(here))

    def test_families_take_turns_and_a_table_is_continued(
        self, tmp_path: Path, capsys: Capture
    ) -> None:
        table = tmp_path / "t.csv"
        families = ("bench", "run", "small/hubs", "small/graphs", "--solver", "dfs", "-o", table)
        assert run(*families, "--seeds", "0") == 0
        before = table.read_bytes()
        with table.open("ab") as file:  # as a kill leaves it
            file.write(before.splitlines()[-1][:40])
        assert run(*families, "--seeds", "0,1", "--repetitions", "1") == 0
        assert "2 runs, 2 with a proved minimum, 2 left out or already there" in (
            capsys.readouterr().out
        )
        assert table.read_bytes().startswith(before)
        order = [(row.family, row.seed) for row in rows(table)]
        assert order == [(f, n) for n in (0, 1) for f in ("small/hubs", "small/graphs")]

    def test_bad_files_and_missing_solvers_stop_nothing(
        self, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setitem(sys.modules, "clingo", None)
        bad = tmp_path / "bad.json"
        bad.write_text("{}")
        solvers = ("--solver", "clingo", "--solver", "dfs")
        assert run("bench", "run", bad, RING, *solvers) == 2
        out, err = capsys.readouterr()
        assert "1 run, 1 with a proved minimum" in out
        assert "left out: the solver clingo is not installed: pip install" in err
        assert len(err.splitlines()) == 2 and str(bad) in err
        assert run("bench", "run", bad) == 2
        out, err = capsys.readouterr()
        assert not out and len(err.splitlines()) == 1 and str(bad) in err

    @pytest.mark.usefixtures("fakes")
    def test_a_bound_that_another_solver_beats(self, tmp_path: Path, capsys: Capture) -> None:
        table = tmp_path / "t.csv"
        solvers = ("--solver", "dfs", "--solver", "boaster")
        # Its cells have to be cut for two segments: whole cells do not refute the bound at once.
        assert run("bench", "run", PAPER / "split-cell.json", *solvers, "-o", table) == 1
        line = "dfs has 2 segments, boaster a lower bound of 3"
        assert line in capsys.readouterr().err
        assert run("bench", "summary", table) == 1
        assert line in capsys.readouterr().out

    @pytest.mark.usefixtures("fakes")
    def test_a_division_that_the_checker_refuses(self, capsys: Capture) -> None:
        assert run("bench", "run", RING, "--solver", "forger") == 1
        assert "forger returned something illegal" in capsys.readouterr().err

    @pytest.mark.usefixtures("fakes")
    def test_a_solver_that_does_not_hear_of_the_end(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def impatient(function: Work, arguments: tuple[object, ...], *most: float) -> Task:
            """Gives the deaf one up soon; the other has its time, however busy the machine is."""
            return Task(function, arguments, *((2.0,) if "deaf" in arguments else most))

        monkeypatch.setattr("cellcolor.lab.runs.sweep.Task", impatient)
        table = tmp_path / "t.csv"
        solvers = ("--solver", "deaf", "--solver", "dfs")
        assert run("bench", "run", RING, *solvers, "--time-limit", "0.1", "-o", table) == 0
        deaf, dfs = rows(table)
        assert (deaf.status, deaf.seconds, deaf.segments) == ("timeout", None, None)
        assert deaf.error is not None and deaf.error.startswith("killed after")
        assert dfs.status == "optimal"

    @pytest.mark.usefixtures("fakes")
    @pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL])
    def test_stopped_and_continued(self, tmp_path: Path, number: int) -> None:
        """What was done is kept, nobody is left running, and the next one goes on from there."""
        table, pids = tmp_path / "t.csv", tmp_path / "pids"
        command = [sys.executable, "-m", "cellcolor", "bench", "run", str(RING), str(ZEROS)]
        command += ["--solver", "dfs", "--solver", "deaf", "--time-limit", "99", "-o", str(table)]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        process = subprocess.Popen(
            command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
        )
        try:
            odd_jobs.wait_until_noted(pids, 1)
            process.send_signal(number)
            _, err = process.communicate(timeout=60)
            odd_jobs.wait_until_ended(pids)
        finally:
            process.kill()
        if number == signal.SIGINT:
            assert (process.returncode, err) == (3, "cellcolor: interrupted\n")
        assert [row.contestant for row in rows(table)] == ["dfs"]
        assert (
            run("bench", "run", RING, ZEROS, "--solver", "dfs", "--time-limit", 99, "-o", table)
            == 0
        )
        assert [row.instance for row in rows(table)] == ["ring", "crossing-zeros"]

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (["nothing*"], "nothing*: is not a file, and nothing of that name is shipped"),
            (["library/none"], "library/none: matches no family of the library"),
            (["small", "--solver", "nobody"], "solver: there is no 'nobody'"),
            (["small", "--solver", "dfs@0"], "dfs@0: no number of workers after @"),
            (["small", "--seeds", "a-b"], "'a-b' is not a list like 0-9"),
            (["small", "--seeds", "7-3"], "'7-3' contains no number"),
            (["small", "-o", "none/t.csv"], "none/t.csv: No such file or directory"),
        ],
        ids=lambda value: " ".join(value) if isinstance(value, list) else "",
    )
    def test_refused(
        self,
        arguments: list[str],
        message: str,
        capsys: Capture,
        tmp_path: Path,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        monkeypatch.chdir(tmp_path)
        assert run("bench", "run", *arguments) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert message in line


class TestTables:
    def test_summary(self, table: Path, capsys: Capture) -> None:
        assert run("bench", "summary", table) == 0
        out = capsys.readouterr().out
        assert "4 runs on 2 instances" in out
        assert "No two runs contradict each other. On 2 instances two solvers" in out
        assert "| paper | 2/2 | 2/2 |" in out

    def test_pair(self, table: Path, capsys: Capture) -> None:
        assert run("bench", "summary", table, "--pair", "dfs", "cp-sat@1") == 0
        out = capsys.readouterr().out
        assert (
            "## dfs and cp-sat@1, search space paper, 10 s" in out and "| proved | 2 | 2 |" in out
        )
        assert run("bench", "summary", table, "--pair", "dfs", "scip") == 2
        assert "--pair: there are no runs of scip, only of" in capsys.readouterr().err

    def test_what_is_no_table(self, tmp_path: Path, capsys: Capture) -> None:
        other = tmp_path / "other.csv"
        other.write_text("a,b\n1,2\n")
        for arguments in (["summary", other], ["run", RING, "-o", other]):
            assert run("bench", *arguments) == 2
            (line,) = capsys.readouterr().err.splitlines()
            assert f"{other}: line 1: " in line
        assert other.read_text() == "a,b\n1,2\n"
