"""The cost of a painting (paper, section V-A), counted in segments and taken at its word."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from reference import SOLVER, segments

from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, SubCell
from cellcolor.errors import InputError
from cellcolor.solvers.dfs import literal_cost
from cellcolor.solvers.dfs.search import SegmentCounts
from cellcolor.solvers.interface import Options


def test_literal_cost_counts_a_cycle_as_less_than_nothing() -> None:
    """Three cells around a corner, painted alike: one segment, but 3 sub-cells - 3 pairs = 0."""
    instance = Instance.read(PAPER / "triple-junction.json")
    answer = SOLVER.minimize(instance, Options())
    assert answer.division is not None
    assert segments(instance, answer) == 1
    assert literal_cost(instance, answer.division) == 0


def test_literal_cost_counts_pairs_not_edges() -> None:
    """Two cells joined across two edges are one pair ("Right" of the cost figure): 2 - 1."""
    instance = Instance.read(PAPER / "ring.json")
    division = SOLVER.minimize(instance, Options()).division
    assert division is not None
    assert sorted(len(s.darts) for cell in division for s in cell.subcells) == [0, 2, 2]
    assert literal_cost(instance, division) == 2


def test_literal_cost_refuses_another_instance() -> None:
    instance = Instance.read(PAPER / "triple-junction.json")
    with pytest.raises(InputError, match="cells"):
        literal_cost(instance, (CellDivision(0, (SubCell(0, (), 0),)),))


@given(st.lists(st.tuples(st.integers(0, 9), st.integers(0, 9)), max_size=25), st.data())
def test_segments_are_undone(joins: list[tuple[int, int]], data: st.DataObject) -> None:
    """After taking back the last joins the cost is that of the first ones alone."""
    kept = data.draw(st.integers(0, len(joins)))
    tried = SegmentCounts([1] * 11)
    for region in range(10):
        tried.add(region)
    for number, (a, b) in enumerate(joins):
        if number == kept:
            mark = tried.mark()
            late = tried.add(10)
            tried.join(late, a)
        tried.join(a, b)
    if kept < len(joins):
        tried.undo(mark)
    groups = [{i} for i in range(10)]
    for a, b in joins[:kept]:
        merged = {i for group in groups if group & {a, b} for i in group}
        groups = [group for group in groups if not group & merged] + [merged]
    assert tried.cost == len(groups)
    assert {
        frozenset(i for i in range(10) if tried.find(i) == tried.find(j)) for j in range(10)
    } == {frozenset(group) for group in groups}
