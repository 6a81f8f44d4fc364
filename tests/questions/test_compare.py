"""Arms compared: each row against the scene that ``cellcolor.new`` begins with, moved there."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from commands import json_lines, run
from shipped import ROBOTS

import cellcolor
from cellcolor import Comparison
from cellcolor.door import comparing
from cellcolor.door.starting import FoundArm, best_place
from cellcolor.frontend import Scene
from cellcolor.frontend.prepared import PreparedScene

Capture = pytest.CaptureFixture[str]


@pytest.fixture(scope="module")
def arch(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A strip bent over three quarters of a circle, in millimeters: no arm reaches all of it."""
    angles, width = np.linspace(-0.75 * np.pi, 0.75 * np.pi, 25), np.linspace(-30, 30, 8)
    angle, y = np.meshgrid(angles, width, indexing="ij")
    points = np.column_stack([part.ravel() for part in (40 * np.sin(angle), y, 40 * np.cos(angle))])
    corner = (8 * np.arange(24)[:, None] + np.arange(7)).ravel()
    low = np.column_stack([corner, corner + 8, corner + 9])
    high = np.column_stack([corner, corner + 9, corner + 1])
    file = tmp_path_factory.mktemp("arch") / "arch.stl"
    trimesh.Trimesh(points, np.concatenate([low, high]), process=False).export(file)
    return file


def compare(part: Path, *arms: str | Path, **changes: Any) -> Comparison:
    given: dict[str, Any] = {"points": 2, "vertices": 60} | changes
    return cellcolor.compare(part, arms, **given)


@pytest.fixture(scope="module")
def found(arch: Path) -> Comparison:
    return compare(arch, "ur5e", ROBOTS / "kr6.urdf")


@pytest.mark.slow
def test_rows_are_those_of_a_scene_begun_and_moved_by_hand(
    found: Comparison, arch: Path, tmp_path: Path
) -> None:
    assert [row.arm for row in found] == ["ur5e", str(ROBOTS / "kr6.urdf")]
    shares = []
    for row, name in zip(found, ("ur5e", "kr6"), strict=True):
        best = row.best
        assert best is not None and row.front is not None and found.complete
        made = cellcolor.new(arch, ROBOTS / f"{name}.urdf", tmp_path / name)
        scene = Scene.read(made.scene)
        built = cellcolor.build(scene.moved(position_m=best.pose[:3], rpy_rad=best.pose[3:]))
        colored = [bool(colors) for colors in built.surface.vertex_colors]
        areas = built.surface.vertex_areas
        assert best.covered_share == pytest.approx(areas[colored].sum() / areas.sum())
        solution = cellcolor.solve(built).solution
        assert best.proved_for_surface and solution.proved_for_surface
        assert best.segments == solution.segments == len(row.shares)
        # What all of them cover together is what a color reaches.
        assert row.shares[-1] == pytest.approx(best.covered_share)
        assert list(row.shares) == sorted(row.shares)
        front = cellcolor.tradeoff(built)
        assert [point.covered_share for point in row.front] == pytest.approx(
            [point.covered_share for point in front]
        )
        assert row.torques_tested == scene.setup.constraints.force
        here = cellcolor.build(scene)
        colored = [bool(colors) for colors in here.surface.vertex_colors]
        shares.append(here.surface.vertex_areas[colored].sum() / here.surface.vertex_areas.sum())
        assert best.rank(found.cover) <= (shares[-1] < found.cover - 1e-9, 9e9)
    # Every arm has to cover as much as the best where the part is put at first.
    assert found.cover == pytest.approx(max(shares))


@pytest.mark.slow
def test_an_arm_that_reaches_nothing_is_a_row(arch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def out_of_reach(arm: FoundArm, *others: Any) -> tuple[PreparedScene, float]:
        if arm.reach < 0.7:
            raise cellcolor.InputError(str(arch), None, "nothing of the part can be reached")
        return best_place(arm, *others)

    monkeypatch.setattr(comparing, "best_place", out_of_reach)
    large, small = compare(arch, "ur5e", "ur3e", points=1, cover=0.01)
    assert large.best is not None and not large.refused
    assert small.best is None and not small.shares
    row = small.to_document()
    assert row["lift_offs"] is row["position_m"] is row["front"] is None
    assert row["covered_share"] == 0 and row["refused"] == "nothing of the part can be reached"
    with pytest.raises(cellcolor.InputError, match=r"arch.stl: ur3e: nothing of the part"):
        compare(arch, "ur3e")


@pytest.mark.slow
def test_the_command_prints_rows_and_a_picture(arch: Path, tmp_path: Path, capsys: Capture) -> None:
    picture = tmp_path / "arms.svg"
    options = ("--arm", "ur5e", "--x", "0.4,0.6", "--points", "1", "--vertices", "60")
    assert run("compare", arch, *options, "--cover", "0.3", "-o", picture, "--json") == 0
    (row,) = json_lines(capsys.readouterr().out)
    assert row["arm"] == "ur5e" and row["file"] == str(arch)
    assert row["lift_offs"] == row["segments"] - 1 and row["proved_for_surface"]
    assert 0.3 <= row["covered_share"] <= 1 and len(row["position_m"]) == len(row["rpy_rad"]) == 3
    assert [point["segments"] for point in row["front"]][-1] == row["segments"]
    assert "ur5e" in picture.read_text() and "lift-offs" in picture.read_text()


def test_what_cannot_be_compared_is_one_line(arch: Path, tmp_path: Path, capsys: Capture) -> None:
    faulty = tmp_path / "faulty.stl"
    faulty.write_text("solid\nendsolid\n")
    mine = tmp_path / "mine.png"
    mine.write_text("mine")
    for wrong, said in (
        ((arch, "--arm", "ur5f"), "ur5f: is no URDF, and no arm of that name is shipped; is 'ur5"),
        ((arch, "--arm", tmp_path / "none.urdf"), "none.urdf"),
        ((arch, "--arm", "cobra600"), "cobra600.urdf"),
        ((arch, "--arm", "polishing_tool"), "polishing_tool.urdf"),
        ((arch, "--arm", "ur5e", "--arm", "ur5e"), "ur5e is given twice"),
        ((arch, "--arm", "ur5e", "--x", "1"), "'--x': a range is two numbers"),
        ((arch, "--arm", "ur5e", "--x", "0.5,0.4"), "x: the range from 0.5 to 0.4 is empty"),
        ((arch, "--arm", "ur5e", "-o", tmp_path / "out.html"), "must end in .png or .svg"),
        ((arch, "--arm", "ur5e", "-o", mine), "mine.png"),
        ((arch, "--arm", "ur5e", "--unit", "m"), "arch.stl: ur5e: "),
        ((faulty, "--arm", "ur5e"), "faulty.stl"),
        ((tmp_path / "none.stl", "--arm", "ur5e"), "none.stl"),
    ):
        assert run("compare", *wrong) == 2
        (line,) = capsys.readouterr().err.splitlines()
        assert said in line
    assert mine.read_text() == "mine" and not (tmp_path / "out.html").exists()
    with pytest.raises(cellcolor.InputError, match="no arm is given"):
        cellcolor.compare(arch, [])
    with pytest.raises(cellcolor.InputError, match=r"must be from 0 to 1"):
        compare(arch, "ur5e", cover=1.5)
    assert run("compare", arch, "--arm", "ur5e", "--time-limit", "0.001") == 3
