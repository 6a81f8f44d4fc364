"""The cost of a painting (paper, section V-A), counted in segments and taken at its word."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st
from library import PAPER
from reference import SOLVER, segments

from cellcolor.data.cells_and_edges import twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division
from cellcolor.solvers.dfs.search import SegmentCounts
from cellcolor.solvers.interface import Options


def literal_cost(division: Division) -> int:
    """What ``Δcost = 1 - j`` adds up to when j counts distinct solved *cells*.

    Every sub-cell adds 1 and takes off the number of distinct sub-cells it joins that were painted
    before it, so that the order does not matter: the sum is the number of sub-cells less the
    number of distinct joined pairs. It is the number of segments only where no cycle of joined
    sub-cells closes.
    """
    subcells = [subcell for cell in division for subcell in cell.subcells]
    holder = {dart: number for number, own in enumerate(subcells) for dart in own.darts}
    pairs = {frozenset((one, holder[twin(dart)])) for dart, one in holder.items()}
    return len(subcells) - sum(len(pair) == 2 for pair in pairs)


def test_literal_cost_counts_a_cycle_as_less_than_nothing() -> None:
    """Three cells around a corner, painted alike: one segment, but 3 sub-cells - 3 pairs = 0."""
    instance = Instance.read(PAPER / "triple-junction.json")
    answer = SOLVER.minimize(instance, Options())
    assert answer.division is not None
    assert segments(instance, answer) == 1
    assert literal_cost(answer.division) == 0


def test_literal_cost_counts_pairs_not_edges() -> None:
    """Two cells joined across two edges are one pair ("Right" of the cost figure): 2 - 1."""
    instance = Instance.read(PAPER / "ring.json")
    division = SOLVER.minimize(instance, Options()).division
    assert division is not None
    assert sorted(len(s.darts) for cell in division for s in cell.subcells) == [0, 2, 2]
    assert literal_cost(division) == 2


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
