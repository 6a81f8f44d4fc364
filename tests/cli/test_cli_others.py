"""``build`` and ``check``: exit codes, standard output, and what is written."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from commands import json_lines, run
from documents import SURFACE
from library import PAPER

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose

RING = PAPER / "ring.json"
ZEROS = PAPER / "crossing-zeros.json"
Capture = pytest.CaptureFixture[str]


class TestBuild:
    def test_surface(self, tmp_path: Path, capsys: Capture) -> None:
        source = tmp_path / "surfaces" / "s.json"
        source.parent.mkdir()
        source.write_text(json.dumps(SURFACE), encoding="utf-8")
        out = tmp_path / "graphs" / "s.json"
        out.parent.mkdir()
        assert run("build", source, "-o", out) == 0
        instance = Instance.read(out)
        assert instance.surface is not None
        assert instance.surface.path == "../surfaces/s.json"
        assert (out.parent / instance.surface.path).resolve() == source.resolve()
        built = decompose(LabelledSurface.read(source), instance.surface.path)
        assert built.to_json() == out.read_text(encoding="utf-8")
        assert ": 1 cell, 2 edges, 2 colors\n" in capsys.readouterr().out

    def test_of_an_instance(self, tmp_path: Path, capsys: Capture) -> None:
        assert run("build", RING, "-o", tmp_path / "x.json") == 2
        assert "is an instance already" in capsys.readouterr().err
        assert list(tmp_path.iterdir()) == []


class TestCheck:
    @pytest.fixture
    def solved(self, tmp_path: Path) -> Path:
        out = tmp_path / "all.jsonl"
        assert run("solve", ZEROS, "--all", "-o", out) == 0
        return out

    def change(self, path: Path, line: int, change: Any) -> None:
        documents = json_lines(path.read_text(encoding="utf-8"))
        change(documents[line])
        path.write_text("".join(json.dumps(d) + "\n" for d in documents), encoding="utf-8")

    def test_wrong_number(self, solved: Path, capsys: Capture) -> None:
        self.change(solved, 0, lambda d: d.update(segments=1, lift_offs=0))
        assert run("check", ZEROS, solved) == 1
        out = capsys.readouterr().out
        assert "not valid" in out
        assert "segments: says 1" in out

    def test_wrong_scheme(self, solved: Path, capsys: Capture) -> None:
        self.change(solved, 2, lambda d: d["cells"][1]["subcells"][0].update(color=1))
        assert run("check", ZEROS, solved, "--json") == 1
        (line,) = json_lines(capsys.readouterr().out.splitlines()[-1])
        assert all(problem.startswith("scheme 2: ") for problem in line["problems"])

    def test_same_scheme_twice(self, solved: Path, capsys: Capture) -> None:
        lines = solved.read_text(encoding="utf-8").splitlines()
        lines[3] = lines[1]
        solved.write_text("\n".join(lines) + "\n", encoding="utf-8")
        assert run("check", ZEROS, solved) == 1
        assert "scheme 3: an earlier line has the same scheme" in capsys.readouterr().out

    def test_scheme_missing(self, solved: Path, capsys: Capture) -> None:
        lines = solved.read_text(encoding="utf-8").splitlines()
        solved.write_text("\n".join(lines[:3]) + "\n", encoding="utf-8")
        assert run("check", ZEROS, solved) == 1
        assert "schemes: says 3, listed are 2" in capsys.readouterr().out


def test_a_plan_is_not_checked_against_a_graph_alone(tmp_path: Path, capsys: Capture) -> None:
    plan, graph = tmp_path / "plan.json", RING.with_name("crossing-zeros.json")
    plan.write_text('{"format": "cellcolor/plan", "version": 1, "vertex_colors": [0]}')
    assert run("check", graph, plan) == 2
    assert capsys.readouterr().err == (
        f"cellcolor: {plan}: format: is a plan, which goes with a labelled surface; "
        f"{graph} names none\n"
    )


def test_an_instance_is_not_written_where_it_would_be_a_scene(
    tmp_path: Path, capsys: Capture
) -> None:
    output = tmp_path / "wok.toml"
    assert run("build", RING.with_suffix(".surface.json"), "-o", output) == 2
    assert "must not end in .toml" in capsys.readouterr().err
    assert not output.exists()
