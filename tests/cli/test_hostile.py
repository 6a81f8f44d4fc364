"""Files and streams made to do harm: one line each, the right exit code, nothing half-written."""

from __future__ import annotations

import json
import os
import struct
import subprocess
import sys
from pathlib import Path

import pytest
from commands import run
from documents import INSTANCE, SURFACE
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER

from cellcolor.cli.terminal import shown

pytestmark = pytest.mark.slow

RING = PAPER / "ring.json"
SCENE = (INSTANCES / "scenes" / "wok.toml").read_text(encoding="utf-8")
Capture = pytest.CaptureFixture[str]


def line_about(path: Path, arguments: list[object], capsys: Capture) -> str:
    """Run what has to be refused; returns its one line."""
    capsys.readouterr()
    assert run(*arguments) == 2
    out, err = capsys.readouterr()
    (line,) = err.splitlines()
    assert str(path) in line and out == "" and len(line) < 1500
    assert line.isprintable()
    return line


def with_number(digits: int) -> str:
    return json.dumps(INSTANCE).replace("0.5", "9" * digits)


def nested(depth: int, pair: str = "[]") -> str:
    return pair[0] * depth + pair[1] * depth


TEXTS = {
    "5,000 digits": (with_number(5000), "too many digits"),
    "400 digits, beyond doubles": (with_number(400), "cells[0].area"),
    "unknown color of 4,000 digits": (
        json.dumps(INSTANCE).replace('"colors": [0]', f'"colors": [{"9" * 4000}]'),
        "cells[0].colors",
    ),
    "nested far too deeply": (nested(100_000), "nested too deeply"),
    "nested too deeply for the validation": (
        json.dumps(INSTANCE).replace('"by hand"', nested(500)),
        "recursion limit",
    ),
    "a member's name": ('{"\\u001b[31m": 1, "\\u001b[31m": 2}', r"\x1b[31m"),
}
TOMLS = {
    "5,000 digits": (SCENE.replace("seed = 1", f"seed = {'9' * 5000}"), "too many digits"),
    "nested": (f"a = {nested(5000)}", "nested too deeply"),
    "nested tables": ("a = " + "{a=" * 5000 + "1" + "}" * 5000, "nested too deeply"),
    # tomllib would take 20 GB for this.
    "a long key": (".".join("a" * 50_000) + " = 1", "more than 50 parts"),
    "a long quoted key": (" . ".join(['"a b"'] * 60) + " = 1", "more than 50 parts"),
    "a control character in a key": (f'"\\u009b31m" = 1\n{SCENE}', r"\x9b31m"),
    "a name with a zero": (SCENE.replace("../../models", "\\u0000"), "not a file name"),
    "a long name": (SCENE.replace("../../models", "m" * 300), "name too long"),
    "beyond the moon": (SCENE.replace("[0.465", "[1e300"), "placement.position_m[0]"),
    "smaller than dust": (SCENE.replace("radius_m = 0.20", "radius_m = 1e-300"), "radius_m"),
}


@pytest.mark.parametrize(("text", "message"), TEXTS.values(), ids=TEXTS.keys())
def test_json(text: str, message: str, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "x.json"
    path.write_text(text, encoding="utf-8")
    for command in (["solve", path], ["build", path, "-o", tmp_path / "y.json"]):
        assert message in line_about(path, command, capsys)
    line_about(path, ["check", RING, path], capsys)
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(("text", "message"), TOMLS.values(), ids=TOMLS.keys())
def test_toml(text: str, message: str, tmp_path: Path, capsys: Capture) -> None:
    path = tmp_path / "x.toml"
    path.write_text(text.replace("../../models", str(INSTANCES.parent / "models")), "utf-8")
    named = tmp_path if "name" in message else path
    assert message in line_about(named, ["solve", path], capsys)
    assert message in line_about(named, ["build", path, "-o", tmp_path / "y.json"], capsys)


def stl(faces: int, announced: int) -> bytes:
    corners = (0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0)
    return bytes(80) + struct.pack("<I", announced) + struct.pack("<12fH", *corners, 0) * faces


PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element {}
property list int int vertex_indices
end_header
0 0 0
1 0 0
0 1 0
3 0 1 {}
"""
MESHES = {
    "cut.stl": (stl(5, 5)[:-30], "cut off, or no STL: for 5 faces it needs 334 bytes, it has 304"),
    "header.stl": (bytes(80), "cut off, or no STL"),
    "more.stl": (stl(3, 2), "cut off, or no STL"),
    "latin.stl": (b"solid St\xfcck\nendsolid\n", "UTF-8"),
    "strips.ply": (PLY.format("tristrips 1", 2).encode(), "triangle strips"),
    "far.ply": (PLY.format("face 1", 2).replace("0 1 0", "0 1e9 0").encode(), "meters_per_unit"),
    "last.ply": (PLY.format("face 1", -1).encode(), "faces[0][2]: there is no vertex -1"),
}


@pytest.mark.parametrize("repair", [False, True])
@pytest.mark.parametrize("name", MESHES)
def test_meshes(name: str, repair: bool, tmp_path: Path, capsys: Capture) -> None:
    content, message = MESHES[name]
    (tmp_path / name).write_bytes(content)
    models = str(INSTANCES.parent / "models")
    head, _, rest = SCENE.replace("../../models", models).partition("[object]")
    wanted = (
        f'kind = "mesh"\nfile = "{name}"\nmeters_per_unit = 1.0\nrepair = {str(repair).lower()}'
    )
    placement = rest.partition("[placement]")[2]
    path = tmp_path / "x.toml"
    path.write_text(f"{head}[object]\n{wanted}\n[placement]{placement}", encoding="utf-8")
    line = line_about(tmp_path / name, ["solve", path], capsys)
    assert message in line and "charset_normalizer" not in line


class TestControlCharacters:
    NAMES = "\x1b[31mred\x1b]0;title\x07 \x9b2J \u202edetrevni \u2028line\x7f"

    def files(self, folder: Path) -> tuple[Path, Path]:
        text = json.dumps(SURFACE | {"name": self.NAMES, "colors": [self.NAMES, "blue"]})
        surface = folder / f"{self.NAMES.replace('/', '')}.json"
        surface.write_text(text, encoding="utf-8")
        return surface, folder / "i.json"

    def test_escaped(self, tmp_path: Path, capsys: Capture) -> None:
        surface, instance = self.files(tmp_path)
        solution = tmp_path / "\x1b[2J.json"
        assert run("build", surface, "-o", instance) == 0
        assert run("solve", instance, surface) == 0
        assert run("solve", instance, "-o", solution) == 0
        assert run("check", instance, solution) == 0
        assert run("bench", "run", surface) == 0
        assert run("solve", surface, surface.with_suffix(".none"), "--json") == 2
        out, err = capsys.readouterr()
        assert all(c.isprintable() or c == "\n" for c in out + err)
        assert r"\x1b[31mred" in out
        documents = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
        assert documents[0]["instance"]["name"] == self.NAMES

    @given(st.text())
    def test_what_is_shown_is_printable(self, text: str) -> None:
        """Apart from spaces of other kinds and what this Python does not know yet."""
        plain = shown(text)
        assert plain.isascii() or not set(plain) & set(map(chr, [*range(32), *range(127, 160)]))
        assert not any(0xD800 <= ord(c) < 0xE000 or c in "\u202e\u2028\u2066" for c in plain)
        if text.isprintable():
            assert plain == text


class TestStandardOutput:
    COMMANDS = (
        ["solve", str(RING)],
        ["solve", str(RING), "--json"],
        ["check", str(RING), "{}/s.json"],
        ["build", str(PAPER / "ring.surface.json"), "-o", "{}/i.json"],
        ["--help"],
    )

    def command(self, arguments: list[str], folder: Path) -> list[str]:
        if "check" in arguments:
            assert run("solve", RING, "-o", folder / "s.json") == 0
        return [sys.executable, "-m", "cellcolor", *(a.format(folder) for a in arguments)]

    @pytest.mark.parametrize("full", [False, True])
    @pytest.mark.parametrize("arguments", COMMANDS, ids=" ".join)
    def test_nowhere_to_write(self, arguments: list[str], full: bool, tmp_path: Path) -> None:
        """A full device, or a reader that is gone; ``--help`` may end well without a reader."""
        reading, writing = os.pipe()
        os.close(reading)
        sink = os.open("/dev/full", os.O_WRONLY) if full else writing
        command = self.command(arguments, tmp_path)
        done = subprocess.run(command, stdout=sink, stderr=subprocess.PIPE, text=True)
        said = "No space left on device" if full else "Broken pipe"
        if full or "--help" not in arguments:
            assert done.returncode == 2
            assert done.stderr == f"cellcolor: standard output: {said}\n"
        assert (tmp_path / "i.json").exists() == ("build" in arguments)

    def test_closed(self, tmp_path: Path) -> None:
        """The next file that is opened must not become standard output."""
        command = self.command(
            ["build", str(PAPER / "ring.surface.json"), "-o", "{}/i.json"], tmp_path
        )
        done = subprocess.run(
            ["sh", "-c", 'exec "$@" >&-', "sh", *command], stderr=subprocess.PIPE, text=True
        )
        assert (done.returncode, done.stderr) == (2, "cellcolor: standard output: is closed\n")
        assert run("check", tmp_path / "i.json", tmp_path / "i.json") == 2  # it can be read
        assert (
            json.loads((tmp_path / "i.json").read_text("utf-8"))["format"] == "cellcolor/instance"
        )

    def test_letters_that_an_encoding_does_not_have(self, tmp_path: Path) -> None:
        path = tmp_path / "x.json"
        path.write_text(json.dumps(INSTANCE | {"colors": ["rot", "grün"]}), encoding="utf-8")
        command = [sys.executable, "-m", "cellcolor", "solve", str(path)]
        environment = os.environ | {"PYTHONIOENCODING": "ascii"}
        done = subprocess.run(command, capture_output=True, text=True, env=environment)
        assert (done.returncode, done.stderr) == (0, "")
