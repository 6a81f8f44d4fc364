"""A scene for each arm that comes along, built and solved; docs/arms.md has what came out."""

from __future__ import annotations

import re

import numpy as np
import pytest
from shipped import ROBOTS, TOP

import cellcolor
from cellcolor.data.candidate_table import VALID
from cellcolor.frontend import build_surface
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene

pytestmark = pytest.mark.slow

FILES = {path.stem: path for path in sorted((TOP / "instances" / "arms").glob("*.toml"))}
# One for each arm; the others are the same arms on other parts.
ONE_EACH = [
    "irb120_half_pipe",
    "kr6_square",
    "tx2_60_half_pipe",
    "ur10e_wok",
    "ur16e_half_pipe",
    "ur3e_half_pipe",
    "ur5e_calibrated_wok",
    "ur5e_wok",
]


def test_every_arm_has_a_scene() -> None:
    named = {Scene.read(path).setup.file for path in FILES.values()}
    arms = {path for path in ROBOTS.glob("*_polishing.toml") if "ur5_" not in path.name}
    assert {path.resolve() for path in named if path} == {path.resolve() for path in arms}
    assert {Scene.read(FILES[name]).setup.file for name in ONE_EACH} == named


@pytest.mark.parametrize("name", ONE_EACH)
def test_an_arm_from_its_urdf_to_a_proven_minimum(name: str) -> None:
    scene = Scene.read(FILES[name]).varied(object={"target_vertices": 120})
    result, normals = build_surface(scene), prepare(scene).surface.normals
    rows, branches = np.nonzero(result.reasons == VALID)
    assert len(rows) > 100
    poses = forward(result.robot, result.configurations[rows, branches])
    assert np.abs(poses.tip - result.surface.vertices[rows]).max() < 1e-9
    assert np.abs(poses.tool_axis + normals[rows]).max() < 1e-9
    found = cellcolor.solve(result.surface)
    assert found.optimal and found.solution.proved_for_surface
    assert cellcolor.check(result.surface, found).problems == ()


def stated() -> dict[str, int]:
    """Lift-offs of each scene, as docs/arms.md has them."""
    page = (TOP / "docs" / "arms.md").read_text(encoding="utf-8")
    told = re.findall(r"^- (\d+) lift-offs?: (.*(?:\n  .*)*)", page, re.MULTILINE)
    return {name: int(number) for number, names in told for name in re.findall(r"`(\w+)`", names)}


def test_every_scene_is_in_the_table() -> None:
    assert set(stated()) == set(FILES)


@pytest.mark.slow
@pytest.mark.parametrize("name", FILES)
def test_the_minima_of_the_table(name: str) -> None:
    found = cellcolor.solve(FILES[name])
    assert found.optimal and found.solution.proved_for_surface
    assert found.lift_offs == stated()[name]


EXPERIMENTS = [name for name in FILES if re.match("(ur5e|kr6)_[^c]", name)]


def check_motion(scene: Scene, **options: float) -> None:
    """A motion over the scene is valid, and says why where it lifts off more often than needed."""
    planned = cellcolor.plan(scene, **options)
    assert planned.verdict.fault_counts == {}
    minimum = cellcolor.solve(scene).lift_offs
    assert planned.verdict.minimum_lift_offs == minimum
    assert planned.verdict.lift_offs == minimum + len(planned.trajectory.extra_lift_offs)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ur5e_half_pipe", "kr6_wok"])
def test_a_motion_is_judged_valid(name: str) -> None:
    scene = Scene.read(FILES[name]).varied(object={"target_vertices": 150})
    check_motion(scene, spacing_m=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("name", EXPERIMENTS)
def test_motions_of_the_six_experiments_are_judged_valid(name: str) -> None:
    check_motion(Scene.read(FILES[name]))
