"""A scene for each arm that comes along, built and solved; docs/arms.md has what came out."""

from __future__ import annotations

import re

import pytest
from shipped import ROBOTS, TOP

import cellcolor
from cellcolor.frontend.scene import Scene

pytestmark = pytest.mark.slow

FILES = {path.stem: path for path in sorted((TOP / "instances" / "arms").glob("*.toml"))}


def test_every_arm_has_a_scene() -> None:
    named = {Scene.read(path).setup.file for path in FILES.values()}
    arms = {path for path in ROBOTS.glob("*_polishing.toml") if "ur5_" not in path.name}
    assert {path.resolve() for path in named if path} == {path.resolve() for path in arms}


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
@pytest.mark.parametrize("name", EXPERIMENTS)
def test_motions_of_the_six_experiments_are_judged_valid(name: str) -> None:
    check_motion(Scene.read(FILES[name]))
