"""The oracle: never says more than is proved, never less than is known."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from library import PAPER
from meshes import drawn

from cellcolor import judge, proven_range
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import BeatenBound, InputError
from cellcolor.oracle import ProvenRange, Verdict

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


def test_no_time_for_the_graph() -> None:
    """The range is known from the vertices alone, and the right one."""
    surface = drawn("AA.AA AA.BB", {"A": [0], "B": [0, 1], ".": []})
    bounds = proven_range(surface, time_limit=1e-9)
    assert bounds.lower == 1 and bounds.upper == 8
    assert proven_range(drawn("... ...", {".": []}), time_limit=1e-9) == ProvenRange(0, 0)


def test_contradiction_is_an_error() -> None:
    surface = drawn("AA AA", {"A": [RED]})
    with pytest.raises(BeatenBound) as found:
        judge(surface, Plan((RED,) * 4), bounds=ProvenRange(2, 5))
    assert (found.value.segments, found.value.lower) == (1, 2)


@pytest.mark.parametrize("ends", [(7, 5), (-1, 2), (1.0, 2), (True, 2)])
def test_a_range_is_one(ends: tuple[Any, Any]) -> None:
    with pytest.raises(InputError):
        ProvenRange(*ends)
