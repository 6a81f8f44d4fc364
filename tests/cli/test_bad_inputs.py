"""Broken inputs through the real command line: one clear line, exit code 2, nothing written."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest
from documents import INSTANCE, PLAN, SOLUTION, SURFACE, Change, Document, broken, put
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


def not_planar() -> Bad:
    points, faces = torus()
    return Bad(surface(points, faces, [[0]] * len(points)).to_json(), "vertices[0]", "not planar")


GRAPHS = {
    "truncated instance": Bad(json.dumps(INSTANCE)[:-40], "not JSON"),
    "not UTF-8": Bad("\udcff", "not UTF-8"),
    "neither instance nor surface": Bad(json.dumps(PLAN), "format", "cellcolor/plan"),
    "misspelt member": document(
        INSTANCE,
        put("cells", 0, to={"id": 0, "colors": [0], "loop": [[1, 2]]}),
        "cells[0].loop",
        "unknown key; is 'loops' meant?",
    ),
    "a mesh": Bad("solid part\nendsolid part\n", "is a mesh, which has no colors", "", "bad.stl"),
    "loop that does not close": document(
        INSTANCE, put("cells", 0, "loops", to=[[1]]), "edges[1]", "do not close"
    ),
    "infinite area": document(INSTANCE, put("cells", 0, "area", to=float("inf")), "cells[0].area"),
    "inverted face": document(
        SURFACE, put("faces", 1, to=[0, 3, 2]), "faces[1]", "winds the other way"
    ),
    "cell that is not planar": not_planar(),
}
"""One for each way to fail; all that the formats refuse is in tests/data/test_formats.py."""


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
    "solution with an objective, as an older version wrote it": (
        PAPER / "ring.json",
        Bad(json.dumps(SOLUTION | {"objective": {"segments": {"red": 3}}}), "objective"),
    ),
    "plan for an instance": (PAPER / "ring.json", Bad(json.dumps(PLAN), "format")),
    "plan with a color as text": (
        PAPER / "ring.surface.json",
        document(PLAN, put("vertex_colors", 0, to="red"), "vertex_colors[0]"),
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
    "share that is not a number": ["solve", RING, "--cover", "nan"],
    "no workers": ["solve", RING, "--workers", "0"],
    "negative seed": ["solve", RING, "--seed", "-1"],
    "build without output": ["build", str(PAPER / "ring.surface.json")],
    "check of one file": ["check", RING],
    "paint without output": ["paint", RING, RING],
    "check of three files": ["check", RING, RING, RING],
    "bench of nothing": ["bench"],
}


@pytest.mark.parametrize("arguments", USAGE.values(), ids=USAGE.keys())
def test_bad_usage(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert refused(arguments, capsys, "cellcolor") == ""


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
