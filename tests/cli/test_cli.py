"""``solve``: exit codes, what goes to standard output, and what is written."""

from __future__ import annotations

import io
import json
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from commands import json_lines, run
from documents import INSTANCE
from library import INSTANCES, PAPER

import cellcolor.cli.commands
import cellcolor.cli.solve
import cellcolor.solvers.checked
import cellcolor.solvers.cpsat.schemes.enumeration
from cellcolor.data.instance import Cell, Instance
from cellcolor.data.solution import Division, Solution, read_schemes, scheme_key
from cellcolor.deadline import OutOfTime

RING = PAPER / "ring.json"
CORRIDORS = PAPER / "parallel-corridors.json"
ZEROS = PAPER / "crossing-zeros.json"
Capture = pytest.CaptureFixture[str]


# Ctrl-C as soon as the search has a division: from another thread if it runs in one.
INTERRUPTED = """
import contextlib, signal, sys, threading
import cellcolor.cli, cellcolor.cli.solve

sent = threading.Event()

@contextlib.contextmanager
def watched(_file):
    def report(segments, _bound):
        searching = "dfs" in sys.argv or threading.current_thread() is not threading.main_thread()
        if segments is not None and searching and not sent.is_set():
            sent.set()
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
    yield report

cellcolor.cli.solve.progress_of = watched
code = cellcolor.cli.main(sys.argv[1:])
sys.exit(code if sent.is_set() else 99)
"""


@pytest.fixture
def not_proved(monkeypatch: pytest.MonkeyPatch) -> None:
    """A solver that is stopped with a division and a bound below it."""
    solve = cellcolor.solvers.checked.solve

    def stopped(*arguments: Any, **options: Any) -> Solution:
        solution = solve(*arguments, **options)
        return replace(solution, status="feasible", lower_bound=0)

    monkeypatch.setattr(cellcolor.solvers.checked, "solve", stopped)


@pytest.mark.parametrize("columns", [80, 50])
def test_help_is_cut_nowhere(
    columns: int, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", str(columns))
    assert run("--help") == 0
    _, _, listed = capsys.readouterr().out.partition("Commands:")
    text = "".join(listed.split())  # lines may end at hyphens
    for name, command in cellcolor.cli.commands.cellcolor.commands.items():
        assert command.help is not None
        paragraph = "".join(command.help.partition("\n\n")[0].split())
        assert f"{name}{paragraph}" in text


class TestSolve:
    def test_table(self, capsys: Capture) -> None:
        assert run("solve", ZEROS) == 0
        out, err = capsys.readouterr()
        assert err == ""
        rows = [line.split() for line in out.splitlines()]
        assert ["segments", "2"] in rows
        assert ["lift-offs", "1"] in rows
        assert any(row[:2] == ["status", "optimal"] for row in rows)
        assert "\x1b" not in out
        assert "part of 0" in out

    def test_a_table_has_200_segments_at_most(self, tmp_path: Path, capsys: Capture) -> None:
        """250 cells apart from each other are 250 segments."""
        path = tmp_path / "apart.json"
        cells = tuple(Cell(number, (0,), ()) for number in range(250))
        path.write_text(Instance("apart", ("red",), cells, ()).to_json(), encoding="utf-8")
        assert run("solve", path) == 0
        rows = [line.split() for line in capsys.readouterr().out.splitlines()]
        assert [row[:3] for row in rows if "red" in row] == [
            [str(number), "red", str(number)] for number in range(200)
        ]
        assert ["…", "50", "more", "segments"] in rows
        assert ["segments", "250"] in rows

    def test_share_of_area(self, tmp_path: Path, capsys: Capture) -> None:
        """Four neighbours of 1 m² and a divided cell of 4 m²: nobody knows whose its area is."""
        instance = Instance.read(PAPER / "figsimpleexample.json")
        cells = [replace(cell, area=1.0 if cell.id else 4.0) for cell in instance.cells]
        path = tmp_path / "areas.json"
        path.write_text(replace(instance, cells=tuple(cells)).to_json(), encoding="utf-8")
        assert run("solve", path) == 0
        out = capsys.readouterr().out
        assert "share of area" in out
        assert out.count("25.0–75.0 %") == 2
        assert "where the cut runs through a divided cell is free" in out
        assert run("solve", RING) == 0  # nothing is divided there
        assert "where the cut runs" not in capsys.readouterr().out

    def test_json_is_all_there_is(self, capsys: Capture) -> None:
        assert run("solve", RING, CORRIDORS, "--json") == 0
        out, err = capsys.readouterr()
        assert err == ""
        first, second = json_lines(out)
        assert (first["file"], second["file"]) == (str(RING), str(CORRIDORS))
        assert (first["segments"], second["segments"]) == (2, 3)
        first.pop("file")
        assert Solution.from_document(first).status == "optimal"

    def test_search_space_surface(self, capsys: Capture) -> None:
        assert run("solve", CORRIDORS, "--search-space", "surface", "--json") == 0
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["search_space"], line["strands"], line["segments"]) == ("surface", 2, 2)
        assert line["proved_for_surface"] is True

    def test_one_strand_is_the_paper(self, capsys: Capture) -> None:
        """Not proved for the surface, though nothing better exists with one strand: exit code 3."""
        code = run("solve", CORRIDORS, "--search-space", "surface", "--strands", 1, "--json")
        assert code == 3
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["segments"], line["status"], line["surface_lower_bound"]) == (3, "feasible", 2)

    @pytest.mark.parametrize("solver", ["cp-sat", "dfs"])
    def test_solvers(self, solver: str, capsys: Capture) -> None:
        assert run("solve", ZEROS, "--solver", solver, "--json") == 0
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["solver"], line["segments"]) == (solver, 2)

    def test_surface_like_its_instance(self, tmp_path: Path, capsys: Capture) -> None:
        """What build writes beside a surface is what solve makes of that surface."""
        surface = tmp_path / "s.surface.json"
        surface.write_text((PAPER / "ring.surface.json").read_text("utf-8"), encoding="utf-8")
        assert run("build", surface, "-o", tmp_path / "s.json") == 0
        capsys.readouterr()
        assert run("solve", surface, tmp_path / "s.json", "--json") == 0
        lines = json_lines(capsys.readouterr().out)
        assert [line["segments"] for line in lines] == [2, 2]
        assert lines[0]["instance"] == lines[1]["instance"]

    def test_output_file(self, tmp_path: Path) -> None:
        out = tmp_path / "solution.json"
        assert run("solve", RING, "-o", out) == 0
        assert Solution.read(out).segments == 2
        assert list(tmp_path.iterdir()) == [out]
        assert run("check", RING, out) == 0

    def test_output_folder(self, tmp_path: Path) -> None:
        folder = tmp_path / "new"
        assert run("solve", RING, CORRIDORS, "-o", folder) == 0
        assert sorted(path.name for path in folder.iterdir()) == [
            "parallel-corridors.solution.json",
            "ring.solution.json",
        ]
        assert Solution.read(folder / "ring.solution.json").segments == 2
        assert run("solve", ZEROS, "-o", folder) == 0  # an existing folder, for one input too
        assert Solution.read(folder / "crossing-zeros.solution.json").segments == 2

    def test_a_bad_file_does_not_stop_the_others(self, tmp_path: Path, capsys: Capture) -> None:
        bad = tmp_path / "bad.json"
        bad.write_text("{", encoding="utf-8")
        folder = tmp_path / "out"
        assert run("solve", RING, bad, ZEROS, "--json", "-o", folder) == 2
        out, err = capsys.readouterr()
        first, second, third = json_lines(out)
        assert (first["segments"], third["segments"]) == (2, 2)
        assert set(second) == {"file", "error"}
        assert second["file"] == str(bad)
        (line,) = err.splitlines()
        assert str(bad) in line
        assert len(list(folder.iterdir())) == 2

    def test_overview_of_several(self, capsys: Capture) -> None:
        assert run("solve", RING, CORRIDORS) == 0
        rows = [line.split()[:4] for line in capsys.readouterr().out.splitlines()]
        assert [str(RING), "3", "2", "1"] in rows
        assert [str(CORRIDORS), "6", "3", "2"] in rows

    @pytest.mark.usefixtures("not_proved")
    def test_not_proved(self, tmp_path: Path, capsys: Capture) -> None:
        out = tmp_path / "best.json"
        assert run("solve", RING, "-o", out, "--json") == 3
        assert Solution.read(out).status == "feasible"
        assert json_lines(capsys.readouterr().out)[0]["segments"] == 2
        assert run("solve", RING, tmp_path / "none.json") == 2  # 2 wins over 3

    def test_time_limit(self, tmp_path: Path) -> None:
        out = tmp_path / "best.json"
        hub = INSTANCES / "random" / "hub_44.json"
        assert run("solve", hub, "--solver", "dfs", "--time-limit", 0.05, "-o", out) == 3
        solution = Solution.read(out)
        assert solution.status in ("feasible", "unknown")
        assert run("check", hub, out) == 0

    @pytest.mark.parametrize(
        ("instance", "options"),
        [
            # What is found first has more segments than the proof will leave.
            (INSTANCES / "random" / "hub_44.json", []),
            (INSTANCES / "random" / "hub_24.json", ["--solver", "dfs"]),
        ],
        ids=["cp-sat", "dfs"],
    )
    def test_interrupt(self, instance: Path, options: list[str], tmp_path: Path) -> None:
        """Ctrl-C ends the search, the best found is written, and the files after it are left."""
        arguments = ["solve", instance, RING, "-o", tmp_path, *options]
        done = subprocess.run(
            [sys.executable, "-c", INTERRUPTED, *map(str, arguments)], check=False
        )
        assert done.returncode == 3
        (written,) = tmp_path.iterdir()
        assert Solution.read(written).status == "feasible"
        assert run("check", instance, written) == 0

    def test_empty_instance(self, tmp_path: Path, capsys: Capture) -> None:
        empty = INSTANCE | {"cells": [], "edges": [], "known": {}}
        empty.pop("surface")
        path = tmp_path / "empty.json"
        path.write_text(json.dumps(empty), encoding="utf-8")
        for solver in ("cp-sat", "dfs"):
            assert run("solve", path, "--json", "--solver", solver) == 0
            (line,) = json_lines(capsys.readouterr().out)
            assert (line["segments"], line["lift_offs"], line["cells"]) == (0, 0, [])
        assert run("solve", path) == 0

    def test_progress_only_for_people(
        self, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
        monkeypatch.setenv("TERM", "xterm")
        assert run("solve", RING, "--json") == 0
        out, err = capsys.readouterr()
        assert "ring.json" in err
        assert len(json_lines(out)) == 1


class TestMore:
    """Options beyond the contract: a second objective, a start, a warning, a reason."""

    def test_fewest_cuts(self, tmp_path: Path, capsys: Capture) -> None:
        target = tmp_path / "solution.json"
        assert run("solve", PAPER / "split-cell.json", "--fewest-cuts", "-o", target) == 0
        assert "cutting paths  1 (fewest)" in capsys.readouterr().out
        solution = Solution.read(target)
        assert (solution.cutting_paths, solution.cutting_paths_lower_bound) == (1, 1)
        assert run("check", PAPER / "split-cell.json", target) == 0

    def test_warm_start(self, tmp_path: Path) -> None:
        """A start that is optimal already is what comes back when there is no time for more."""
        start, target = tmp_path / "start.json", tmp_path / "solution.json"
        instance = INSTANCES / "random" / "hub_24.json"
        assert run("solve", instance, "-o", start) == 0
        assert run("solve", instance, "--warm-start", start, "--time-limit", "1e-9", "-o", target)
        assert Solution.read(target).cells == Solution.read(start).cells
        # Without it every cell is painted whole, so that only one color's petals are joined.
        assert run("solve", instance, "--time-limit", "1e-9", "-o", target)
        assert (Solution.read(target).segments or 0) > (Solution.read(start).segments or 0)

    @pytest.mark.parametrize(
        ("arguments", "expected"),
        [
            ([RING], "instance.sha256: the solution is not for"),
            ([CORRIDORS, "--search-space", "surface"], "strands: is 1, wanted are 2"),
        ],
    )
    def test_wrong_start(
        self, arguments: list[object], expected: str, tmp_path: Path, capsys: Capture
    ) -> None:
        start = tmp_path / "start.json"
        assert run("solve", CORRIDORS, "-o", start) == 0
        capsys.readouterr()
        assert run("solve", *arguments, "--warm-start", start) == 2
        err = capsys.readouterr().err
        assert err.count("\n") == 1 and str(start) in err and expected in err

    def test_too_many_workers(self, capsys: Capture) -> None:
        assert run("solve", RING, "--workers", 1000) == 0
        assert "1000 workers share" in capsys.readouterr().err

    def test_reason_for_the_bound(self, capsys: Capture) -> None:
        assert run("solve", RING) == 0
        # Cells 0 and 1 have red, and cell 2 in the middle is blue.
        out = capsys.readouterr().out
        assert any(f"no two of the cells {cell}, 2 can be" in out for cell in (0, 1))


def _free(cells: int, colors: int) -> Instance:
    """Cells without borders, each with all colors."""
    own = tuple(range(colors))
    return Instance("free", tuple(map(str, own)), tuple(Cell(i, own, ()) for i in range(cells)), ())


class TestAllSchemes:
    @pytest.mark.parametrize("solver", ["cp-sat", "dfs"])
    def test_all(self, solver: str, tmp_path: Path, capsys: Capture) -> None:
        out = tmp_path / "all.jsonl"
        assert run("solve", ZEROS, "--all", "--solver", solver, "-o", out, "--json") == 0
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (3, True)
        solution, *schemes = json_lines(out.read_text(encoding="utf-8"))
        assert (solution["format"], solution["schemes"]) == ("cellcolor/solution", 3)
        assert [scheme["format"] for scheme in schemes] == ["cellcolor/scheme"] * 3
        assert len({scheme_key(division) for division in read_schemes(out)}) == 3
        assert list(tmp_path.iterdir()) == [out]
        assert run("check", ZEROS, out) == 0

    def test_table(self, capsys: Capture) -> None:
        assert run("solve", PAPER / "figeasycell3.json", "--all") == 0
        rows = [line.split() for line in capsys.readouterr().out.splitlines()]
        assert ["schemes", "3", "(all", "of", "them)"] in rows

    @pytest.mark.parametrize(("limit", "schemes", "complete"), [(1, 1, False), (2, 2, False)])
    def test_limit(
        self, limit: int, schemes: int, complete: bool, tmp_path: Path, capsys: Capture
    ) -> None:
        out = tmp_path / "some.jsonl"
        assert run("solve", ZEROS, "--all", "--limit", limit, "-o", out, "--json") == 3
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (schemes, complete)
        assert len(list(read_schemes(out))) == limit
        assert run("check", ZEROS, out) == 0

    def test_limit_that_is_just_enough(self, capsys: Capture) -> None:
        assert run("solve", ZEROS, "--all", "--limit", 3, "--json") == 0
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (3, True)

    @pytest.mark.parametrize(
        ("cells", "colors", "code", "complete"),
        # Cells without a border are painted in any of their colors: 1000 and 1024 schemes.
        [(3, 10, 0, True), (10, 2, 3, False)],
    )
    def test_a_thousand_unless_asked_for_more(
        self,
        cells: int,
        colors: int,
        code: int,
        complete: bool,
        tmp_path: Path,
        capsys: Capture,
    ) -> None:
        path, out = tmp_path / "free.json", tmp_path / "all.jsonl"
        path.write_text(_free(cells, colors).to_json(), encoding="utf-8")
        assert run("solve", path, "--all", "-o", out, "--json") == code
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (1000, complete)
        assert len({scheme_key(division) for division in read_schemes(out)}) == 1000
        assert run("solve", path, "--all", "--limit", 1024, "--json") == 0
        (line,) = json_lines(capsys.readouterr().out.splitlines()[-1])
        assert (line["schemes"], line["complete"]) == (colors**cells, True)

    def test_progress_counts_schemes(
        self, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
        monkeypatch.setenv("TERM", "xterm")
        assert run("solve", ZEROS, "--all", "--json") == 0
        out, err = capsys.readouterr()
        assert "3 schemes so far" in err
        assert json_lines(out)[0]["schemes"] == 3

    @pytest.mark.parametrize("ctrl_c", [False, True])
    def test_stopped(
        self,
        ctrl_c: bool,
        tmp_path: Path,
        capsys: Capture,
        monkeypatch: pytest.MonkeyPatch,
    ) -> None:
        """What was found before the end of the time, or Ctrl-C, is written."""
        enumerate_schemes = cellcolor.solvers.checked.enumerate_schemes

        def interrupted(*arguments: Any) -> Iterator[Division]:
            yield next(iter(enumerate_schemes(*arguments)))
            if ctrl_c:
                signal.raise_signal(signal.SIGINT)
            raise OutOfTime("time")

        monkeypatch.setattr(cellcolor.solvers.checked, "enumerate_schemes", interrupted)
        out = tmp_path / "some.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out, "--json") == 3
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["status"], line["schemes"], line["complete"]) == ("optimal", 1, False)
        assert len(list(read_schemes(out))) == 1
        assert list(tmp_path.iterdir()) == [out]

    @pytest.mark.parametrize("moment", ["before", "within", "after"])
    def test_a_signal_while_a_scheme_is_written(
        self, moment: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The solution counts exactly the schemes that follow it, all of them whole."""

        class Spool(io.BytesIO):
            def write(self, line: Any) -> int:
                if not self.getvalue():
                    return super().write(line)
                if moment != "before":
                    super().write(line[: len(line) // 2] if moment == "within" else line)
                signal.raise_signal(signal.SIGINT)
                raise AssertionError("the signal was not heard")

        monkeypatch.setattr(cellcolor.cli.solve, "_spool", lambda _: nullcontext(Spool()))
        out = tmp_path / "some.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out) == 3
        assert (Solution.read(out).schemes, len(list(read_schemes(out)))) == (1, 1)
        assert run("check", ZEROS, out) == 0
        assert "1 schemes" in capsys.readouterr().out

    def test_too_large(
        self, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The minimum is found all the same, and the solution says why there are no schemes."""
        monkeypatch.setattr(cellcolor.solvers.cpsat.schemes.enumeration, "_MOST_LITERALS", 1)
        out = tmp_path / "none.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out) == 3
        solution = Solution.read(out)
        assert (solution.status, solution.schemes, solution.complete) == ("optimal", 0, False)
        (note,) = solution.notes
        assert note.startswith("The model of all schemes was not built")
        assert note in capsys.readouterr().out
        assert run("check", ZEROS, out) == 0

    @pytest.mark.usefixtures("not_proved")
    def test_no_schemes_of_what_is_not_proved(self, tmp_path: Path, capsys: Capture) -> None:
        out = tmp_path / "none.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out, "--json") == 3
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (0, False)
        assert list(read_schemes(out)) == []

    def test_cell_with_several_live_loops(self, tmp_path: Path, capsys: Capture) -> None:
        out = tmp_path / "x.jsonl"
        """The depth-first search lists no schemes of such cells."""
        command = ("solve", PAPER / "annulus.json", "--all", "--solver", "dfs", "-o", out)
        assert run(*command) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert "annulus.json: cells[1].loops: " in line
        assert not out.exists()

    def test_several_loops_of_which_one_is_live(self, tmp_path: Path, capsys: Capture) -> None:
        """Rule 5 speaks of live darts only: an unreachable hole does not count."""
        hole = {
            "format": "cellcolor/instance",
            "version": 1,
            "name": "hole",
            "colors": ["red"],
            "cells": [{"id": 0, "colors": [0], "loops": [[1], [2]]}],
            "edges": [{"id": 1, "left": 0, "right": -1}, {"id": 2, "left": 0, "right": -1}],
        }
        path = tmp_path / "hole.json"
        path.write_text(json.dumps(hole), encoding="utf-8")
        assert run("solve", path, "--all", "--json") == 0
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["segments"], line["schemes"], line["complete"]) == (1, 1, True)
