"""``cellcolor cover``: the file of paths, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from commands import run
from library import PAPER

import cellcolor

RING = PAPER / "ring.surface.json"
LENGTHS = ("--spacing-m", 0.5, "--tool-radius-m", 0.5)


@pytest.fixture
def painted(tmp_path: Path) -> tuple[Path, Path]:
    solution = tmp_path / "solution.json"
    assert run("solve", RING, "-o", solution) == 0
    assert run("paint", RING, solution, "-o", tmp_path / "p.surface.json") == 0
    return tmp_path / "p.surface.json", tmp_path / "p.plan.json"


def test_the_paths_are_written_and_read(
    painted: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "paths.json"
    capsys.readouterr()
    assert run("cover", *painted, *LENGTHS, "--pattern", "back-and-forth", "-o", output) == 0
    said = capsys.readouterr().out
    assert said.startswith(f"wrote {output}: ") and "segment 0:" in said
    paths = cellcolor.read(output)
    surface = cellcolor.read(painted[0])
    assert paths.surface_sha256 == surface.sha256 and paths.pattern == "back-and-forth"
    # The same in Python, from files and from values.
    again = cellcolor.cover(*painted, pattern="back-and-forth", spacing_m=0.5, tool_radius_m=0.5)
    assert again.paths == paths
    values = cellcolor.cover(
        surface,
        cellcolor.read(painted[1]),
        pattern="back-and-forth",
        spacing_m=0.5,
        tool_radius_m=0.5,
    )
    assert values.paths == paths


def test_wrong_input_is_refused(
    painted: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    surface, plan = painted
    output = tmp_path / "paths.json"
    other = tmp_path / "other.plan.json"
    document = json.loads(plan.read_text())
    document["vertex_colors"].pop()
    other.write_text(json.dumps(document))
    capsys.readouterr()
    cases = [
        ((surface, other, *LENGTHS, "-o", output), "other.plan.json: the plan is not valid"),
        ((surface, surface, *LENGTHS, "-o", output), "p.surface.json: format"),
        ((surface, plan, *LENGTHS, "-o", plan), "is an input"),
        ((surface, plan, *LENGTHS, "-o", output, "--pattern", "zigzag"), "zigzag"),
        ((surface, plan, "--spacing-m", 0, "--tool-radius-m", 1, "-o", output), "spacing-m"),
        ((surface, plan, "--spacing-m", 1e-6, "--tool-radius-m", 1, "-o", output), "spacing_m"),
        ((surface, plan, "--spacing-m", "inf", "--tool-radius-m", 1, "-o", output), "spacing_m"),
    ]
    for arguments, complaint in cases:
        assert run("cover", *arguments) == 2
        assert complaint in capsys.readouterr().err
    assert not output.exists()


def test_python_refuses_what_does_not_fit() -> None:
    painting = cellcolor.paint("ring.surface.json", cellcolor.solve("ring.surface.json"))
    lengths = {"spacing_m": 0.5, "tool_radius_m": 0.5}
    with pytest.raises(cellcolor.InputError, match="plan: is already set"):
        cellcolor.cover(painting, painting.plan, **lengths)
    with pytest.raises(cellcolor.InputError, match="plan: is missing"):
        cellcolor.cover(painting.surface, **lengths)
    with pytest.raises(cellcolor.InputError, match="tool_radius_m: must be positive"):
        cellcolor.cover(painting, spacing_m=0.5, tool_radius_m=-1.0)
    with pytest.raises(cellcolor.InputError, match="there is no 'zigzag'; there are contour"):
        cellcolor.cover(painting, pattern="zigzag", **lengths)
