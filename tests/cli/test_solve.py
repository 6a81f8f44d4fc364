"""``solve``: exit codes, what goes to standard output, and what is written."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from commands import json_lines, run
from library import INSTANCES, PAPER

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution

RING = PAPER / "ring.json"

CORRIDORS = PAPER / "parallel-corridors.json"

ZEROS = PAPER / "crossing-zeros.json"

Capture = pytest.CaptureFixture[str]

# Ctrl-C as soon as the search has a division: from another thread if it runs in one.
INTERRUPTED = """
import contextlib, signal, sys, threading
import cellcolor.cli, cellcolor.cli.solving

sent = threading.Event()

@contextlib.contextmanager
def watched(_file, _work):
    def report(text):
        searching = "dfs" in sys.argv or threading.current_thread() is not threading.main_thread()
        if text.startswith("best") and searching and not sent.is_set():
            sent.set()
            signal.pthread_kill(threading.main_thread().ident, signal.SIGINT)
    yield report

cellcolor.cli.solving.line_of = watched
code = cellcolor.cli.main(sys.argv[1:])
sys.exit(code if sent.is_set() else 99)
"""


class TestSolve:
    def test_table(self, capsys: Capture) -> None:
        assert run("solve", ZEROS) == 0
        out, err = capsys.readouterr()
        assert err == ""
        assert "\n2 segments, 1 lift-off, optimal: proved for any division of the surface" in out
        assert " s with cp-sat, search space paper\n" in out
        assert "\x1b" not in out
        assert "part of 0" in out

    def test_a_table_has_200_segments_at_most(self, tmp_path: Path, capsys: Capture) -> None:
        """250 cells apart from each other are 250 segments."""
        path = tmp_path / "apart.json"
        cells = tuple(Cell(number, (0,), ()) for number in range(250))
        path.write_text(Instance("apart", ("red",), cells, ()).to_json(), encoding="utf-8")
        assert run("solve", path) == 0
        out = capsys.readouterr().out
        rows = [line.split() for line in out.splitlines()]
        assert [row[:3] for row in rows if "red" in row] == [
            [str(number), "red", str(number)] for number in range(200)
        ]
        assert ["…", "50", "more", "segments"] in rows
        assert "\n250 segments, 249 lift-offs, " in out

    def test_json_is_all_there_is(self, capsys: Capture) -> None:
        assert run("solve", RING, CORRIDORS, "--json") == 0
        out, err = capsys.readouterr()
        assert err == ""
        first, second = json_lines(out)
        assert (first["file"], second["file"]) == (str(RING), str(CORRIDORS))
        assert (first["segments"], second["segments"]) == (2, 3)
        first.pop("file")
        assert Solution.from_document(first).status == "optimal"

    def test_one_strand_is_the_paper(self, capsys: Capture) -> None:
        """Not proved for the surface, though nothing better exists with one strand: exit code 3."""
        code = run("solve", CORRIDORS, "--search-space", "surface", "--strands", 1, "--json")
        assert code == 3
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["segments"], line["status"], line["surface_lower_bound"]) == (3, "feasible", 2)

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
            # Its model takes minutes, so that the search does not end before the signal comes.
            pytest.param(INSTANCES / "hubs" / "hub_loops_2x10.json", [], marks=pytest.mark.second),
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

    def test_progress_only_for_people(
        self, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
        monkeypatch.setenv("TERM", "xterm")
        assert run("solve", RING, "--json") == 0
        out, err = capsys.readouterr()
        assert "ring.json" in err
        assert len(json_lines(out)) == 1

    def test_reason_for_the_bound(self, capsys: Capture) -> None:
        assert run("solve", RING) == 0
        # Cells 0 and 1 have red, and cell 2 in the middle is blue.
        out = capsys.readouterr().out
        assert any(
            f"because cells {cell} and 2 share no color" in " ".join(out.split()) for cell in (0, 1)
        )

    def test_what_proves_a_minimum_of_the_search_space(self, capsys: Capture) -> None:
        assert run("solve", CORRIDORS, "--solver", "dfs") == 0
        assert "optimal in the search space paper, by exhaustive search" in " ".join(
            capsys.readouterr().out.split()
        )
