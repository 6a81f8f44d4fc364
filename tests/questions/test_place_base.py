"""The arm's base as what moves, and the price of what is left uncovered."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from commands import json_lines, run
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from shipped import SCENES, shipped

import cellcolor
from cellcolor.frontend.parts.placement import Placement
from cellcolor.questions.placing import minima_at
from examples import examples

METRES = st.floats(-2, 2)
ANGLES = st.floats(-3.1, 3.1)


def taken_along(thing: Placement, base: Placement) -> dict[str, Any]:
    """The pose in the world of what stands in the frame of a base; SciPy's rotations."""
    turn = Rotation.from_euler("xyz", base.rpy_rad)
    position = turn.apply(thing.position_m) + base.position_m
    angles = (turn * Rotation.from_euler("xyz", thing.rpy_rad)).as_euler("xyz")
    return {"position_m": tuple(position.tolist()), "rpy_rad": tuple(angles.tolist())}


@examples(60)
@given(
    base=st.tuples(METRES, METRES, METRES),
    yaw=ANGLES,
    thing=st.tuples(METRES, METRES, METRES),
    angles=st.tuples(ANGLES, ANGLES, ANGLES),
    tilt=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)),
)
def test_the_world_stays_where_it_is(
    base: Any, yaw: float, thing: Any, angles: Any, tilt: tuple[float, float]
) -> None:
    """Part, obstacle and ground, taken back into the world, are those of the scene."""
    own = shipped("wok_obstacle", 60)
    moved = {"position_m": thing, "rpy_rad": angles}
    scene = own.varied(
        placement=moved,
        obstacle=(own.obstacle[0].varied(**moved),),
        ground={"height_m": -0.1, "normal": (*tilt, 1.0)},
    )
    at = Placement(position_m=base, rpy_rad=(0.0, 0.0, yaw))
    seen = scene.seen_from(at)
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    for before, after in (
        (scene.placement, seen.placement),
        (scene.obstacle[0], seen.obstacle[0]),
    ):
        assert at.placed(after.placed(points)) == pytest.approx(before.placed(points), abs=1e-9)
    assert scene.ground is not None and seen.ground is not None
    plane, there = scene.ground.half_space, seen.ground.half_space
    heights = plane.heights(at.placed(points))
    assert there.heights(points) == pytest.approx(heights, abs=1e-9)


def test_a_world_and_a_base_that_move_together_change_nothing() -> None:
    """A scene whose things stand 0.3 m aside and turned, asked about with its base there too."""
    own = shipped("wok_obstacle", 60)
    base = Placement(position_m=(0.3, -0.2, 0.1), rpy_rad=(0.0, 0.0, 0.7))
    assert own.ground is not None
    aside = own.varied(
        placement=taken_along(own.placement, base),
        obstacle=tuple(each.varied(**taken_along(each, base)) for each in own.obstacle),
        ground={"height_m": own.ground.height_m + 0.1},
    )
    (there,) = minima_at(own, [(*own.placement.position_m, *own.placement.rpy_rad)], np.inf, 1, 0)
    pose = (*base.position_m, *base.rpy_rad)
    first, again = minima_at(aside, [pose, pose], np.inf, 1, 0, base=True)
    assert first == again and first.pose == pose
    assert (first.segments, first.vertices) == (there.segments, there.vertices)
    assert first.covered_share == pytest.approx(there.covered_share)


@pytest.mark.parametrize(
    ("scene", "field"),
    [
        (lambda own: own.varied(setup={"task": {"gravity_m_per_s2": (1.0, 0.0, -9.0)}}), "gravity"),
        (lambda own: own.varied(setup={"task": {"turn": {"along": (0.0, 1.0, 0.0)}}}), "task.turn"),
    ],
)
def test_what_is_bound_to_the_world_is_named(scene: Any, field: str) -> None:
    with pytest.raises(cellcolor.InputError, match="belongs to the world") as caught:
        scene(shipped("wok", 60)).seen_from(Placement(position_m=(0.1, 0.0, 0.0)))
    assert field in str(caught.value)


@pytest.mark.second
def test_the_command_moves_the_base(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("cellcolor.questions.searching_places._CLOSER", (0.3,))
    wok = SCENES / "wok_obstacle.toml"
    asked = ("--points", "1", "--vertices", "50", "--best", "1")
    assert run("place", wok, "--base", "--x", "0,0.1", *asked, "--json") == 0
    rows = json_lines(capsys.readouterr().out)
    assert all(row["moved"] == "base" for row in rows) and rows[0]["position_m"] == [0, 0, 0]
    assert run("place", wok, "--base", "--roll", "0,1") == 2
    assert "roll: the arm's base stays upright" in capsys.readouterr().err
