"""Beside a minimum without slivers stands the one with them: that of the scene without a policy."""

from __future__ import annotations

from pathlib import Path

import pytest
from shipped import TOP

import cellcolor
from cellcolor.data.solution import Solution
from cellcolor.door import solving
from cellcolor.frontend import BuildResult, Scene

pytestmark = pytest.mark.second

SHEET = TOP / "instances" / "parts" / "perforated_sheet.toml"


@pytest.fixture(scope="module")
def built() -> BuildResult:
    return cellcolor.build(SHEET)


def test_the_raw_minimum_is_that_of_the_scene_without_a_policy(
    built: BuildResult, tmp_path: Path
) -> None:
    """Built anew without a policy: the same surface, and the same number, with the area."""
    scene = Scene.read(SHEET)
    without = cellcolor.build(scene.with_setup(scene.setup.varied(slivers=None)))
    raw = built.raw_surface
    assert raw is not None and without.raw_surface is None
    assert raw.vertex_colors == without.surface.vertex_colors
    assert raw.cracks == without.surface.cracks and raw.colors == without.surface.colors
    expected = cellcolor.solve(without)
    assert expected.solution.proved_for_surface
    areas = built.prepared.surface.mesh.vertex_areas
    share = areas[list(built.surface.given_up)].sum() / areas.sum()
    solved = cellcolor.solve(built)
    assert solved.solution.notes == (
        f"{share:.1%} of the area was given up as slivers; with nothing given up: "
        f"{expected.solution}",
    )
    assert expected.solution.notes == ()
    solved.save(tmp_path / "solution.json")
    assert Solution.read(tmp_path / "solution.json").notes == solved.solution.notes


def test_what_is_not_found_in_time_is_not_said(
    built: BuildResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The minimum itself stays; of the raw one only what is known."""
    monkeypatch.setattr(solving, "_BESIDE_SECONDS", 0.0)
    solution = cellcolor.solve(built).solution
    assert solution.status == "optimal"
    (note,) = solution.notes
    assert "optimal" not in note and "with nothing given up: no division was found" in note
