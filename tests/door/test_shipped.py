"""The shipped library is opened by name, from a repository and from a wheel."""

from __future__ import annotations

import os
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from guides import build_wheel
from library import INSTANCES, PAPER
from shipped import ROBOTS, SCENES, TOP

import cellcolor
from cellcolor.cli import main
from cellcolor.door.installed import find_file, library
from cellcolor.errors import InputError


@pytest.mark.second
def test_every_shipped_file_has_its_name() -> None:
    files = [*INSTANCES.rglob("*.json"), *INSTANCES.rglob("*.toml"), *ROBOTS.glob("*.toml")]
    files.remove(INSTANCES / "index.json")
    assert len({file.name for file in files}) == len(files)  # no name stands for two files
    for file in files:
        assert find_file(file.name) == file
    listed = library()
    index = listed.index
    outside = {entry.name for entry in index.entries if entry.file is None}
    assert {file.name.partition(".")[0] for file in files} | outside == set(listed)
    assert all(line and "\n" not in line for line in listed.values())
    assert len(str(listed).splitlines()) == len(listed)
    assert len(index) == len(index.entries) and [index[name] for name in index] == [*index.entries]
    for entry in index.entries:
        if entry.file is None:
            with pytest.raises(InputError, match=f"{entry.name}: is not shipped; it is data/"):
                find_file(entry.name)
            continue
        file = INSTANCES / entry.file
        assert find_file(entry.name) in (file, file.with_name(f"{entry.name}.toml"))


def test_lines_say_what_is_known() -> None:
    listed = library()
    assert listed["parallel-corridors"] == "graph, by hand: 6 cells, 3 segments."
    assert listed["blobs_0"] == "surface, blobs: 38 cells, 3 segments."
    assert listed["cardoor"] == "graph, not here, parts: 10 cells, 2 segments."
    assert listed["wok"].startswith("scene: ")
    assert listed["wok"].endswith(". Its graph: 5 cells, 2 segments.")
    assert listed["ur5_polishing"].startswith("robot: ")


def test_stored_solutions_are_checked_by_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "ring", "ring.solution.json"]) == 0
    assert "valid" in capsys.readouterr().out
    assert cellcolor.check("ring", "ring.solution.json").segments == 2
    # The name of a graph is none of a solution.
    assert main(["check", "ring", "ring.json"]) == 2
    assert "ring.json: No such file" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "file"),
    [
        ("wok", SCENES / "wok.toml"),
        ("wok.json", SCENES / "wok.json"),
        ("wok.surface.json", SCENES / "wok.surface.json"),
        ("figforcolor", PAPER / "figforcolor.json"),
        ("blobs_0", INSTANCES / "random" / "blobs_0.surface.json"),
        ("ur5_polishing", ROBOTS / "ur5_polishing.toml"),
    ],
)
def test_a_name_is_a_scene_or_else_a_graph_or_else_a_surface(name: str, file: Path) -> None:
    assert find_file(name) == file


def test_a_file_goes_before_a_shipped_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert find_file("ring") == PAPER / "ring.json"
    (tmp_path / "wok").mkdir()
    assert find_file("wok") == SCENES / "wok.toml"  # a folder is no file
    (tmp_path / "ring").write_text((PAPER / "split-cell.json").read_text(encoding="utf-8"))
    assert find_file("ring") == Path("ring")
    assert cellcolor.read("ring") == cellcolor.read(PAPER / "split-cell.json")


def test_a_path_is_no_name() -> None:
    assert find_file(Path("wok")) == Path("wok")
    with pytest.raises(InputError, match="wok: No such file"):
        cellcolor.read(Path("wok"))


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("wokk", "wokk: is not a file, and nothing of that name is shipped; did you mean 'wok'?"),
        ("qqqqqq", "qqqqqq: is not a file, and nothing of that name is shipped"),
        ("wokk.toml", "wokk.toml: No such file or directory"),
        ("some/where", "some/where: No such file or directory"),
        ("", "'' is not a file name"),
        (
            '{"format": "cellcolor/plan", "version": 1, "vertex_colors": [0]}',
            '\'{"format": "cellcolor/plan", "…\' is the content of a file, not its name',
        ),
        ("a\0b", "is not a file, and nothing of that name is shipped"),
    ],
)
def test_unknown_names(name: str, text: str) -> None:
    with pytest.raises(InputError) as caught:
        cellcolor.read(name)
    assert text in str(caught.value)


SOLVE = """
import cellcolor
assert cellcolor.__file__.startswith({folder!r}), cellcolor.__file__
print(cellcolor.solve("wok"))
names = cellcolor.library()
for entry in names.index.entries:
    if entry.file is not None:
        cellcolor.read(entry.file.rpartition("/")[2])
print(len(names))
"""


@pytest.mark.slow
def test_a_wheel_has_it_all(tmp_path: Path) -> None:
    """Built, unpacked elsewhere, and used from a folder that knows nothing of the repository."""
    pytest.importorskip("hatchling")
    wheel = build_wheel(tmp_path / "wheels")
    folder = tmp_path / "site"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    names = {file.relative_to(TOP) for place in ("instances", "models") for file in _files(place)}
    there = folder / "cellcolor" / "shipped"
    for name in names:
        assert (there / name).read_bytes() == (TOP / name).read_bytes()
    script = SOLVE.format(folder=str(folder))
    environment = os.environ | {"PYTHONPATH": str(folder)}
    empty = tmp_path / "empty"
    empty.mkdir()
    for command in (
        ["-c", script],
        ["-m", "cellcolor", "solve", "wok"],
    ):
        done = subprocess.run(
            [sys.executable, *command], cwd=empty, env=environment, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stderr
        assert "optimal" in done.stdout and "cells 3 and 4 share no color" in done.stdout
    assert list(empty.iterdir()) == []


def _files(place: str) -> list[Path]:
    found = (file for file in (TOP / place).rglob("*") if file.is_file())
    return [file for file in found if file.parent.name != "__pycache__"]
