"""Broken inputs through the real command line: one clear line, exit code 2, nothing written."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from documents import INSTANCE, PLAN, SOLUTION, SURFACE, Change, Document, broken, drop, put
from library import INSTANCES, PAPER
from meshes import surface, torus

from cellcolor.cli import main

SCENE = (INSTANCES / "scenes" / "wok.toml").read_text(encoding="utf-8")


@dataclass(frozen=True)
class Bad:
    """A file that cannot be used, and what the line about it has to name."""

    text: str
    field: str
    message: str = ""
    name: str = "bad.json"


def document(original: Document, change: Change, field: str, message: str = "") -> Bad:
    text = json.dumps(broken(original, change))
    # JSON has no names for NaN and infinities; a number too large for a double becomes one.
    return Bad(text.replace("Infinity", "1e999"), field, message)


def surface_of(change: Callable[[Document], Any], field: str, message: str = "") -> Bad:
    return document(SURFACE, change, field, message)


def instance_of(change: Callable[[Document], Any], field: str, message: str = "") -> Bad:
    return document(INSTANCE, change, field, message)


def not_planar() -> Bad:
    points, faces = torus()
    return Bad(surface(points, faces, [[0]] * len(points)).to_json(), "vertices[0]", "not planar")


GRAPHS = {
    "empty file": Bad("", "not JSON"),
    "truncated instance": Bad(json.dumps(INSTANCE)[:-40], "not JSON"),
    "truncated surface": Bad(json.dumps(SURFACE)[:200], "not JSON"),
    "a list": Bad("[1, 2]", "must be a JSON object"),
    "not UTF-8": Bad("\udcff", "not UTF-8"),
    "repeated member": Bad('{"format": "a", "format": "b"}', "format", "twice"),
    "NaN by name": Bad(json.dumps(INSTANCE).replace("0.5", "NaN"), "NaN"),
    "neither instance nor surface": Bad(json.dumps(PLAN), "format", "cellcolor/plan"),
    "no format": instance_of(drop("format"), "format"),
    "wrong version": instance_of(put("version", to=4), "version"),
    "unknown member": instance_of(put("color", to=[]), "color"),
    "misspelt member": instance_of(
        put("cells", 0, to={"id": 0, "colors": [0], "loop": [[1, 2]]}),
        "cells[0].loop",
        "unknown key; is 'loops' meant?",
    ),
    "a mesh": Bad("solid part\nendsolid part\n", "is a mesh, which has no colors", "", "bad.stl"),
    "edge used three times": instance_of(
        put("cells", 0, "loops", to=[[1, 2, 1]]), "cells[0].loops[0][2]", "dart 1 appears twice"
    ),
    "loop that does not close": instance_of(
        put("cells", 0, "loops", to=[[1]]), "edges[1]", "do not close"
    ),
    "dart of another cell": instance_of(
        put("cells", 0, "loops", to=[[1, 2, 3]]), "cells[0].loops[0][2]", "does not close"
    ),
    "unknown color": instance_of(put("cells", 1, "colors", to=[0, 3]), "cells[1].colors", "3"),
    "empty color set": instance_of(put("cells", 0, "colors", to=[]), "cells[0].colors"),
    "joinable color of one side": instance_of(put("edges", 0, "colors", to=[1]), "edges[0].colors"),
    "outside on both sides": instance_of(put("edges", 1, "left", to=-1), "edges[1]", "both sides"),
    "unknown cell": instance_of(put("edges", 1, "left", to=9), "edges[1].left", "9"),
    "infinite area": instance_of(put("cells", 0, "area", to=float("inf")), "cells[0].area"),
    "infinite coordinate": surface_of(
        put("vertices", 2, 1, to=float("inf")), "vertices[2][1]", "finite"
    ),
    "coordinate beyond everything": surface_of(
        put("vertices", 2, 1, to=-1e308), "vertices[2][1]", "beyond 1e+09 m"
    ),
    "edge of three faces": surface_of(
        lambda d: (
            d["vertices"].append([0, 0, 1]),
            d["vertex_colors"].append([]),
            d["faces"].append([2, 0, 4]),
        ),
        "faces[2]",
        "not manifold",
    ),
    "pinched vertex": surface_of(
        lambda d: (
            d["vertices"].extend([[-1, 0, 0], [-1, -1, 0]]),
            d["vertex_colors"].extend([[], []]),
            d["faces"].append([0, 4, 5]),
        ),
        "vertices[0]",
        "pinched",
    ),
    "inverted face": surface_of(put("faces", 1, to=[0, 3, 2]), "faces[1]", "winds the other way"),
    "collapsed face": surface_of(put("faces", 0, to=[0, 1, 1]), "faces[0]", "repeats a vertex"),
    "unknown vertex": surface_of(put("faces", 0, 1, to=44), "faces[0][1]", "44"),
    "loose vertex": surface_of(
        lambda d: (d["vertices"].append([5, 5, 5]), d["vertex_colors"].append([])),
        "vertices[4]",
        "no face",
    ),
    "unknown color of a vertex": surface_of(
        put("vertex_colors", 0, to=[2]), "vertex_colors[0]", "2"
    ),
    "colors of a vertex missing": surface_of(
        drop("vertex_colors", 0), "vertex_colors", "3 entries"
    ),
    "crack on no edge": surface_of(put("cracks", 0, to=[1, 3, [0]]), "cracks[0]", "not an edge"),
    "crack twice": surface_of(put("cracks", to=[[0, 2, [0]], [2, 0, [1]]]), "cracks[1]", "already"),
    "crack of a color not there": surface_of(put("cracks", 0, to=[0, 2, [8]]), "cracks[0]", "8"),
    "two colors of one name in a surface": surface_of(
        put("colors", to=["left", "left"]), "colors[1]", "'left' is the name of color 0"
    ),
    "two colors of one name in an instance": instance_of(
        put("colors", to=["left", "left"]), "colors[1]", "'left' is the name of color 0"
    ),
    "cell that is not planar": not_planar(),
}


def scene(old: str, new: str, field: str, message: str = "") -> Bad:
    assert old in SCENE
    return Bad(SCENE.replace(old, new), field, message, "bad.toml")


SCENES = {
    "scene: not TOML": Bad("[object", "", "", "bad.toml"),
    "scene: unknown key": scene("radius_m", "radius", "object", "radius"),
    "scene: key missing": scene('name = "wok"', "", "name"),
    "scene: wrong type": scene("radius_m = 0.20", 'radius_m = "0.20"', "radius_m"),
    "scene: infinite": scene("radius_m = 0.20", "radius_m = inf", "radius_m", "finite"),
    "scene: out of range": scene("radius_m = 0.20", "radius_m = -0.2", "radius_m", "greater"),
    "scene: missing mesh": Bad(
        SCENE.partition("[object]")[0]
        + '[object]\nkind = "mesh"\nfile = "no-such-mesh.stl"\nmeters_per_unit = 1.0\n'
        + "[placement]"
        + SCENE.partition("[placement]")[2],
        "no-such-mesh.stl",
        "",
        "bad.toml",
    ),
    "scene: missing setup": scene("ur5_polishing.toml", "no-such-robot.toml", "no-such-robot"),
}


def write(bad: Bad, folder: Path) -> Path:
    path = folder / bad.name
    # Scenes name their setup relative to themselves.
    models = (INSTANCES.parent / "models").as_posix()
    text = bad.text.replace("../../models", models) if path.suffix == ".toml" else bad.text
    path.write_text(text, encoding="utf-8", errors="surrogateescape")
    return path


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str], *named: str) -> str:
    """Run a command that must fail; returns its standard output."""
    assert main(arguments) == 2
    captured = capsys.readouterr()
    (line,) = captured.err.splitlines()
    for text in named:
        assert text in line
    assert "Traceback" not in line
    return captured.out


def test_there_are_enough() -> None:
    assert len(GRAPHS | SCENES) >= 25


@pytest.mark.parametrize("bad", GRAPHS.values(), ids=GRAPHS.keys())
@pytest.mark.parametrize("command", ["solve", "build"])
def test_broken_graph(
    command: str, bad: Bad, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(bad, tmp_path)
    arguments = [command, str(path), "-o", str(tmp_path / "out.json")]
    assert refused(arguments, capsys, str(path), bad.field, bad.message) == ""
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("bad", SCENES.values(), ids=SCENES.keys())
@pytest.mark.parametrize("command", ["solve", "build"])
def test_broken_scene(
    command: str, bad: Bad, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(bad, tmp_path)
    arguments = [command, str(path), "-o", str(tmp_path / "out.json")]
    assert refused(arguments, capsys, bad.field, bad.message) == ""
    assert list(tmp_path.iterdir()) == [path]


def test_missing_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    missing = tmp_path / "none.json"
    refused(["solve", str(missing)], capsys, str(missing), "No such file")
    refused(["solve", str(tmp_path)], capsys, str(tmp_path), "Is a directory")
    refused(["build", str(missing), "-o", str(tmp_path / "x.json")], capsys, str(missing))
    refused(["check", str(missing), str(missing)], capsys, str(missing))
    refused(["bench", "run", str(missing)], capsys, str(missing))


def test_scene_without_the_front_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the extra not installed the line says what to install."""
    for module in [name for name in sys.modules if name.startswith("cellcolor.frontend")]:
        monkeypatch.delitem(sys.modules, module)
    for package in ("pinocchio", "trimesh", "fcl"):
        monkeypatch.setitem(sys.modules, package, None)
    wok = str(INSTANCES / "scenes" / "wok.toml")
    out = str(tmp_path / "out.json")
    refused(["solve", wok], capsys, wok, "pip install 'fewest-lift-offs[frontend]'")
    refused(["build", wok, "-o", out], capsys, wok, "pip install 'fewest-lift-offs[frontend]'")
    assert list(tmp_path.iterdir()) == []


CLAIMS = {
    "solution truncated": (PAPER / "ring.json", Bad(json.dumps(SOLUTION)[:99], "not JSON")),
    "solution of another version": (
        PAPER / "ring.json",
        document(SOLUTION, put("version", to=4), "version"),
    ),
    "solution with an objective, as an older version wrote it": (
        PAPER / "ring.json",
        Bad(json.dumps(SOLUTION | {"objective": {"segments": {"red": 3}}}), "objective"),
    ),
    "solution with null segments": (
        PAPER / "ring.json",
        document(SOLUTION, put("segments", to=None), "segments"),
    ),
    "plan for an instance": (PAPER / "ring.json", Bad(json.dumps(PLAN), "format")),
    "plan with a color as text": (
        PAPER / "ring.surface.json",
        document(PLAN, put("vertex_colors", 0, to="red"), "vertex_colors[0]"),
    ),
    "plan with a member too many": (
        PAPER / "ring.surface.json",
        document(PLAN, put("name", to="mine"), "name"),
    ),
}


@pytest.mark.parametrize(("subject", "bad"), CLAIMS.values(), ids=CLAIMS.keys())
def test_broken_claim(
    subject: Path, bad: Bad, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(bad, tmp_path)
    assert refused(["check", str(subject), str(path)], capsys, str(path), bad.field) == ""


RING = str(PAPER / "ring.json")
USAGE = {
    "no command": [],
    "unknown command": ["polish"],
    "no file": ["solve"],
    "unknown option": ["solve", RING, "--fast"],
    "unknown solver": ["solve", RING, "--solver", "sat"],
    "strands in paper": ["solve", RING, "--strands", "2"],
    "limit without all": ["solve", RING, "--limit", "2"],
    "all in surface": ["solve", RING, "--all", "--search-space", "surface"],
    "no strands": ["solve", RING, "--search-space", "surface", "--strands", "0"],
    "limit of nothing": ["solve", RING, "--all", "--limit", "0"],
    "time as text": ["solve", RING, "--time-limit", "soon"],
    "no time": ["solve", RING, "--time-limit", "0"],
    "endless time": ["solve", RING, "--time-limit", "inf"],
    "time that is not a number": ["solve", RING, "--time-limit", "nan"],
    "no workers": ["solve", RING, "--workers", "0"],
    "negative seed": ["solve", RING, "--seed", "-1"],
    "warm start with dfs": ["solve", RING, "--solver", "dfs", "--warm-start", RING],
    "warm start of two": ["solve", RING, RING, "--warm-start", RING],
    "build without output": ["build", str(PAPER / "ring.surface.json")],
    "check of one file": ["check", RING],
    "paint without output": ["paint", RING, RING],
    "check of three files": ["check", RING, RING, RING],
    "bench of nothing": ["bench"],
}


@pytest.mark.parametrize("arguments", USAGE.values(), ids=USAGE.keys())
def test_bad_usage(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    command = "cellcolor" if arguments[:1] in ([], ["polish"]) else f"cellcolor {arguments[0]}"
    assert refused(arguments, capsys, f"{command}: ") == ""


def test_outputs_that_would_lose_a_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    surface_path = tmp_path / "a.json"
    text = json.dumps(SURFACE)
    surface_path.write_text(text, encoding="utf-8")
    other = tmp_path / "sub" / "a.toml"
    other.parent.mkdir()
    refused(["build", str(surface_path), "-o", str(surface_path)], capsys, "is an input")
    refused(["solve", str(surface_path), "-o", str(surface_path)], capsys, "overwritten")
    both = ["solve", str(surface_path), str(other), "-o", str(tmp_path / "out")]
    refused(both, capsys, "would both go to")
    refused([*both[:-1], str(surface_path)], capsys, str(surface_path), "must be a folder")
    missing = tmp_path / "none" / "x.json"
    refused(["solve", RING, "-o", str(missing)], capsys, str(missing), "folder does not exist")
    refused(["build", str(surface_path), "-o", str(missing)], capsys, "folder does not exist")
    refused(["build", str(surface_path), "-o", str(tmp_path)], capsys, "is a folder")
    assert surface_path.read_text(encoding="utf-8") == text
    assert sorted(tmp_path.rglob("*")) == sorted([surface_path, other.parent])
