"""What cannot be shown: one clear line, exit code 2, nothing written."""

from __future__ import annotations

import json
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from documents import Document
from library import PAPER
from pages import DRAWN, saved, side_file, small_wok

from cellcolor.cli import main
from cellcolor.data.instance import SurfaceReference
from cellcolor.decomposition import decompose

Capture = pytest.CaptureFixture[str]


def refused(arguments: list[object], capsys: Capture, *named: str) -> None:
    capsys.readouterr()
    assert main(["show", *map(str, arguments)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    (line,) = captured.err.splitlines()
    for text in named:
        assert text in line


def test_arms(tmp_path: Path, capsys: Capture) -> None:
    from reasons import Reason

    from cellcolor.frontend import build_surface

    scene = small_wok(tmp_path)
    result = build_surface(scene)
    vertex, branch = (int(k) for k in np.argwhere(result.reasons == Reason.GROUND)[0])
    name = result.branches[branch]
    arm = [scene, "-o", tmp_path / "x.png", "--vertex"]
    refused([*arm, vertex, "--branch", name], capsys, f": branch: '{name}' is not valid", "ground")
    refused([*arm, 91, "--branch", name], capsys, "vertex", "0 to 90")
    refused([*arm, 0, "--branch", "elbow"], capsys, "branch", "'elbow'", name)
    refused([*arm, 0, "--branch", "8"], capsys, "branch", "'8'")
    refused([scene, "-o", tmp_path / "x.png", "--color", "red"], capsys, "'red'")
    assert list(tmp_path.iterdir()) == [scene.parent]


def test_files(tmp_path: Path, capsys: Capture) -> None:
    path = saved(DRAWN, tmp_path)
    out = tmp_path / "x.png"
    refused([tmp_path / "none.json", "-o", out], capsys, "none.json", "No such file")
    refused([path, "-o", tmp_path / "x.pdf"], capsys, "x.pdf", ".html, .png or .svg")
    refused([path, "-o", tmp_path / "none" / "x.png"], capsys, "folder does not exist")
    refused([path, "-o", out, "--color", "pink"], capsys, str(path), "'pink'", "0 'red'")
    refused([path, "-o", out, "--color", "3"], capsys, str(path), "'3'")
    refused([path, "-o", out, "--color", "-1"], capsys, "'-1'")
    refused([path, "-o", out, "--view", "reasons"], capsys, "meta.side_file", "missing")
    refused([path, "-o", out, "--vertex", 0, "--branch", "0"], capsys, "scene")
    assert list(tmp_path.iterdir()) == [path]


def test_instances(tmp_path: Path, capsys: Capture) -> None:
    out = tmp_path / "x.png"
    graph = [PAPER / "ring.json", "-o", out, "--view", "cells"]
    refused(graph, capsys, "ring.json: surface", "--view", "graph")
    instance = decompose(DRAWN, "none.surface.json")
    path = tmp_path / "i.json"
    path.write_text(instance.to_json())
    refused([path, "-o", out], capsys, "none.surface.json", "No such file")
    saved(DRAWN, tmp_path)
    assert instance.surface is not None
    for change, field in (
        (instance.surface.vertex_cell[:-1], "surface.path"),
        ((1, *instance.surface.vertex_cell[1:]), "surface.vertex_cell[0]"),
    ):
        reference = SurfaceReference("drawn.surface.json", change)
        path.write_text(replace(instance, surface=reference).to_json())
        refused([path, "-o", out], capsys, str(path), field)
    assert not out.exists()


def test_solutions(tmp_path: Path, capsys: Capture) -> None:
    path, out = saved(DRAWN, tmp_path), tmp_path / "x.png"
    solution = tmp_path / "solution.json"
    assert main(["solve", str(PAPER / "ring.surface.json"), "-o", str(solution)]) == 0
    refused([path, solution, "-o", out], capsys, str(solution), "sha256")
    assert main(["solve", str(path), "-o", str(solution)]) == 0
    document = json.loads(solution.read_text())
    document["cells"][0]["subcells"][0]["color"] = 2
    solution.write_text(json.dumps(document))
    refused([path, solution, "-o", out], capsys, str(solution), "color")
    none = {"status": "unknown", "segments": None, "lift_offs": None, "cells": None}
    solution.write_text(json.dumps(document | none | {"proved_for_surface": False}))
    refused([path, solution, "-o", out], capsys, str(solution), "no division")
    assert not out.exists()


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"reasons": np.zeros((3, 2), np.uint8)}, "another surface"),
        ({"reasons": np.full((30, 2), 9, np.uint8)}, "unknown code 9"),
        ({"branches": np.array([{}])}, "is not a side file"),
    ],
    ids=["shape", "code", "pickle"],
)
def test_side_files(change: Document, text: str, tmp_path: Path, capsys: Capture) -> None:
    path, _ = side_file(tmp_path, change)
    refused([path, "--view", "reasons", "-o", tmp_path / "x.png"], capsys, "side.npz", text)


def test_side_file_that_is_none(tmp_path: Path, capsys: Capture) -> None:
    path, _ = side_file(tmp_path)
    arguments = [path, "--view", "reasons", "-o", tmp_path / "x.png"]
    refused([*arguments, "--branch", "middle arm"], capsys, "branch", "'left arm'")
    (tmp_path / "side.npz").write_text("nothing")
    refused(arguments, capsys, "side.npz", "is not a side file")
    (tmp_path / "side.npz").unlink()
    refused(arguments, capsys, "side.npz", "No such file")


@pytest.mark.parametrize(
    "arguments",
    [["a.json"], ["-o", "x.png"], ["a.json", "b.json", "c.json", "-o", "x.png"]],
    ids=" ".join,
)
def test_usage(arguments: list[object], capsys: Capture) -> None:
    refused(arguments, capsys, "cellcolor show: ")


def test_options_that_do_not_go_together(tmp_path: Path, capsys: Capture) -> None:
    path, out = saved(DRAWN, tmp_path), tmp_path / "x.png"
    refused([path, path, "--view", "graph", "-o", out], capsys, "solution: the picture graph does")
    refused([path, "--vertex", 1, "-o", out], capsys, "branch: the picture arm needs it")
    refused([path, "--branch", 0, "-o", out], capsys, "branch: the picture cells does not take it")


@pytest.mark.parametrize("options", [["x.svg"], ["x.html", "--view", "graph"]], ids=str)
def test_library_not_installed(
    options: list[str], tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A page with a surface needs none."""
    path = saved(DRAWN, tmp_path)
    for module in [name for name in sys.modules if name.partition(".")[0] == "matplotlib"]:
        monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.delitem(sys.modules, "cellcolor.pictures.static", raising=False)
    monkeypatch.delattr(sys.modules["cellcolor.pictures"], "static", raising=False)
    arguments: list[object] = [path, "-o", tmp_path / options[0], *options[1:]]
    refused(arguments, capsys, "matplotlib", "pip install 'fewest-lift-offs[viz]'")
    assert list(tmp_path.iterdir()) == [path]
    assert main(["show", str(path), "-o", str(tmp_path / "y.html")]) == 0
