"""The oracle: never says more than is proved, never less than is known."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from meshes import drawn, surfaces

import cellcolor.checker.vertex_plan
import cellcolor.decomposition
import cellcolor.door.oracle
import cellcolor.oracle.ranges
import cellcolor.solvers.checked
from cellcolor import judge, proven_range
from cellcolor.cli import main
from cellcolor.data.instance import Instance
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import Decomposition
from cellcolor.errors import BeatenBound, InputError
from cellcolor.oracle import ProvenRange, Verdict
from cellcolor.solvers.interface import Options
from examples import examples

CORRIDORS = PAPER / "parallel-corridors.surface.json"
RED, BLUE, GREEN = 0, 1, 2


def halves(surface: LabelledSurface) -> Plan:
    """Upper half red, lower half blue, green where there is nothing else."""
    middle = surface.vertices[:, 1].mean()
    colors = []
    for (_, y, _), available in zip(surface.vertices, surface.vertex_colors, strict=True):
        wanted = RED if y > middle else BLUE
        colors.append(wanted if wanted in available else next(iter(available), None))
    return Plan(tuple(colors))


@pytest.mark.parametrize(
    "path", sorted(PAPER.glob("*.surface.json")), ids=lambda path: path.name.partition(".")[0]
)
def test_range_holds_what_is_known(path: Path) -> None:
    known = Instance.read(path.with_name(path.name.replace(".surface", ""))).known
    bounds = proven_range(LabelledSurface.read(path), time_limit=5.0)
    assert bounds.lower <= bounds.upper
    assert known is not None
    if known.surface is not None:
        assert bounds.lower <= known.surface.segments <= bounds.upper


@pytest.mark.parametrize(
    "path",
    sorted((INSTANCES / "scenes" / "feasibility").glob("*.surface.json"))
    + sorted((INSTANCES / "random").glob("*.surface.json")),
    ids=lambda path: path.name.partition(".")[0],
)
def test_minima_found_elsewhere(path: Path) -> None:
    """With all the time it needs the range ends at or below the paper's known minimum."""
    surface = LabelledSurface.read(path)
    bounds = proven_range(surface, time_limit=None)
    assert bounds.lower <= bounds.upper <= surface.meta["known_paper_segments"]


def test_the_papers_search_space_is_not_the_measure() -> None:
    """A correct plan has 2 segments where the paper's search space has nothing below 3."""
    surface = LabelledSurface.read(CORRIDORS)
    verdict = judge(surface, halves(surface))
    assert (verdict.segments, verdict.lift_offs, verdict.optimal) == (2, 1, True)
    assert verdict.bounds == ProvenRange(2, 2)
    assert verdict.bounds.exact


def test_cracks_count() -> None:
    """Equal colors on both sides of a crack are two segments, and no plan does better."""
    surface = LabelledSurface.read(PAPER / "crack-separates.surface.json")
    verdict = judge(surface, Plan((RED,) * len(surface.vertices)))
    assert (verdict.segments, verdict.optimal) == (2, True)


def test_what_is_not_proved_is_not_called_optimal() -> None:
    """Three segments are the minimum here, but no bound for any division says more than two."""
    surface = LabelledSurface.read(PAPER / "figeasycell4.surface.json")
    bounds = ProvenRange(2, 3)
    plan = Plan(tuple(colors[0] for colors in surface.vertex_colors))
    verdict = judge(surface, plan, bounds=bounds)
    assert (verdict.segments, verdict.optimal, verdict.beatable_by) == (3, None, None)


@given(st.integers(1, 9), st.integers(0, 9), st.integers(0, 9))
def test_beatable_by_is_what_is_proved(segments: int, lower: int, more: int) -> None:
    """Against every number that the minimum may still be."""
    assume(lower <= segments)
    verdict = Verdict((), segments, ProvenRange(lower, lower + more))
    possible = [m for m in range(lower, lower + more + 1) if m <= segments]
    fewer = {segments - minimum for minimum in possible}
    if verdict.beatable_by is None:
        assert 0 in fewer and len(fewer) > 1 and verdict.optimal is None
    else:
        assert verdict.beatable_by == min(fewer)
        assert (verdict.beatable_by == 0) == (verdict.optimal is True)


def test_no_time_passes_for_nothing() -> None:
    """A plan with as many segments as cells: the time ends before anything better is found."""
    row = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})
    worst = Plan((RED, RED, BLUE, BLUE, RED, RED) * 3)
    verdict = judge(row, worst, time_limit=1e-9)
    assert (verdict.segments, verdict.optimal, verdict.beatable_by) == (3, None, None)


def test_no_time_at_all() -> None:
    """Both ends hold however early the search ends."""
    bounds = proven_range(LabelledSurface.read(CORRIDORS), time_limit=1e-9)
    assert bounds.lower <= 2 <= bounds.upper


def test_no_time_for_the_graph() -> None:
    """The range is known from the vertices alone, and the right one."""
    surface = drawn("AA.AA AA.BB", {"A": [0], "B": [0, 1], ".": []})
    bounds = proven_range(surface, time_limit=1e-9)
    assert bounds.lower == 1 and bounds.upper == 8
    assert proven_range(drawn("... ...", {".": []}), time_limit=1e-9) == ProvenRange(0, 0)


class _Clock:
    """What ``time.monotonic`` says while time passes only where a test lets it."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.mark.parametrize(
    ("after_search", "expected"), [(59.0, ["paper"]), (57.0, ["paper", "surface"])]
)
def test_no_second_search_for_which_there_is_no_time(
    after_search: float, expected: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of 60 s the graph takes 2, and so does the first division of any search."""
    clock, searches = _Clock(), list[str]()
    monkeypatch.setattr(time, "monotonic", clock)

    def decomposition_of(surface: LabelledSurface, _: None, deadline: Deadline) -> Decomposition:
        clock.now += 2
        return cellcolor.decomposition.decomposition_of(surface, None, deadline)

    def solve(instance: Instance, options: Options) -> Solution:
        searches.append(options.search_space)
        found = cellcolor.solvers.checked.solve(instance, replace(options, deadline=NEVER))
        clock.now = after_search
        return replace(found, surface_lower_bound=1)

    monkeypatch.setattr(cellcolor.oracle.ranges, "decomposition_of", decomposition_of)
    monkeypatch.setattr(cellcolor.oracle.ranges, "solve", solve)
    proven_range(LabelledSurface.read(CORRIDORS), time_limit=60.0)
    assert searches == expected


def test_nothing_reachable() -> None:
    surface = drawn("... ...", {".": []})
    verdict = judge(surface, Plan((None,) * 6))
    assert (verdict.segments, verdict.lift_offs, verdict.optimal) == (0, 0, True)


def test_contradiction_is_an_error() -> None:
    surface = drawn("AA AA", {"A": [RED]})
    with pytest.raises(BeatenBound) as found:
        judge(surface, Plan((RED,) * 4), bounds=ProvenRange(2, 5))
    assert (found.value.segments, found.value.lower) == (1, 2)


@examples(15)
@given(surfaces(), st.data())
def test_no_plan_beats_the_lower_bound(surface: LabelledSurface, data: st.DataObject) -> None:
    choices = [st.sampled_from(colors) if colors else st.none() for colors in surface.vertex_colors]
    plan = Plan(data.draw(st.tuples(*choices)))
    verdict = judge(surface, plan)
    assert verdict.segments is not None
    assert verdict.bounds is not None
    assert verdict.segments >= verdict.bounds.lower
    assert verdict.optimal in (
        (True,) if verdict.segments == verdict.bounds.lower else (False, None)
    )


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """What it prints; its JSON is in tests/cli/test_check_json.py."""
    (tmp_path / "plan.json").write_text(halves(LabelledSurface.read(CORRIDORS)).to_json())
    assert main(["check", str(CORRIDORS), str(tmp_path / "plan.json")]) == 0
    out = capsys.readouterr().out
    assert "  2 segments, 1 lift-off, optimal: no division of the surface has fewer, because" in out


@pytest.mark.parametrize("ends", [(7, 5), (-1, 2), (1.0, 2), (True, 2)])
def test_a_range_is_one(ends: tuple[Any, Any]) -> None:
    with pytest.raises(InputError):
        ProvenRange(*ends)
