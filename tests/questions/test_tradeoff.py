"""Lift-offs against area: the front, against trying everything."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from commands import json_lines, run
from exhaustive_minima import front_by_subsets
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES
from meshes import drawn
from vertex_minima import front_by_vertices

import cellcolor
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.deadline import OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.questions import tradeoff
from cellcolor.questions.answers import Front
from cellcolor.questions.tradeoff import front_of
from cellcolor.solvers.interface import Options
from examples import examples

SEEDS = st.integers(0, 10**6)
WEIGHTS = st.lists(st.integers(0, 7), min_size=6, max_size=6)
RIM = {"size": 4, "colors": 2, "coverage": (0.8, 1.0), "rim": 4}
WAVES = {"size": 4, "colors": 3, "waves": 0.5}


def most(front: Front, segments: int) -> float:
    """The share that so many segments cover."""
    return max((p.covered_share for p in front if p.segments <= segments), default=0.0)


def weighing(instance: Instance, areas: Sequence[float]) -> Instance:
    """An instance whose cells have these areas."""
    pairs = zip(instance.cells, areas, strict=True)
    return replace(instance, cells=tuple(replace(cell, area=float(own)) for cell, own in pairs))


@examples(15)
@given(seed=SEEDS, cells=st.integers(1, 6), more=st.integers(0, 4), weights=WEIGHTS)
def test_the_front_is_the_one_that_trying_every_set_of_cells_finds(
    seed: int, cells: int, more: int, weights: list[int]
) -> None:
    own = weights[:cells]
    assume(sum(own) > 0)
    instance = weighing(planar_graph(seed, cells, cells + more, 3), own)
    front = front_of(instance, Options())
    for segments, weight in front_by_subsets(instance, own).items():
        assert most(front, segments) * sum(own) == pytest.approx(weight)


@examples(6)
@given(seed=st.integers(0, 500), rim=st.booleans(), weights=st.integers(0, 10**6))
def test_no_coloring_of_vertices_covers_more_than_a_point_says(
    seed: int, rim: bool, weights: int
) -> None:
    surface = blobs(seed, **(RIM if rim else WAVES))
    found = decomposition_of(surface)
    own = np.random.default_rng(weights).integers(0, 6, len(surface.vertices))
    cell = np.array(found.vertex_cell)
    inside = cell != OUTSIDE
    per_cell = np.bincount(cell[inside], own[inside], len(found.instance.cells))
    assume(per_cell.sum() > 0)
    front = front_of(weighing(found.instance, per_cell.tolist()), Options())
    best = front_by_vertices(surface, own.tolist())
    for point in front:
        if point.holds_for_surface and point.segments in best:
            assert best[point.segments] <= point.at_most_share * per_cell.sum() + 1e-6


@examples(10)
@given(seed=st.integers(0, 500), share=st.floats(0, 1))
def test_a_choice_is_the_best_of_all_sets_of_cells(seed: int, share: float) -> None:
    instance = decomposition_of(blobs(seed, **WAVES)).instance
    assume(1 < len(instance.cells) <= 8)
    areas = [cell.area or 0.0 for cell in instance.cells]
    best = front_by_subsets(instance, areas)
    fewest = front_of(instance, Options()).fewest_for(share)
    enough = [k for k, area in best.items() if area >= share * sum(areas) * (1 - 1e-9)]
    assert fewest.point.segments == min(enough) and fewest.proved


def test_nothing_is_proved_by_what_is_not_known() -> None:
    """By hand: the bound says whether fewer lift-offs might cover as much."""
    front = cellcolor.tradeoff(STRIP)
    one, two, _ = front.points
    assert front.fewest_for(two.covered_share).proved_for_surface
    for unknown in ((), ((1.0, True),), ((one.at_most_share, False),)):
        vague = Front(front.instance, front.points, front.weight, unknown)
        assert not vague.fewest_for(two.covered_share).proved_for_surface
    paper = Front(front.instance, front.points, front.weight, ((one.at_most_share, False),))
    assert paper.fewest_for(two.covered_share).proved


STRIP = drawn("AAAABBBBBBCC AAAABBBBBBCC", {"A": [0], "B": [1], "C": [2]})
"""Three colors side by side, of 8, 12 and 4 vertices."""


def test_the_largest_parts_come_first() -> None:
    """By hand: one segment covers B, two cover A and B; areas are those of the vertices."""
    areas = STRIP.vertex_areas
    share = {
        name: sum(areas[v] for v, own in enumerate(STRIP.vertex_colors) if own == (color,))
        for color, name in enumerate("ABC")
    }
    whole = sum(share.values())
    front = cellcolor.tradeoff(STRIP)
    assert [point.lift_offs for point in front] == [0, 1, 2]
    expected = [share["B"] / whole, (share["A"] + share["B"]) / whole, 1.0]
    assert [point.covered_share for point in front] == pytest.approx(expected)
    assert front.proved_for_surface
    assert front.fewest_for(expected[0]).point.lift_offs == 0
    assert front.fewest_for(expected[0] + 0.01).point.lift_offs == 1


def test_what_is_left_alone_does_not_count() -> None:
    right = cellcolor.WorldBox((9.5, -9.0, -9.0), (99.0, 99.0, 9.0))  # only C
    without = cellcolor.tradeoff(STRIP, left_alone=right)
    assert [point.lift_offs for point in without] == [0, 1]
    mask = [bool(own == (2,)) for own in STRIP.vertex_colors]
    assert str(cellcolor.tradeoff(STRIP, left_alone=mask)) == str(without)


def test_a_lift_off_more_for_what_weighs_nothing_is_no_point_of_the_front() -> None:
    instance = cellcolor.decompose(STRIP)
    nothing = [0.0 if cell.colors == (2,) else 1.0 for cell in instance.cells]
    points = front_of(weighing(instance, nothing), Options()).points
    assert [len(point.left_out) for point in points] == [2, 1]
    assert points[-1].covered_share == 1


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"left_alone": [True] * 23}, "left_alone"),
        ({"left_alone": [1] * 24}, "left_alone"),
        ({"left_alone": cellcolor.WorldBox((99, 0, 0), (100, 1, 1))}, "left_alone"),
    ],
)
def test_what_cannot_be_asked_is_refused(given: dict[str, Any], field: str) -> None:
    with pytest.raises(cellcolor.InputError) as found:
        cellcolor.tradeoff(STRIP, **given)
    assert found.value.field == field


def test_the_command_prints_a_row_for_each_point(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "strip.surface.json"
    file.write_text(STRIP.to_json())
    assert run("tradeoff", file, "--json") == 0
    rows = json_lines(capsys.readouterr().out)
    front = cellcolor.tradeoff(STRIP)
    assert [row["covered_share"] for row in rows] == [p.covered_share for p in front]
    assert [row["lift_offs"] for row in rows] == [0, 1, 2]
    assert all(row["proved_for_surface"] is True for row in rows)
    assert run("tradeoff", file, "--share", "0.5") == 0
    assert capsys.readouterr().out.startswith("0 lift-offs: 5")
    mask = tmp_path / "mask.json"
    mask.write_text('{"mask": [true]}')
    for wrong, said in (
        (("--left-alone", mask), "of another mesh"),
        (("--left-alone", "1,2,3,0,0,0"), "the box is empty"),
        (("--share", "nan"), "share"),
        (("--left-alone", tmp_path / "none.json"), "No such file"),
    ):
        assert run("tradeoff", file, *wrong) == 2
        assert said in capsys.readouterr().err
    file.write_text(STRIP.without_vertices(np.ones(len(STRIP.vertices), dtype=bool)).to_json())
    assert run("tradeoff", file) == 3
    assert "NOTHING CAN BE COVERED" in capsys.readouterr().err


def test_a_front_that_the_time_limit_cut_short_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Instance.read(INSTANCES / "scenes" / "wok.json")
    assert front_of(graph, Options()).complete

    def late(*_: object) -> None:
        raise OutOfTime

    monkeypatch.setattr(tradeoff._Asked, "most_of", late)
    front = front_of(graph, Options())
    assert not front.complete
    assert "the time limit came before everything was tried" in str(front)
