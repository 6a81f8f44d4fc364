"""The oracle of one surface: its verdicts say where a plan can be beaten, and why not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES
from meshes import drawn, surfaces

import cellcolor
import cellcolor.door.oracle
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.cli import main
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.oracle import ProvenRange
from examples import examples

RED, BLUE = 0, 1
ROW = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})
WORSE = (RED, RED, BLUE, BLUE, RED, RED) * 3


def test_where_a_plan_can_be_beaten() -> None:
    """Its first and its last segment are parted by the middle one, which could be red."""
    verdict = cellcolor.Oracle(ROW).judge(WORSE)
    better = verdict.improvement
    assert better is not None and verdict.beatable_by == 2
    assert better.segments == better.segments_on_mesh == 1
    # Three segments of six vertices each: the outer two have more area than the middle strip's
    # outline leaves to neither; any two are in the one segment of the better painting.
    assert set(better.joined) <= {0, 1, 2} and better.joined[0] < better.joined[1]
    assert "can be joined" in str(verdict)


@examples(20)
@given(surfaces(), st.data())
def test_the_better_painting_is_one(surface: LabelledSurface, data: st.DataObject) -> None:
    """Judged by the checker of plans alone; and the two segments do lie in one of it."""
    choices = [st.sampled_from(colors) if colors else st.none() for colors in surface.vertex_colors]
    colors = data.draw(st.tuples(*choices))
    oracle = cellcolor.Oracle(surface, workers=1)
    verdict = oracle.judge(colors)
    assert verdict.segments is not None and verdict.on_mesh is not None
    if verdict.improvement is None:
        assert not verdict.beatable_by
        return
    better = verdict.improvement.better
    painted = check_plan(better.painted.surface, better.painted.plan)
    assert painted.segments == verdict.improvement.segments < verdict.segments
    assert check_plan(surface, better.on_mesh).segments == verdict.improvement.segments_on_mesh
    assert verdict.on_mesh.upper == min(verdict.segments, verdict.improvement.segments_on_mesh)
    mine = check_plan(surface, Plan(colors)).segment_of
    one, other = verdict.improvement.places
    assert (mine[one], mine[other]) == verdict.improvement.joined
    assert painted.segment_of[one] == painted.segment_of[other]


@examples(20)
@given(surfaces(), st.data())
def test_segments_are_numbered_in_the_order_of_their_first_vertices(
    surface: LabelledSurface, data: st.DataObject
) -> None:
    choices = [st.sampled_from(colors) if colors else st.none() for colors in surface.vertex_colors]
    colors = data.draw(st.tuples(*choices))
    report = check_plan(surface, Plan(colors))
    firsts = list(dict.fromkeys(number for number in report.segment_of if number >= 0))
    assert firsts == list(range(report.segments or 0))
    assert [number < 0 for number in report.segment_of] == [color is None for color in colors]
    for a, b in surface.left_of:
        joined = colors[a] == colors[b] is not None and colors[a] not in surface.cracked(a, b)
        if joined:
            assert report.segment_of[a] == report.segment_of[b]


def test_why_an_optimal_plan_cannot_be_beaten() -> None:
    surface = drawn("AABB AABB", {"A": [RED], "B": [BLUE]})
    verdict = cellcolor.Oracle(surface).judge([RED, RED, BLUE, BLUE] * 2)
    assert verdict.optimal and verdict.why == "cells 0 and 1 share no color"
    assert "because cells 0 and 1 share no color" in str(verdict)


def test_a_surface_is_proved_once_for_all_plans(monkeypatch: pytest.MonkeyPatch) -> None:
    proofs: list[str] = []

    def prove(surface: LabelledSurface, deadline: Deadline, **options: Any) -> Any:
        proofs.append(surface.name)
        return cellcolor.oracle.prove(surface, deadline, **options)

    monkeypatch.setattr(cellcolor.door.oracle, "prove", prove)
    oracle = cellcolor.Oracle(ROW)
    assert proofs == []
    verdicts = [oracle.judge(colors) for colors in (WORSE, WORSE, (RED,) * 18)]
    assert [verdict.segments for verdict in verdicts] == [3, 3, 1]
    assert oracle.bounds == ProvenRange(1, 1)
    assert len(proofs) == 1


def test_plans_in_names_numbers_arrays_and_solutions(tmp_path: Path) -> None:
    names = ROW.colors
    expected = cellcolor.judge(ROW, WORSE)
    oracle = cellcolor.Oracle(ROW)
    assert oracle.judge([names[color] for color in WORSE]) == expected
    assert oracle.judge(np.array([names[color] for color in WORSE])) == expected
    assert oracle.judge(np.array(WORSE)) == expected
    assert oracle.judge(Plan(WORSE)) == expected
    result = cellcolor.solve(ROW)
    assert oracle.judge(result).optimal and oracle.judge(result.solution).optimal
    result.save(tmp_path / "solution.json")
    assert oracle.judge(tmp_path / "solution.json").optimal
    (tmp_path / "plan.json").write_text(Plan(WORSE).to_json())
    assert oracle.judge(str(tmp_path / "plan.json")) == expected


@pytest.mark.parametrize(
    ("plan", "message"),
    [
        (["red", "mauve"], "vertex_colors[1]: the surface has no color 'mauve'"),
        (7, "vertex_colors: Input should be a valid array"),
        (np.zeros((2, 2)), "vertex_colors: is an array (2, 2); pass joint angles as "),
        (None, "vertex_colors: Input should be a valid array"),
        ("none.json", "none.json: No such file or directory"),
    ],
)
def test_what_is_no_plan_is_refused(plan: Any, message: str) -> None:
    surface = replace(drawn("AA AA", {"A": [RED]}), colors=("red",))
    with pytest.raises(InputError) as found:
        cellcolor.Oracle(surface).judge(plan)
    assert str(found.value).startswith(message)


def test_a_solution_of_another_surface_is_no_valid_plan() -> None:
    other = cellcolor.solve(drawn("AABB AABB", {"A": [RED], "B": [BLUE]}))
    verdict = cellcolor.Oracle(ROW).judge(other)
    assert not verdict.valid and "instance.sha256" in verdict.problems[0]


def test_from_an_instance_that_names_its_surface_and_from_a_wide_mesh() -> None:
    oracle = cellcolor.Oracle(INSTANCES / "scenes" / "wok.json")
    assert oracle.bounds == ProvenRange(2, 2) and oracle.best is not None
    assert oracle.judge(oracle.best.on_mesh).optimal
    assert repr(oracle) == "<Oracle of 'wok', exactly 2 segments>"


@pytest.mark.parametrize("middle", [RED, BLUE])
def test_a_coarse_mesh_is_named_beside_the_surface(middle: int) -> None:
    """Both colors have to pass the single vertex M, side by side: two segments on the surface.

    On the mesh as it is M has one color, whichever it is, and the other one is in two pieces.
    """
    art = "...BB BBMRR RR..."
    narrow = drawn(art, {"R": [RED], "B": [BLUE], "M": [RED, BLUE], ".": []})
    letters = {"R": RED, "B": BLUE, "M": middle, ".": None}
    verdict = cellcolor.Oracle(narrow).judge([letters[letter] for letter in art.replace(" ", "")])
    assert (verdict.segments, verdict.bounds) == (3, ProvenRange(2, 2))
    assert verdict.beatable_by == 1 and verdict.improvement is not None
    assert (verdict.improvement.segments, verdict.improvement.segments_on_mesh) == (2, 3)
    assert verdict.on_mesh == ProvenRange(2, 3)
    assert "this mesh is coarse: on it 3 segments are the fewest found" in str(verdict)


def test_a_verdict_draws_itself(tmp_path: Path) -> None:
    oracle = cellcolor.Oracle(ROW)
    oracle.judge(WORSE).plot(tmp_path / "plan.png")
    assert (tmp_path / "plan.png").read_bytes().startswith(b"\x89PNG")
    drawing = oracle.judge(WORSE).plot()
    assert str(drawing).endswith("plan with 3 segments, 2 lift-offs")
    names = [name for name, _ in drawing.picture.legend]
    assert [name.partition(":")[0] for name in names] == [
        "segment 0",
        "segment 1",
        "segment 2",
        "border of a marked segment",
    ]
    with pytest.raises(InputError, match="is a solution"):
        oracle.judge(cellcolor.solve(ROW)).plot()


def test_what_is_wrong_has_a_place_and_is_drawn() -> None:
    wrong = (None, BLUE, *WORSE[2:])
    verdict = cellcolor.Oracle(ROW).judge(wrong)
    assert [(v.vertex, v.color) for v in verdict.violations] == [(0, None), (1, BLUE)]
    assert [v.place for v in verdict.violations] == [tuple(ROW.vertices[k]) for k in (0, 1)]
    assert tuple(map(str, verdict.violations)) == verdict.problems
    drawing = verdict.plot()
    assert str(drawing).endswith("no valid plan, 2 vertices wrong")
    assert "wrong color, or none" in dict(drawing.picture.legend)


def test_a_plan_is_shown_from_a_shell(tmp_path: Path) -> None:
    surface, plan = tmp_path / "row.surface.json", tmp_path / "row.plan.json"
    surface.write_text(ROW.to_json())
    plan.write_text(Plan(WORSE).to_json())
    assert main(["show", str(surface), str(plan), "-o", str(tmp_path / "plan.svg")]) == 0
    assert "segment 2" in (tmp_path / "plan.svg").read_text()
    plan.write_text(Plan(WORSE[1:]).to_json())
    assert main(["show", str(surface), str(plan), "-o", str(tmp_path / "plan.svg")]) == 2


def test_a_painting_ends_with_the_deadline_of_the_verdict(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The verdict says that the time limit came first; nothing else has time taken off."""
    given_deadlines: list[Deadline] = []

    def too_slow(_surface: Any, _graph: Any, _solution: Any, deadline: Deadline) -> Any:
        given_deadlines.append(deadline)
        raise OutOfTime("the time limit came first")

    monkeypatch.setattr(cellcolor.door.oracle, "paint", too_slow)
    oracle = cellcolor.Oracle(ROW)
    deadline = Deadline.after(5.0)
    verdict = oracle.judge(WORSE, deadline=deadline)
    assert given_deadlines == [deadline]
    assert verdict.beatable_by == 2 and verdict.improvement is None
    assert "the time limit came before an example was found" in str(verdict)
    # The next plan of a suite does not pay for the same attempt again; with more time it does.
    oracle.judge(WORSE, deadline=Deadline.after(5.0))
    assert len(given_deadlines) == 1
    monkeypatch.undo()
    assert oracle.judge(WORSE, deadline=Deadline.after(60.0)).improvement is not None
