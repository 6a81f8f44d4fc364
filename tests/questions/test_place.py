"""Where a part should stand: each row against the scene with that placement written in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import json_lines, run
from hypothesis import given
from hypothesis import strategies as st
from shipped import SCENES, shipped

import cellcolor
from cellcolor.deadline import NEVER
from cellcolor.frontend import Scene
from cellcolor.questions.placements import (
    PlacedMinimum,
    Placements,
    Pose,
)
from cellcolor.questions.placing import (
    coarse_scene,
    minima_at,
    spread,
)
from examples import examples

pytestmark = pytest.mark.second

RANGES = {"x": (0.3, 0.6), "y": (-0.3, 0.1)}
SHARES = st.integers(0, 1000).map(lambda mill: mill / 1000)


def place(**changes: Any) -> Placements:
    given: dict[str, Any] = {**RANGES, "points": 4, "best": 2, "vertices": 50} | changes
    return cellcolor.place(shipped("wok_obstacle", 80), **given)


@pytest.fixture(scope="module", autouse=True)
def fewer_boxes() -> Iterator[None]:
    """Two boxes around each of the best placements, not five: the same search, sooner over."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("cellcolor.questions.searching_places._CLOSER", (0.3, 0.08))
        yield


@pytest.fixture(scope="module")
def found() -> Placements:
    return place()


def at(scene: Scene, pose: Pose) -> Scene:
    return scene.moved(position_m=pose[:3], rpy_rad=pose[3:])


def by_hand(scene: Scene) -> tuple[int | None, float, int]:
    """Segments, share and vertices of a scene, built and solved as anybody would."""
    built = cellcolor.build(scene)
    solution = cellcolor.solve(built).solution
    assert solution.proved_for_surface
    areas = built.surface.vertex_areas
    colored = [bool(colors) for colors in built.surface.vertex_colors]
    share = float(areas[colored].sum() / areas.sum())
    return solution.segments, share, len(areas)


def test_a_mesh_file_is_made_coarser_and_collides_as_before() -> None:
    scene = Scene.read(SCENES.parent / "parts" / "bracket.toml")
    coarse = coarse_scene(scene, 150, NEVER)
    whole, surface = scene.covered(), coarse.covered()
    assert len(surface.vertices) < len(whole.vertices) / 1.5
    area, wanted = surface.mesh.vertex_areas.sum(), whole.mesh.vertex_areas.sum()
    assert area == pytest.approx(wanted, rel=0.05)
    assert coarse.solid_object == (scene.solid_object or scene.object)
    assert coarse_scene(scene, 10**5, NEVER).covered().vertices.shape == whole.vertices.shape


def test_rows_are_those_of_the_scene_with_the_placement_written_in(found: Placements) -> None:
    own = shipped("wok_obstacle", 80)
    coarse = coarse_scene(own, 50, NEVER)
    built = [row for row in found.tried if row.segments and row.vertices < found.here.vertices]
    for scene, rows in ((own, (found.here, *found.best)), (coarse, built[:3])):
        for row in rows:
            segments, share, vertices = by_hand(at(scene, row.pose))
            assert (row.segments, row.vertices) == (segments, vertices) and row.proved_for_surface
            assert row.covered_share == pytest.approx(share)
    assert found.here.pose == (*own.placement.position_m, *own.placement.rpy_rad)
    assert found.complete and found.cover == found.here.covered_share


def test_the_best_come_first_and_cover_enough(found: Placements) -> None:
    ranks = [row.rank(found.cover) for row in found.best]
    assert ranks == sorted(ranks) and len(found.best) == 2
    coarse = [row for row in found.tried if row.vertices < found.here.vertices]
    # Where it stands, the points, and one around each of the three best, in two boxes.
    assert len(coarse) == 1 + 4 + 2 * 3
    assert coarse[0].pose == found.here.pose
    for row in (*found.best, *found.tried[1:]):
        x, y, *others = row.pose
        assert RANGES["x"][0] <= x <= RANGES["x"][1] and RANGES["y"][0] <= y <= RANGES["y"][1]
        assert tuple(others) == found.here.pose[2:]


def test_bounds_lie_on_their_sides_of_what_a_whole_build_finds() -> None:
    """More at most, and fewer segments at least; with slivers only among those that are enough."""
    scene = shipped("wok_obstacle", 80)
    slivers = {"simplify_below_share": 0.03, "uncover_below_share": 0.03}
    given_up = scene.with_setup(scene.setup.varied(slivers=slivers))
    poses = spread(RANGES, (0.4, -0.1, -0.04, 0.0, 0.0, 0.3), 6, 3)
    tight = 0
    for own in (scene, given_up):
        whole = minima_at(own, poses, np.inf, 1, 0)
        for cover in (0.5, 0.9, 0.97):
            bounds = minima_at(own, poses, np.inf, 1, 0, False, cover)
            for row, bound in zip(whole, bounds, strict=True):
                assert bound.refused == row.refused and bound.segments is None
                assert bound.rank(cover) <= row.rank(cover)
                assert bound.covered_share >= row.covered_share - 1e-9
                if row.segments and row.covered_share >= cover:
                    assert 1 <= bound.at_least <= row.segments
                    tight += bound.at_least == row.segments > 1
    assert tight  # else any number would do


def test_nothing_is_listed_where_the_arm_does_not_reach(capsys: pytest.CaptureFixture[str]) -> None:
    options = ("--points", "2", "--vertices", "50", "--cover", "0.5")
    assert run("place", "wok_obstacle", "--x", "5,6", *options) == 3
    assert "no placement that was tried covers" in capsys.readouterr().out


def test_a_part_does_not_stand_in_the_ground_or_in_an_obstacle() -> None:
    """The rim of the cap under the ground; the cylinder through the cap, beside its middle."""
    scene = shipped("wok_obstacle", 60)
    poses: list[Pose] = [
        (0.465, -0.15, -0.12, 0.0, 0.0, 0.0),
        (0.3, 0.06, -0.04, 0.0, 0.0, 0.0),
        (0.465, -0.15, -0.04, 0.0, 0.0, 0.0),
    ]
    rows = minima_at(scene, poses, np.inf, 1, 0)
    assert [row.refused for row in rows] == [
        "it would stand in the ground",
        "it would stand in obstacle 1",
        "",
    ]


def test_where_the_scene_has_it_in_the_base_the_share_has_to_be_said() -> None:
    scene = shipped("wok", 60).moved(position_m=(0.0, 0.0, -0.15))
    asked: dict[str, Any] = {"x": (0.3, 0.6), "z": (-0.05, 0.0), "points": 1, "best": 1}
    with pytest.raises(cellcolor.InputError, match="say how much has to be covered") as caught:
        cellcolor.place(scene.varied(ground=None), **asked)
    assert caught.value.field == "cover" and "stands in the robot's" in str(caught.value)
    found = cellcolor.place(scene.varied(ground=None), **asked, cover=0.2, vertices=60)
    assert found.here.refused and found.best[0].covered_share >= 0.2


def test_why_the_part_cannot_stand_somewhere_is_said() -> None:
    """Counted by hand: two in the ground, one in an obstacle."""
    stands = PlacedMinimum((0.4, 0, 0, 0, 0, 0), 2, 0.9, True, 80)
    no = [
        PlacedMinimum((x, 0, 0, 0, 0, 0), None, 0.0, False, 0, f"it would stand in {what}")
        for x, what in enumerate(("the ground", "obstacle 1", "the ground"))
    ]
    text = str(Placements("part", 0.9, no[0], (stands,), tuple(no)))
    assert "(0, 0, 0) m: the part cannot stand there: it would stand in the ground" in text
    assert text.endswith(
        "  in 3 of them the part cannot stand: it would stand in the ground (2); "
        "it would stand in obstacle 1 (1)"
    )


@examples(50)
@given(
    rows=st.lists(st.tuples(st.none() | st.integers(1, 5), SHARES), min_size=1, max_size=8),
    cover=SHARES,
)
def test_the_rank_is_what_is_asked_for(rows: list[tuple[int | None, float]], cover: float) -> None:
    """Of those that cover enough the one with the fewest segments, then with the largest area."""
    values = [PlacedMinimum((0, 0, 0, 0, 0, 0), n, share, True, 1) for n, share in rows]
    best = min(values, key=lambda row: row.rank(cover))
    enough = [(n, -share) for n, share in rows if n is not None and share >= cover]
    if enough:
        assert (best.segments, -best.covered_share) == min(enough)
    else:
        assert best.covered_share == max(share for _, share in rows)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"x": (0.5, 0.3)}, "x"),
        ({"x": (0.5, float("nan"))}, "x"),
        ({"x": None, "y": None}, None),
        ({"cover": 1.5}, "cover"),
        ({"points": 0}, "points"),
        ({"best": 0}, "best"),
        ({"jobs": 0}, "jobs"),
        ({"x": 0.5}, "x"),
        ({"x": ("a", "b")}, "x"),
    ],
)
def test_what_cannot_be_asked_is_refused(changes: dict[str, Any], field: str | None) -> None:
    with pytest.raises(cellcolor.InputError) as caught:
        place(**changes)
    assert caught.value.field == field and "\n" not in str(caught.value)


def test_a_limit_that_ends_before_the_scene_itself_is_solved() -> None:
    with pytest.raises(cellcolor.OutOfTime):
        place(time_limit=1e-3)


def test_the_command_takes_a_tolerance(monkeypatch: pytest.MonkeyPatch) -> None:
    def asked(scene: Scene, **_: Any) -> Placements:
        assert scene.tolerance is not None and scene.tolerance.position_m == 0.002
        raise cellcolor.OutOfTime

    monkeypatch.setattr("cellcolor.door.asking.place", asked)
    assert run("place", "wok", "--x", "0.4,0.5", "--tolerance", "2mm") == 3
    assert run("place", "wok", "--x", "0.4,0.5", "--tolerance", "2") == 2


def test_the_command_prints_rows(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "wok.toml"
    text = (SCENES / "wok_obstacle.toml").read_text()
    setup = (SCENES.parents[1] / "models" / "robots" / "ur5_polishing.toml").as_posix()
    text = text.replace("../../models/robots/ur5_polishing.toml", setup)
    file.write_text(text.replace("target_vertices = 1000", "target_vertices = 80"))
    options = ("--x", "0.4,0.5", "--points", "1", "--vertices", "50", "--best", "1")
    assert run("place", file, *options, "--json") == 0
    rows = json_lines(capsys.readouterr().out)
    assert rows[0]["position_m"] == [0.465, -0.15, -0.04] and rows[0]["rpy_rad"] == [0, 0, 0]
    assert {"lift_offs", "covered_share", "proved_for_surface"} <= rows[1].keys()
    assert all(0.4 <= row["position_m"][0] <= 0.5 for row in rows)
    for wrong, said in (
        ((file,), "nothing may move"),
        ((file, "--x", "1"), "'--x': a range is two numbers"),
        ((file, "--x", "0.5,0.4"), "x: the range from 0.5 to 0.4 is empty"),
        ((file, "--yaw", "0,inf"), "yaw: its range must be two numbers"),
        ((tmp_path / "none.toml", "--x", "0,1"), "No such file"),
        ((SCENES.parent / "index.json", "--x", "0,1"), "is no scene"),
    ):
        assert run("place", *wrong) == 2
        assert said in capsys.readouterr().err
