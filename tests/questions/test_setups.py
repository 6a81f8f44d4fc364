"""Several set-ups: the choice against trying all, and the whole way on a small scene."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import pi
from pathlib import Path

import numpy as np
import pytest
from commands import run
from exhaustive_minima import minimum
from hypothesis import assume, given
from hypothesis import strategies as st
from shipped import shipped

import cellcolor
from cellcolor.cli.ask import stops_of
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend import Scene
from cellcolor.lab.families import blobs
from cellcolor.questions import choosing_set_ups, setting_up
from cellcolor.questions.choosing_set_ups import choose
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options
from examples import examples

TURNED = (0.465, -0.15, -0.04, 0.0, 0.0, pi)
"""The wok before an obstacle, turned round."""


def together(surfaces: Sequence[LabelledSurface]) -> LabelledSurface:
    """All their colors on one surface; blobs have no cracks."""
    names: list[str] = []
    colors: list[list[int]] = [[] for _ in surfaces[0].vertices]
    for number, surface in enumerate(surfaces):
        for vertex, own in enumerate(surface.vertex_colors):
            colors[vertex] += [color + len(names) for color in own]
        names += [f"{number}/{name}" for name in surface.colors]
    first = surfaces[0]
    return LabelledSurface(
        "all", tuple(names), first.vertices, first.faces, tuple(map(tuple, colors))
    )


def reached(surface: LabelledSurface) -> np.ndarray:
    return np.array([bool(own) for own in surface.vertex_colors])


def covering(surfaces: Sequence[LabelledSurface], share: float) -> list[tuple[int, ...]]:
    """The smallest sets of set-ups that reach a share of what all reach."""
    areas = surfaces[0].vertex_areas
    whole = areas[np.any([reached(one) for one in surfaces], axis=0)].sum()
    for size in range(1, len(surfaces) + 1):
        found = [
            some
            for some in combinations(range(len(surfaces)), size)
            if areas[np.any([reached(surfaces[n]) for n in some], axis=0)].sum()
            >= share * whole - 1e-9
        ]
        if found:
            return found
    raise AssertionError("all of them reach everything")


def drawn_at_random(seed: int, count: int) -> list[LabelledSurface]:
    """Set-ups on one mesh of 16 vertices, each of which reaches about half of it."""
    found = [blobs(seed + n, size=4, colors=2, coverage=(0.3, 0.8)) for n in range(count)]
    assert all(np.array_equal(one.vertices, found[0].vertices) for one in found)
    return found


@examples(8)
@given(seed=st.integers(0, 10**6), count=st.integers(1, 4), listed=st.booleans())
def test_no_choice_has_fewer_set_ups_or_fewer_segments(seed: int, count: int, listed: bool) -> None:
    """Whether each set of set-ups has a model of its own or all of them have one."""
    surfaces = drawn_at_random(seed, count)
    assume(any(reached(one).any() for one in surfaces))
    sets = covering(surfaces, 1.0)
    graphs = [decomposition_of(together([surfaces[n] for n in some])).instance for some in sets]
    assume(all(graph.most_live_loops < 2 for graph in graphs))
    with pytest.MonkeyPatch.context() as patch:
        if not listed:
            patch.setattr(choosing_set_ups, "_MOST_SETS", 0)
        choice = choose(surfaces, 1.0, None, Options())
    assert len(choice.numbers) == choice.fewest_set_ups == len(sets[0])
    assert choice.numbers in sets
    assert choice.covered_share == pytest.approx(1.0)
    least = min(minimum(graph) for graph in graphs)
    assert choice.solution.segments == least
    assert choice.at_least_segments <= least
    assert choice.proved == (choice.at_least_segments == least)


@pytest.mark.parametrize("seed", [200, 1300, 2100])
def test_at_the_highest_price_segments_still_count(seed: int) -> None:
    """It comes to the fewest set-ups, and then to the fewest segments, as without a price.

    With 1e17, to which floating point adds no segments, up to 6 instead of 3 were called proved.
    """
    surfaces = [blobs(seed + n, size=6, colors=3, coverage=(0.3, 0.7)) for n in range(4)]
    in_turn = choose(surfaces, 1.0, None, Options())
    priced = choose(surfaces, 1.0, 1_000_000, Options())
    assert in_turn.proved and priced.proved
    assert priced.solution.segments == in_turn.solution.segments
    assert len(priced.numbers) == len(in_turn.numbers) == in_turn.fewest_set_ups


@pytest.fixture(scope="module")
def found() -> cellcolor.ChosenSetUps:
    return cellcolor.setups(shipped("wok_obstacle", 150), at=[TURNED])


def test_the_part_turned_round_is_covered_whole(found: cellcolor.ChosenSetUps) -> None:
    """What the obstacle hides from one side is reached from the other."""
    answer = found.answer
    assert answer.proved and len(answer.set_ups) == 2 and answer.change_overs == 1
    assert answer.lift_offs == answer.segments - 2
    assert answer.covered_share == 1.0 > answer.alone.covered_share
    assert sum(one.covered_share for one in answer) == pytest.approx(1.0)
    scene = shipped("wok_obstacle", 150)
    for one, pose in zip(found.scenes, (None, TURNED), strict=True):
        if pose is not None:
            assert one.placement.rpy_rad == pose[3:]
        alone = cellcolor.build(one)
        assert len(alone.surface.vertices) == len(answer.surface.vertices)
    assert len(found.scenes) == 2 and found.scenes[0].placement == scene.placement
    areas, masks = answer.surface.vertex_areas, found.left_alone()
    painted = [areas[~mask].sum() for mask in masks]
    assert sum(painted) == pytest.approx(areas[reached(answer.surface)].sum())
    assert cellcolor.check(answer.surface, answer.solution).valid


def on_a_rail(scene: Scene) -> Scene:
    """Its arm on a carriage that slides along y, from -1 m to 1 m."""
    robot = scene.setup.robot
    text = (scene.setup.folder / robot.arm_urdf).read_text()
    rail = (
        '<link name="rail"/><joint name="rail_joint" type="prismatic"><parent link="rail"/>'
        '<child link="base_link"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1" effort="0" velocity="1"/></joint></robot>'
    )
    arm = {"arm_urdf": text.replace("</robot>", rail), "fixed_joints": {"rail_joint": 0.0}}
    tool = {"tool_urdf": (scene.setup.folder / robot.tool_urdf).read_text()}
    return scene.with_setup(scene.setup.varied(robot=arm | tool))


def long_plate() -> Scene:
    """A plate of 1.6 m along a rail, before the arm: no stop reaches all of it."""
    plate = {
        "kind": "rectangle",
        "size_x_m": 0.2,
        "size_y_m": 1.6,
        "target_vertices": 60,
        "jitter": 0.1,
        "seed": 3,
    }
    return on_a_rail(shipped("square", 60)).varied(
        object=plate, placement={"position_m": (0.45, 0.0, 0.0)}, ground=None
    )


STOPS = (-0.6, -0.2, 0.2, 0.6)


def test_stops_are_the_fewest_and_then_have_the_fewest_lift_offs() -> None:
    """Against every choice of stops, each built as a scene whose joint is fixed there."""
    scene = long_plate()
    found = cellcolor.setups(scene, stops={"rail_joint": STOPS})
    surfaces = []
    for stop in STOPS:
        fixed = scene.setup.varied(robot={"fixed_joints": {"rail_joint": stop}})
        surfaces.append(cellcolor.build(scene.with_setup(fixed)).surface)
    sets = covering(surfaces, 1.0)
    graphs = [decomposition_of(together([surfaces[n] for n in some])).instance for some in sets]
    assert found.answer.proved and found.answer.candidates == len(STOPS)
    assert len(found.answer.set_ups) == len(sets[0]) > 1
    assert tuple(one.number - 1 for one in found.answer) in sets
    assert found.answer.segments == min(
        checked.solve(graph, Options()).segments for graph in graphs
    )
    for one, own in zip(found.answer, found.scenes, strict=True):
        stands = {"rail_joint": STOPS[one.number - 1]}
        assert one.fixed_joints == own.setup.robot.fixed_joints == stands
        assert f"with rail_joint = {stands['rail_joint']:g}: " in str(found)


def test_a_stop_at_which_the_part_stands_in_the_arm_is_left_out() -> None:
    """The plate is over the rail at 0.6 m, where the arm's base would be."""
    scene = long_plate().varied(placement={"position_m": (0.0, 1.4, 0.1)})
    found = cellcolor.setups(scene, stops={"rail_joint": (0.2, 0.8)})
    assert [one.fixed_joints["rail_joint"] for one in found.answer] == [0.2]
    (refused,) = found.answer.refused
    assert "rail_joint = 0.8" in refused and "stands in" in refused


def test_stops_are_read_and_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert stops_of("rail=0:0.5:0.25") == ("rail", (0.0, 0.25, 0.5))
    # 0.2 · 3 is above 0.6, where the rail may end.
    assert stops_of("rail=0:0.6:0.2") == ("rail", (0.0, 0.2, 0.4, 0.6))
    assert stops_of("turn=-1:1:0.8") == ("turn", (-1.0, -1 + 0.8, -1 + 1.6))
    for wrong in (
        "rail",
        "=0:1:1",
        "rail=0:1",
        "rail=0:1:0",
        "rail=1:0:1",
        "rail=0:1:nan",
        "r=0:9:1e-9",
    ):
        assert run("setups", "square", "--stops", wrong) == 2
        assert "stops are JOINT=FROM:TO:STEP" in capsys.readouterr().err
    assert run("setups", "square", "--stops", "rail_joint=0:1:1") == 2
    assert "robot.fixed_joints.rail_joint: no such joint" in capsys.readouterr().err


def test_what_cannot_be_set_up_is_refused_in_a_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    lines = tmp_path / "places.jsonl"
    lines.write_text("")
    for wrong, said in (
        (("--at", "1,2,3"), "'--at': a place is six numbers"),
        (("--at", "nan,0,0,0,0,0"), "at[0]: must be six numbers"),
        (("--at", "0.465,-0.15,-0.3,0,0,0"), "no set-up: the part stands in the ground"),
        (("--with", "half_pipe"), "half_pipe.toml: object: has"),
        (("-o", tmp_path / "none" / "a.png"), "its folder does not exist"),
        (("--plan", lines), "places.jsonl: must be a folder"),
        (("--change-over", "0.5"), "change_over: must be a number from 1 to 1000000, is 0.5"),
        (("--change-over", "1e306"), "change_over: must be a number from 1 to 1000000"),
        (("--change-over", "nan"), "change_over: must be a number from 1 to 1000000, is nan"),
        (("--change-over", "1.0004"), "change_over: must have no more than three decimals"),
    ):
        assert run("setups", "wok_obstacle", *wrong) == 2
        printed = capsys.readouterr()
        assert said in printed.err and len(printed.err.splitlines()) == 1 and not printed.out
    with pytest.raises(cellcolor.InputError, match="no set-up can be used"):
        inside = shipped("wok_obstacle", 80).moved(position_m=(0, 0, 0))
        cellcolor.setups(inside)
    for price in (float("nan"), 1e17, 1e306, 0.5):
        with pytest.raises(cellcolor.InputError, match=r"change_over: must be .* 1 to 1000000"):
            cellcolor.setups("wok_obstacle", change_over=price)


def test_candidates_that_the_time_limit_left_unbuilt_are_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    built, scene = setting_up._built, shipped("wok", 100)
    made: list[object] = []

    def one_only(*given: object) -> LabelledSurface:
        if made:
            raise OutOfTime
        made.append(given)
        return built(*given)

    monkeypatch.setattr(setting_up, "_built", one_only)
    found = cellcolor.setups(scene, at=[TURNED, (0.4, 0.0, -0.04, 0.0, 0.0, 0.0)]).answer
    assert (found.candidates, found.left, found.complete) == (1, 2, False)
    assert "the time limit left 2 candidates unbuilt" in str(found)
