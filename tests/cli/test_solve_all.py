"""``solve --all``: every optimal scheme, as many as asked for."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest
from commands import json_lines, run
from library import PAPER

import cellcolor.cli.solving
import cellcolor.solvers.checked
import cellcolor.solvers.cpsat.frontier
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Solution, read_schemes, scheme_key, scheme_line
from cellcolor.deadline import OutOfTime

ZEROS = PAPER / "crossing-zeros.json"

Capture = pytest.CaptureFixture[str]


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

    @pytest.mark.parametrize(("limit", "code"), [(1, 3), (2, 3), (3, 0)])
    def test_limit(self, limit: int, code: int, tmp_path: Path, capsys: Capture) -> None:
        """There are three; a limit that is just enough leaves nothing open."""
        out = tmp_path / "some.jsonl"
        assert run("solve", ZEROS, "--all", "--limit", limit, "-o", out, "--json") == code
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (limit, limit == 3)
        assert len(list(read_schemes(out))) == limit
        assert run("check", ZEROS, out) == 0

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

        def interrupted(*arguments: Any, **options: Any) -> Iterator[Division]:
            yield next(iter(enumerate_schemes(*arguments, **options)))
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

    @pytest.mark.parametrize("moment", ["before", "after"])
    def test_a_signal_while_a_scheme_is_kept(
        self, moment: str, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The solution counts exactly the schemes that follow it."""
        kept: list[str] = []

        def show(_text: str) -> None:
            if moment == "after" and kept[1:]:
                signal.raise_signal(signal.SIGINT)

        def line(division: Division) -> str:
            kept.append(scheme_line(division))
            if moment == "before" and kept[1:]:
                signal.raise_signal(signal.SIGINT)
            return kept[-1]

        monkeypatch.setattr(cellcolor.cli.solving, "scheme_line", line)
        monkeypatch.setattr(cellcolor.cli.solving, "line_of", lambda *_: nullcontext(show))
        out = tmp_path / "some.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out) == 3
        assert (Solution.read(out).schemes, len(list(read_schemes(out)))) == (1, 1)
        assert run("check", ZEROS, out) == 0
        assert "1 scheme\n" in capsys.readouterr().out

    def test_too_large(
        self, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        """The minimum is found all the same, and the solution says why it has one scheme only."""
        monkeypatch.setattr(cellcolor.solvers.cpsat.frontier, "MOST_STEPS", -1)
        out = tmp_path / "none.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out) == 3
        solution = Solution.read(out)
        assert (solution.status, solution.schemes, solution.complete) == ("optimal", 1, False)
        (note,) = solution.notes
        assert note.startswith("the schemes have too many fronts to be counted")
        assert note in capsys.readouterr().out
        assert run("check", ZEROS, out) == 0

    @pytest.mark.usefixtures("not_proved")
    def test_no_schemes_of_what_is_not_proved(self, tmp_path: Path, capsys: Capture) -> None:
        out = tmp_path / "none.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out, "--json") == 3
        (line,) = json_lines(capsys.readouterr().out)
        assert (line["schemes"], line["complete"]) == (0, False)
        assert list(read_schemes(out)) == []


def test_a_few_of_very_many(tmp_path: Path, capsys: Capture) -> None:
    file, out = tmp_path / "free.json", tmp_path / "few.jsonl"
    file.write_text(_free(40, 2).to_json())
    assert run("solve", file, "--all", "--limit", 5, "-o", out, "--json") == 3
    (line,) = json_lines(capsys.readouterr().out)
    assert (line["schemes"], line["complete"]) == (5, False)
    assert f"There are {2**40:,} optimal schemes; 5 of them are listed." in line["notes"]
    assert len({scheme_key(division) for division in read_schemes(out)}) == 5
    assert run("check", file, out) == 0
