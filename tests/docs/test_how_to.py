"""The guides for adding something, followed to the letter in a copy of the package."""

from __future__ import annotations

import json
import shlex
import shutil
import sys
import tomllib
from importlib.metadata import entry_points
from pathlib import Path

import pytest
from guides import ROOT, Block, blocks, follow, install, run

from cellcolor.data.surface import LabelledSurface

pytestmark = pytest.mark.second


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """The package and its instances, where a guide may change them."""
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "cellcolor", tmp_path / "cellcolor", ignore=ignored)
    (tmp_path / "instances").symlink_to(ROOT / "instances")
    return tmp_path


def commands(found: list[Block]) -> list[list[str]]:
    """The lines for the shell."""
    lines = [block.text.splitlines() for block in found if block.language == "sh"]
    return [shlex.split(line) for several in lines for line in several]


@pytest.mark.slow
def test_a_solver(tmp_path: Path) -> None:
    """In a package of its own; ``pip install .`` leaves its module and entry points on the path."""
    solver, project, *_ = found = blocks("add-a-solver")
    source, site = tmp_path / "source", tmp_path / "site"
    source.mkdir()
    follow(solver, source)
    follow(project, source)
    pip, solve, race = commands(found)
    assert pip == ["pip", "install", "."]
    declared = tomllib.loads((source / "pyproject.toml").read_text("utf-8"))["project"]
    (module,) = source.glob("*.py")
    for group, entries in declared["entry-points"].items():
        install(site, declared["name"], group, entries, **{module.stem: module.read_text("utf-8")})

    # The seam of the hole, and the bound with its verified certificate, pass the checker.
    for limit in ([], ["--time-limit", "0.001"]):
        done = run([*solve, "--json", *limit], ROOT, site)
        assert done.returncode == 3, done.stderr  # a division; cutting a cell saves a segment
        found = json.loads(done.stdout)
        assert (found["solver"], found["status"], len(found["seams"])) == ("random", "feasible", 1)
        (bound,) = found["bounds"]
        assert (bound["kind"], len(bound["certificate"]["cells"])) == ("strangers", bound["value"])
        assert bound["value"] < found["segments"]
    refused = run([*solve, "--search-space", "surface"], ROOT, site)
    assert refused.returncode == 2 and "the solver random searches paper" in refused.stderr

    raced = run(race, ROOT, site)
    assert raced.returncode == 0, raced.stderr
    # Two cells that share no color, and every cell whole in two segments: both prove the minimum.
    table = [
        "| Minima proved, of runs | dfs | random |",
        "|---|--:|--:|",
        "| paper | 1/1 | 1/1 |",
    ]
    assert "\n".join(table) in raced.stdout


def test_a_picture(clone: Path) -> None:
    picture, line, *_ = found = blocks("extend", "A picture")
    follow(picture, clone)
    (show,) = commands(found)
    before = run(show, clone, clone)
    assert before.returncode == 2 and "'histogram' is not one of" in before.stderr
    follow(line, clone)
    done = run(show, clone, clone)
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    surface = LabelledSurface.read(ROOT / "instances" / "paper" / "ring.surface.json")
    sizes = {len(colors) for colors in surface.vertex_colors}
    drawn = (clone / show[-1]).read_text("utf-8")
    bars = drawn.partition('id="nodes"')[2].partition("</g>")[0]
    assert bars.count("<path") == len(sizes)
    for size in sizes:
        count = sum(len(colors) == size for colors in surface.vertex_colors)
        assert f"{size}: {count}" in drawn


def test_a_bound(clone: Path) -> None:
    *pieces, example, printed = blocks("extend", "A bound")
    for block in pieces:
        follow(block, clone)
    done = run([sys.executable, "-c", example.text], clone, clone)
    assert (done.returncode, done.stdout) == (0, printed.text), done.stderr


@pytest.mark.slow
def test_another_planner(tmp_path: Path) -> None:
    """It fails as the guide says, and passes once it is mended."""
    first, test, _, failure, second, joints, printed = found = blocks("test-a-planner", "Python")
    ((pytest_command, *options),) = commands(found)
    assert pytest_command == "pytest"
    plugin = (
        []
        if entry_points(group="pytest11", name="cellcolor")
        else ["-p", "cellcolor.testing.plugin"]
    )
    command = [sys.executable, "-m", "pytest", *plugin, *options]
    follow(first, tmp_path)
    follow(test, tmp_path)
    done = run(command, tmp_path, tmp_path)
    assert done.returncode == 1 and failure.text.strip() in done.stdout, done.stdout
    follow(second, tmp_path)
    # What the guide says of another surface, in the same run.
    pipe = test.text.replace("hemisphere_flat", "half_pipe")
    (tmp_path / "test_pipe.py").write_text(pipe, encoding="utf-8")
    done = run([*command, "test_pipe.py"], tmp_path, tmp_path)
    assert "1 failed, 1 passed" in done.stdout, done.stdout
    assert "FAILED test_pipe.py" in done.stdout
    assert "3 fewer are proved to be enough" in done.stdout
    done = run([sys.executable, "-c", joints.text], tmp_path, tmp_path)
    assert (done.returncode, done.stdout) == (0, printed.text), done.stderr
