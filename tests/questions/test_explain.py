"""What costs a lift-off: each claim against the changed scene, built from scratch."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import json_lines, run
from shipped import SCENES, shipped

import cellcolor
from cellcolor.deadline import NEVER
from cellcolor.frontend import BuildResult, Scene, build_surface
from cellcolor.frontend.build import StageClock, build_prepared
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.reach import validity_tests
from cellcolor.frontend.relaxing import (
    TOOL_LENGTH,
    Relaxation,
    built_asking_less,
    relaxations_of,
    without,
)
from cellcolor.questions.answers import Explanation, RelaxedMinimum

pytestmark = pytest.mark.second


def scene_of(name: str, vertices: int = 50) -> Scene:
    """A shipped scene, coarse, and narrow in joint 4 so that every kind of thing holds it back."""
    scene = shipped(name, vertices)
    return scene.with_setup(
        scene.setup.varied(
            robot={"arm_urdf": with_range(urdf_of(scene, "arm_urdf"), "wrist_1_joint", 2.0)},
            margins={"to_object_m": 0.004},
        )
    )


def urdf_of(scene: Scene, key: str) -> str:
    """The text of a URDF that a scene's setup names, or is given."""
    named = getattr(scene.setup.robot, key)
    return named if named.startswith("<") else (scene.setup.folder / named).read_text()


def with_range(text: str, joint: str, limit: float) -> str:
    """A URDF whose joint turns that far to both sides."""
    there = text.index(f'<joint name="{joint}"')
    limits = re.compile(r'lower="[^"]*" upper="[^"]*"')
    assert limits.search(text, there)
    new = limits.sub(f'lower="{-limit}" upper="{limit}"', text[there:], count=1)
    return text[:there] + new


def changed(scene: Scene, what: Relaxation) -> Scene:
    """The scene as somebody would write it who changes that one thing in the files."""
    setup, amount = scene.setup, what.amount
    table, _, name = what.key.rstrip("]").partition(".")
    if what.key.startswith("obstacle"):
        gone = scene.obstacle[int(what.key[9:-1])]
        return scene.varied(obstacle=tuple(one for one in scene.obstacle if one is not gone))
    if what.key == "ground":
        return lower_ground(scene, amount)
    if what.key.startswith("joint"):
        joint = what.key.removeprefix("joint[").removesuffix("].limit")
        assert joint == "wrist_1_joint" or amount == np.inf
        text = urdf_of(scene, "arm_urdf")
        if amount == np.inf:
            text = text.replace(f'"{joint}" type="revolute"', f'"{joint}" type="continuous"')
            assert "continuous" in text
        else:
            text = with_range(text, joint, 2.0 + amount)
        return scene.with_setup(setup.varied(robot={"arm_urdf": text}))
    changes: dict[str, dict[str, Any]] = {
        "margins": {name: 0},
        "constraints": {name: False},
        "task": {name: amount},
    }
    if what.key == "robot.may_touch":
        robot = prepare(scene).robot
        links = [(robot.bodies[i].link, robot.bodies[j].link) for i, j in robot.tested_pairs]
        if what.parts == ():
            links = [pair for pair in links if what.name.endswith(" and ".join(pair))]
        changes["robot"] = {"may_touch": (*setup.robot.may_touch, *links)}
    elif what.key == "robot.tool_urdf":
        text = urdf_of(scene, "tool_urdf")
        bare = re.sub(r"<collision.*?</collision>", "", text, flags=re.DOTALL)
        changes["robot"] = {"tool_urdf": bare}
    elif table == "thresholds":
        kept = max(1 - amount / 100, 0) * getattr(setup.thresholds, name)
        changes["thresholds"] = {name: kept}
    return scene.with_setup(setup.varied(**{table: changes[table]}))


def lower_ground(scene: Scene, amount: float) -> Scene:
    if amount == np.inf:
        return scene.varied(ground=None)
    assert scene.ground is not None
    return scene.varied(ground={"height_m": scene.ground.height_m - amount})


def from_scratch(
    scene: Scene, what: Sequence[Relaxation], monkeypatch: pytest.MonkeyPatch
) -> BuildResult:
    keys = [one.key for one in what]
    for one in what:
        if one.key != "object":
            scene = changed(scene, one)
    tests = list(validity_tests.STANDARD_TESTS)
    if "object" in keys:  # no file says that the part may be hit
        tests = [one for one in tests if one.name != "object collision"]
    with monkeypatch.context() as patch:
        patch.setattr(validity_tests, "STANDARD_TESTS", tuple(tests))
        return build_surface(scene)


def same_answers(found: BuildResult, other: BuildResult) -> bool:
    """Whether two builds of one surface have the same colors, cracks and reasons."""
    return (
        np.array_equal(found.verdicts.valid, other.verdicts.valid)
        and np.array_equal(found.all_colors.linked, other.all_colors.linked)
        and np.array_equal(found.coloring.node_color, other.coloring.node_color)
        and found.coloring.cracks == other.coloring.cracks
    )


@pytest.mark.parametrize(
    "name", ["wok_obstacle", pytest.param("hemisphere_tilted", marks=pytest.mark.slow)]
)
def test_each_row_is_that_of_the_scene_with_the_thing_changed(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = scene_of(name)
    if name == "hemisphere_tilted":  # where nothing stands around, the tool's tip needs no room
        scene = scene.varied(ground=None)
    prepared = prepare(scene)
    clock = StageClock(NEVER, None)
    before = build_prepared(prepared, clock)
    changing = 0
    for one in (*relaxations_of(prepared), TOOL_LENGTH.by(0.03)):
        if one.key == "robot.tool_urdf" and (scene.ground is not None or scene.obstacle):
            continue
        if one.reasons is None:
            found = build_prepared(without(prepared, [one]), clock)
        else:
            found = built_asking_less(without(prepared, [one]), before, one.reasons, clock)
        assert same_answers(found, from_scratch(scene, [one], monkeypatch)), one
        changing += not np.array_equal(found.verdicts.valid, before.verdicts.valid)
    assert changing >= 3


@pytest.mark.parametrize(("segments", "said"), [(1, True), (3, False)])
def test_where_no_lift_off_is_needed_none_is_left_to_save(segments: int, said: bool) -> None:
    here = RelaxedMinimum((), (), segments, segments, 1.0, 0.9, True)
    assert ("no lift-off is left to save" in str(Explanation("x", here, ()))) == said


def test_a_scene_that_nothing_of_is_reached() -> None:
    """No number of lift-offs is told, and less that reaches nothing saves none."""
    here = RelaxedMinimum((), (), 3, 3, 1.0, 0.9, True)
    nothing = RelaxedMinimum(
        ("ground",), ("ground",), None, 0, 0.0, 0.0, True, "nothing is reached"
    )
    text = str(Explanation("x", here, (nothing,)))
    assert "without ground: nothing is reached" in text and "lift-off," not in text.split("\n")[1]
    assert "nothing is reached → 2 lift-offs" in str(
        Explanation("x", nothing, (replace(here, relaxed=("ground",)),))
    )
    far = shipped("square", 40).varied(placement={"position_m": (2.5, 0.0, 0.0)}, ground=None)
    found = cellcolor.explain(far)
    assert [row.segments for row in found] == [None] * len(list(found))
    assert str(found).startswith("square: nothing is reached\n") and found.sets == ()
    assert "nothing of this helps: move the part" in str(found)


@pytest.mark.parametrize(
    ("segments", "share", "complete", "said"),
    [(3, 0.9, True, True), (3, 0.95, True, False), (2, 0.8, True, False), (3, 0.9, False, False)],
)
def test_the_part_is_to_be_moved_where_nothing_else_helps(
    segments: int, share: float, complete: bool, said: bool
) -> None:
    """Without the ground: the same, more area, fewer lift-offs; or not all was tried."""
    here = RelaxedMinimum((), (), 3, 3, 1.0, 0.9, True)
    other = RelaxedMinimum(("ground",), ("ground",), segments, segments, 1.0, share, True)
    found = Explanation("x", here, (other,), complete=complete)
    assert ("move the part" in str(found)) == said


@pytest.fixture(scope="module")
def tilted() -> Explanation:
    return cellcolor.explain(shipped("hemisphere_tilted", 120))


def test_numbers_and_areas_are_those_of_the_changed_scene(tilted: Explanation) -> None:
    scene = shipped("hemisphere_tilted", 120)
    for row, other in (
        (tilted.base, scene),
        (
            next(row for row in tilted.alone if row.relaxed == ("ground",)),
            scene.varied(ground=None),
        ),
    ):
        built = cellcolor.build(other)
        solution = cellcolor.solve(built).solution
        areas = built.surface.vertex_areas
        colored = [bool(colors) for colors in built.surface.vertex_colors]
        assert (row.segments, row.proved_for_surface) == (solution.segments, True)
        assert row.surface_share == pytest.approx(areas[colored].sum() / areas.sum())
        solved = (built.reasons != built.reason_names.index("no solution")).any(axis=1)
        assert row.covered_share == pytest.approx(areas[colored].sum() / areas[solved].sum())
    assert tilted.complete and all(row.proved_for_surface for row in tilted)
    numbers = [row.segments or 0 for row in tilted.alone]
    assert numbers == sorted(numbers)


def test_an_amount_saves_what_it_says_and_less_of_it_does_not(tilted: Explanation) -> None:
    """The ground lower by as much as is said, and by as much as is said not to be enough."""
    scene = shipped("hemisphere_tilted", 120)
    row, tool = tilted.amounts
    assert row.keys == ("ground",) and tool.relaxed == ("tool 40 mm longer",)
    enough, too_little = (
        float(re.search(r"lower by ([\d.]+) mm", text)[1]) / 1e3  # type: ignore[index]
        for text in (row.relaxed[0], row.note)
    )
    assert 0 < too_little < enough < 1.1 * too_little
    numbers = {}
    for lower in (enough * 1.001, too_little * 0.999):
        built = cellcolor.build(lower_ground(scene, lower))
        numbers[lower] = cellcolor.solve(built).solution.segments
    assert list(numbers.values()) == [row.segments, tilted.base.segments]
    assert row.segments is not None and row.segments < (tilted.base.segments or 0)


def test_where_one_is_not_enough_the_smallest_set_is_found() -> None:
    """An obstacle that stands there twice: neither of the two costs anything alone."""
    scene = shipped("wok_obstacle", 200)
    alone = cellcolor.explain(scene)
    (lone,) = [row for row in alone.alone if row.keys == ("obstacle[0]",)]
    assert lone.segments is not None and lone.segments < (alone.base.segments or 0)
    assert alone.sets == ()
    twice = cellcolor.explain(scene.with_obstacle(*scene.obstacle))
    assert all(row.segments == twice.base.segments for row in twice.alone)
    both = [row for row in twice.sets if row.keys == ("obstacle[0]", "obstacle[1]")]
    assert [row.segments for row in both] == [lone.segments]
    assert all(len(row.relaxed) == 2 for row in twice.sets)


def test_the_command_prints_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "wok.toml"
    text = (SCENES / "wok_obstacle.toml").read_text()
    setup = (SCENES.parents[1] / "models" / "robots" / "ur5_polishing.toml").as_posix()
    text = text.replace("../../models/robots/ur5_polishing.toml", setup)
    file.write_text(text.replace("target_vertices = 1000", "target_vertices = 200"))
    assert run("explain", file, "--json") == 0
    rows = json_lines(capsys.readouterr().out)
    assert rows[0]["relaxed"] == [] and rows[1]["relaxed"] == ["obstacle 1 (cylinder)"]
    assert rows[1]["lift_offs"] < rows[0]["lift_offs"]
    asked = {"relaxed", "lift_offs", "covered_share", "surface_share", "proved_for_surface"}
    assert all(asked <= row.keys() for row in rows)
    for wrong, said in (
        ((tmp_path / "none.toml",), "No such file"),
        ((SCENES.parent / "index.json",), "is no scene"),
    ):
        assert run("explain", *wrong) == 2
        assert said in capsys.readouterr().err
    assert run("explain", file, "--time-limit", "0.01") == 3
    assert "the time limit came first" in capsys.readouterr().err
