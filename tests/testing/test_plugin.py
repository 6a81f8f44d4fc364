"""The pytest plugin, in runs of pytest of its own."""

from __future__ import annotations

import gc
import importlib
import json
import multiprocessing
import os
import re
import subprocess
import sys
from importlib.metadata import entry_points
from pathlib import Path
from xml.etree import ElementTree

import pytest
from meshes import drawn
from pages import page_data

import cellcolor
from cellcolor.data.surface import LabelledSurface

pytestmark = pytest.mark.second

RED, BLUE = 0, 1
ROW = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})
# An installation from before there was the entry point does not load the plugin by itself.
LOADED = (
    [] if entry_points(group="pytest11", name="cellcolor") else ["-p", "cellcolor.testing.plugin"]
)


@pytest.fixture(scope="module", autouse=True)
def loaded() -> None:
    """What the runs need is imported once: they are forked, and start with all of it."""
    cellcolor.Oracle(ROW).judge([0] * 18)
    importlib.import_module("cellcolor.pictures.viewer.page")


def written(
    folder: Path, tests: str, options: tuple[str, ...], surface: LabelledSurface
) -> list[str]:
    """The tests in a folder that has ``row.surface.json``, and the arguments to run them with."""
    (folder / "row.surface.json").write_text(surface.to_json())
    (folder / "test_planner.py").write_text(tests)
    return [*LOADED, "-q", "-p", "no:xdist", *options]


def run(folder: Path, tests: str, *options: str, surface: LabelledSurface = ROW) -> str:
    """What pytest says of some tests, run in a fork of this process."""
    said = folder / "said.txt"
    arguments = written(folder, tests, options, surface)
    child = multiprocessing.get_context("fork").Process(target=_run, args=(said, arguments))
    child.start()
    child.join()
    return said.read_text()


def _run(said: Path, arguments: list[str]) -> None:
    os.chdir(said.parent)
    sys.path.insert(0, str(said.parent))
    with said.open("w") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
        sys.stdout = sys.stderr = file
        gc.freeze()  # at its end pytest collects twice: not all that this process has as well
        pytest.main(arguments)


def test_a_plan_that_can_be_beaten_fails_with_the_place_and_a_picture(tmp_path: Path) -> None:
    out = run(
        tmp_path,
        "def test_mine(cellcolor_oracle):\n"
        "    row = cellcolor_oracle('row.surface.json')\n"
        "    row.assert_optimal([0, 0, 1, 1, 0, 0] * 3)\n",
    )
    assert "1 failed" in out
    assert "can be beaten: 3 segments, 2 lift-offs, 2 fewer are proved to be enough" in out
    for word in ("picture", "better"):
        picture = re.search(rf"{word}: (.*\.html)", out)
        assert picture
        (mode,) = page_data(Path(picture[1]).read_text())["modes"]
        marks = {text["text"] for text in mode["texts"] if text["kind"] == "mark"}
        # Of two of the plan's three segments, which are two columns wide each.
        segments = [int(mark.removeprefix("vertex ")) % 6 // 2 for mark in marks]
        assert len(segments) == len(set(segments)) == 2
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
    reason = "color 1 does not reach this vertex"
    # The lines of the failure; pytest's summary repeats the first one where CI is set.
    said = [line for line in out.splitlines() if line.startswith("E  ")]
    # The first is in the verdict's own words, and is not said twice.
    assert said[0].endswith(f"not valid: vertex_colors[0]: {reason} (and 11 other problems)")
    assert sum("vertex_colors[0]: " in line for line in said) == 1
    assert said[1] == f"E       vertex_colors[1]: {reason}"
    assert sum("vertex_colors[" in line for line in said) == 3


def test_what_hypothesis_tries_is_not_drawn_but_what_it_ends_with(tmp_path: Path) -> None:
    """Every plan that is tried fails; the two pictures are those of the last one."""
    out = run(
        tmp_path,
        "from hypothesis import given, settings, strategies as st\n"
        "import cellcolor\n"
        "from cellcolor.testing import surface_under_test as module\n"
        "drawn = []\n"
        "show = module.show\n"
        "module.show = lambda *a, **b: drawn.append(0) or show(*a, **b)\n"
        "@settings(max_examples=20, database=None, deadline=None)\n"
        "@given(st.integers(0, 9))\n"
        "def test_mine(cellcolor_oracle, number):\n"
        "    cellcolor_oracle('row.surface.json').assert_optimal([0, 0, 1, 1, 0, 0] * 3)\n"
        "def test_count():\n"
        "    assert len(drawn) == 1\n",
    )
    assert "1 failed, 1 passed" in out and "number=0" in out
    assert "picture: " in out and "better: " in out


def test_a_verdict_asserted_by_hand_and_what_cannot_be_used(tmp_path: Path) -> None:
    """pytest prints the verdict's words; what cannot be used is a line below the test's own."""
    out = run(
        tmp_path,
        "def test_by_hand(cellcolor_oracle):\n"
        "    verdict = cellcolor_oracle('row.surface.json').judge([0, 0, 1, 1, 0, 0] * 3)\n"
        "    assert verdict.optimal, verdict\n"
        "def test_fractions(cellcolor_oracle):\n"
        "    cellcolor_oracle('row.surface.json').assert_valid([0.5] * 18)\n"
        "def test_no_file(cellcolor_oracle):\n"
        "    cellcolor_oracle('none.surface.json')\n"
        "def test_solution(cellcolor_oracle):\n"
        "    import cellcolor\n"
        "    row = cellcolor_oracle('row.surface.json')\n"
        "    row.assert_valid(cellcolor.solve('annulus.json'))\n",
    )
    assert "4 failed" in out
    assert "AssertionError: <Verdict: 3 segments, 2 lift-offs, 2 fewer are proved to be" in out
    assert "E       cellcolor.errors.InputError: vertex_colors[0]: Input should be a valid" in out
    assert "InputError: none.surface.json: No such file or directory\n" in out
    assert "no picture: a solution was judged" in out
    assert "/cellcolor/" not in out.replace("/d/cellcolor/", "")  # no way through its own code


def test_a_scene_that_there_is_no_time_to_build(tmp_path: Path) -> None:
    tests = "def test_mine(cellcolor_oracle):\n    cellcolor_oracle('wok')\n"
    out = run(tmp_path, tests, "--cellcolor-time-limit", "0.001")
    assert "the scene was not built in 0.001 s (--cellcolor-time-limit)" in out


def test_the_second_run_proves_nothing_again(tmp_path: Path) -> None:
    """Twenty plans, every other one of which can be beaten: proving fails in the second run."""
    tests = (
        "import pytest\n"
        "@pytest.mark.parametrize('number', range(20))\n"
        "def test_mine(cellcolor_oracle, number, monkeypatch):\n"
        "    {}\n"
        "    row = cellcolor_oracle('row.surface.json')\n"
        "    if number % 2:\n"
        f"        assert {joined_in_the_row()!r} in str(row.judge([0, 0, 1, 1, 0, 0] * 3))\n"
        "    else:\n"
        "        row.assert_optimal([0] * 18)\n"
    )
    assert "20 passed" in run(tmp_path, tests.format("pass"))
    (kept,) = (tmp_path / ".pytest_cache" / "d" / "cellcolor").glob("*.json")
    document = json.loads(kept.read_text())
    assert document["seconds"] == 60.0
    broken = tests.format("monkeypatch.setattr('cellcolor.door.oracle.prove', None)")
    assert "20 passed" in run(tmp_path, broken)
    # A solution that is none of this surface is not believed.
    document["solutions"][0]["segments"] = 0
    kept.write_text(json.dumps(document))
    assert "20 failed" in run(tmp_path, broken)


def joined_in_the_row() -> str:
    """Which segments the oracle itself says can be joined."""
    improvement = cellcolor.Oracle(ROW).judge([0, 0, 1, 1, 0, 0] * 3).improvement
    assert improvement is not None
    return "segments {} and {}".format(*improvement.joined)


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
    unproved = tests.replace(
        "(cellcolor_oracle):\n",
        "(cellcolor_oracle, monkeypatch):\n"
        "    monkeypatch.setattr('cellcolor.door.oracle.prove', None)\n",
    )
    # Less time than a new proof would have; what is kept is checked within it.
    assert "1 passed" in run(tmp_path, unproved, "--cellcolor-time-limit", "20", surface=two)


def test_nothing_is_imported_before_a_test_asks(tmp_path: Path) -> None:
    """In a process of its own."""
    tests = (
        "import sys\n"
        "def test_mine():\n"
        "    heavy = [m for m in sys.modules if m.startswith(('cellcolor', 'numpy', 'ortools'))]\n"
        "    assert set(heavy) <= {'cellcolor', 'cellcolor.version', 'cellcolor.testing',\n"
        "                          'cellcolor.testing.plugin'}, heavy\n"
    )
    command = [sys.executable, "-m", "pytest", *written(tmp_path, tests, (), ROW)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert "1 passed" in done.stdout


def test_without_a_cache_there_is_no_picture(tmp_path: Path) -> None:
    out = run(
        tmp_path,
        "def test_mine(cellcolor_oracle):\n"
        "    cellcolor_oracle('row.surface.json').assert_optimal([0, 0, 1, 1, 0, 0] * 3)\n",
        "-p",
        "no:cacheprovider",
    )
    assert (
        "1 failed" in out
        and "no picture: pytest's cache is switched off (--cellcolor-cache DIR keeps it)" in out
    )


def test_verdicts_are_properties_of_tests_that_are_marked(tmp_path: Path) -> None:
    """Several workers share a cache of the caller's; a property test has its last verdict."""
    (tmp_path / "row.surface.json").write_text(ROW.to_json())
    (tmp_path / "test_planner.py").write_text(
        "from hypothesis import given, settings, strategies as st\n"
        "@settings(max_examples=5, database=None, deadline=None)\n"
        "@given(st.integers(0, 9))\n"
        "def test_mine(cellcolor_oracle, number):\n"
        "    cellcolor_oracle('row.surface.json').assert_optimal([0] * 18)\n"
        "def test_yours(cellcolor_oracle):\n"
        "    cellcolor_oracle('row.surface.json').judge([0, 0, 1, 1, 0, 0] * 3)\n"
        "def test_other():\n"
        "    assert False\n"
    )
    options = ["-n", "2", "-m", "cellcolor", "--junit-xml", "report.xml", "--cellcolor-cache"]
    command = [sys.executable, "-m", "pytest", *LOADED, "-q", "-p", "no:cacheprovider", *options]
    done = subprocess.run(
        [*command, "proofs"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert "2 passed" in done.stdout, done.stdout
    cases = ElementTree.parse(tmp_path / "report.xml").getroot().iter("testcase")
    said = {
        case.get("name"): [(own.get("name"), own.get("value")) for own in case.iter("property")]
        for case in cases
    }
    name = f"cellcolor: {ROW.name}"
    assert [own for own, _ in said["test_mine"]] == [name]
    assert "optimal" in str(said["test_mine"][0][1])
    assert "2 fewer are proved to be enough" in str(said["test_yours"][0][1])
    assert list((tmp_path / "proofs").glob("*.json"))


def test_a_surface_that_fails_is_printed_with_its_import(tmp_path: Path) -> None:
    """What is printed can be pasted: it makes the surface that failed."""
    out = run(
        tmp_path,
        "from hypothesis import given, settings\n"
        "from cellcolor.testing.strategies import labelled_surfaces\n"
        "@settings(database=None, deadline=None)\n"
        "@given(labelled_surfaces())\n"
        "def test_mine(surface):\n"
        "    assert len(surface.colors) < 2\n",
    )
    assert "from cellcolor.testing.strategies import sheet" in out
    assert "surface=sheet(" in out
