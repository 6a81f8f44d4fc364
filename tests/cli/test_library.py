"""``cellcolor library`` and ``cellcolor import``."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from commands import json_lines, run

import cellcolor
from cellcolor.data.imcgs import read_imcgs
from cellcolor.data.library_index import LibraryIndex
from cellcolor.door.installed import Library

Capture = pytest.CaptureFixture[str]
INDEX = cellcolor.library().index

GRAPH = "2 3\n0 1\n1 2\n1 2\n2\n-1 0\n0 1\n1 -1\n"


def test_all_names(capsys: Capture) -> None:
    assert run("library") == 0
    said = capsys.readouterr().out
    assert said == f"{cellcolor.library()}\n"
    assert {entry.name for entry in INDEX.entries} < {line.split()[0] for line in said.splitlines()}


def test_as_json(capsys: Capture) -> None:
    assert run("library", "--json") == 0
    rows = json_lines(capsys.readouterr().out)
    assert [row["name"] for row in rows] == [entry.name for entry in INDEX.entries]


def test_import(tmp_path: Path, capsys: Capture) -> None:
    source, output = tmp_path / "graph.txt", tmp_path / "two.json"
    source.write_text(GRAPH, encoding="utf-8")
    assert run("import", source, "-o", output) == 0
    assert capsys.readouterr().out == f"wrote {output}: 2 cells, 3 edges, 2 colors\n"
    assert cellcolor.read(output).name == "two"
    assert cellcolor.solve(output).segments == 1


def test_import_corrected(tmp_path: Path, capsys: Capture) -> None:
    source, output = tmp_path / "graph.txt", tmp_path / "two.json"
    source.write_text(GRAPH.replace("1 -1", "0 -1"), encoding="utf-8")
    assert run("import", source, "-o", output) == 2
    text = "line 8: edge 2 lies between 0 and -1 here, but in the lists of cells: 1"
    assert capsys.readouterr().err == f"cellcolor: {source}: {text}\n"
    assert not output.exists()
    assert run("import", source, "-o", output, "--correct", "2=1,-1") == 0
    meta = json.loads(output.read_text(encoding="utf-8"))["meta"]
    assert meta == {"made_by": "cellcolor import graph.txt --correct 2=1,-1"}


def test_a_graph_that_is_in_the_library_is_recognised(
    tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By its fingerprint: the figure of two cells, written in the other format."""
    source, output = tmp_path / "graph.txt", tmp_path / "two.json"
    source.write_text(GRAPH, encoding="utf-8")
    index = LibraryIndex((replace(INDEX["ring"], fingerprint=read_imcgs(source).sha256),))
    monkeypatch.setattr(Library, "index", index)
    assert run("import", source, "-o", output) == 0
    assert capsys.readouterr().out.endswith("This is ring of the library: 2 segments.\n")
