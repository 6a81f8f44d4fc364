"""The pytest plugin, in runs of pytest of its own."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path

from meshes import drawn

from cellcolor.data.surface import LabelledSurface

RED, BLUE = 0, 1
ROW = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})
# An installation from before there was the entry point does not load the plugin by itself.
LOADED = (
    [] if entry_points(group="pytest11", name="cellcolor") else ["-p", "cellcolor.testing.plugin"]
)


def run(folder: Path, tests: str, *options: str, surface: LabelledSurface = ROW) -> str:
    """What pytest says of some tests in a folder that has ``row.surface.json``."""
    (folder / "row.surface.json").write_text(surface.to_json())
    (folder / "test_planner.py").write_text(tests)
    command = [sys.executable, "-m", "pytest", *LOADED, "-q", "-p", "no:xdist", *options]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False).stdout


def test_a_plan_that_can_be_beaten_fails_with_the_place_and_a_picture(tmp_path: Path) -> None:
    out = run(
        tmp_path,
        "def test_mine(cellcolor_oracle):\n"
        "    row = cellcolor_oracle('row.surface.json')\n"
        "    row.assert_optimal([0, 0, 1, 1, 0, 0] * 3)\n",
    )
    assert "1 failed" in out
    assert "can be beaten: 3 segments, 2 lift-offs, 2 fewer are proved to be enough" in out
    picture = re.search(r"picture: (.*\.png)", out)
    assert picture and Path(picture[1]).read_bytes().startswith(b"\x89PNG")
    # The lines of cellcolor's own functions are left out: the test's line is the last one.
    assert "surface_under_test.py" not in out


def test_optimal_valid_and_invalid_plans(tmp_path: Path) -> None:
    out = run(
        tmp_path,
        "def test_best(cellcolor_oracle):\n"
        "    assert cellcolor_oracle('row.surface.json').assert_optimal([0] * 18).lift_offs == 0\n"
        "def test_worse(cellcolor_oracle):\n"
        "    cellcolor_oracle('row.surface.json').assert_valid([0, 0, 1, 1, 0, 0] * 3)\n"
        "def test_wrong(cellcolor_oracle):\n"
        "    cellcolor_oracle('row.surface.json').assert_valid([1] * 18)\n",
    )
    assert "1 failed, 2 passed" in out
    assert "is not valid" in out and "vertex_colors[0]: color 1 does not reach this vertex" in out


def test_the_second_run_proves_nothing_again(tmp_path: Path) -> None:
    """Twenty plans, of which none is proved in the second run: proving would fail there."""
    tests = (
        "import pytest\n"
        "@pytest.mark.parametrize('number', range(20))\n"
        "def test_mine(cellcolor_oracle, number, monkeypatch):\n"
        "    {}\n"
        "    cellcolor_oracle('row.surface.json').assert_optimal([0] * 18)\n"
    )
    assert "20 passed" in run(tmp_path, tests.format("pass"))
    (kept,) = (tmp_path / ".pytest_cache" / "d" / "cellcolor").glob("*.json")
    assert json.loads(kept.read_text()) == {"lower": 1, "upper": 1, "seconds": 60.0}
    broken = tests.format("monkeypatch.setattr('cellcolor.door.oracle.prove', None)")
    assert "20 passed" in run(tmp_path, broken)
    assert "20 failed" in run(tmp_path, broken, "--cache-clear")


def test_the_time_limit_is_an_option(tmp_path: Path) -> None:
    """A range that the limit left open is kept, and proved anew once there is more time."""
    two = drawn("ABCBA ABCBA", {"A": [0], "B": [0, 1], "C": [1]})
    tests = (
        "def test_mine(cellcolor_oracle):\n"
        "    row = cellcolor_oracle('row.surface.json')\n"
        "    assert row.bounds.exact\n"
    )
    short = ("--cellcolor-time-limit", "1e-9")
    assert "1 failed" in run(tmp_path, tests, *short, surface=two)
    assert "1 failed" in run(tmp_path, tests, *short, surface=two)
    assert "1 passed" in run(tmp_path, tests, surface=two)
    assert "1 passed" in run(tmp_path, tests, *short, surface=two)


def test_nothing_is_imported_before_a_test_asks(tmp_path: Path) -> None:
    out = run(
        tmp_path,
        "import sys\n"
        "def test_mine():\n"
        "    heavy = [m for m in sys.modules if m.startswith(('cellcolor', 'numpy', 'ortools'))]\n"
        "    assert set(heavy) <= {'cellcolor', 'cellcolor.version', 'cellcolor.testing',\n"
        "                          'cellcolor.testing.plugin'}, heavy\n",
    )
    assert "1 passed" in out


def test_without_a_cache_there_is_no_picture(tmp_path: Path) -> None:
    out = run(
        tmp_path,
        "def test_mine(cellcolor_oracle):\n"
        "    cellcolor_oracle('row.surface.json').assert_optimal([0, 0, 1, 1, 0, 0] * 3)\n",
        "-p",
        "no:cacheprovider",
    )
    assert "1 failed" in out and "no picture: there is no folder for it" in out
