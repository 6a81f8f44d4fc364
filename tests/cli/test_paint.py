"""``cellcolor paint``: both files, what is refused, and what the checker says of them."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from commands import json_lines, run
from library import INSTANCES, PAPER
from painted import random_solution
from shipped import ROBOTS, WOK, edited, shipped

import cellcolor


def painted(folder: Path, name: str, *options: object) -> tuple[Path, Path]:
    solution = folder / "solution.json"
    source = INSTANCES / name
    assert run("solve", source, "--search-space", "surface", "-o", solution) == 0
    output = folder / "painted.surface.json"
    assert run("paint", source, solution, "-o", output, *options) == 0
    return output, folder / "painted.plan.json"


@pytest.mark.parametrize("name", ["paper/parallel-corridors", "random/blobs_2"])
def test_the_checker_finds_the_painting_valid_and_optimal(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    surface, plan = painted(tmp_path, f"{name}.surface.json")
    said = capsys.readouterr().out
    assert f"wrote {surface}" in said and f"wrote {plan}" in said
    assert run("check", surface, plan, "--json") == 0
    verdict = json_lines(capsys.readouterr().out)[0]
    # The painted surface is solved anew: nobody is told what was proved before.
    assert verdict["valid"] and verdict["optimal"]


def test_wrong_files_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    solution = tmp_path / "solution.json"
    ring, corridors = PAPER / "ring.surface.json", PAPER / "parallel-corridors.surface.json"
    assert run("solve", ring, "-o", solution) == 0
    capsys.readouterr()
    cases = [
        ((corridors, solution, "-o", tmp_path / "x.surface.json"), "solution.json"),
        ((ring, solution, "-o", tmp_path / "x.json"), "x.json: must be a file with the ending"),
        ((ring, ring, "-o", tmp_path / "x.surface.json"), "ring.surface.json: format"),
        ((PAPER / "three-loops.json", solution, "-o", tmp_path / "x.surface.json"), "surface: is"),
        ((ring, solution, "-o", ring), "is an input"),
    ]
    before = ring.read_bytes()
    for arguments, complaint in cases:
        assert run("paint", *arguments) == 2
        lines = capsys.readouterr().err.splitlines()
        assert len(lines) == 1 and complaint in lines[0], lines
    assert ring.read_bytes() == before
    assert {path.name for path in tmp_path.iterdir()} == {"solution.json"}


def test_a_scene_is_asked_what_reaches_new_vertices(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A division drawn at random copies colors beyond where they reach: both minima are told."""
    scene = shipped("wok")
    file, solution = tmp_path / "scene.toml", tmp_path / "solution.json"
    text = WOK.read_text()
    setup = (ROBOTS / "ur5_polishing.toml").read_text().partition("[slivers]")[0]
    for key in ("arm_urdf", "tool_urdf"):
        setup = edited(setup, **{key: f'"{ROBOTS / getattr(scene.setup.robot, key)}"'})
    (tmp_path / "setup.toml").write_text(setup)
    file.write_text(edited(text, setup='"setup.toml"', target_vertices=150))
    instance = cellcolor.decompose(file)
    chance = random_solution(instance, 1, random.Random(4))
    solution.write_text(chance.to_json())
    output = tmp_path / "painted.surface.json"
    assert run("paint", file, solution, "-o", output) == 0
    said = capsys.readouterr().out
    assert f"the scene rejects copied colors: {chance.segments} segments as solved," in said
    assert "2 after solving again with the true colors of the refined surface" in said
    assert run("check", output, tmp_path / "painted.plan.json", "--json") == 0
    assert json_lines(capsys.readouterr().out)[0]["optimal"]
