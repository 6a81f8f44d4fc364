"""Links in a cell, held against all ways to group its darts."""

from __future__ import annotations

from itertools import chain

from exhaustive_minima import noncrossing
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.solvers.bounds.grouping import best_grouping
from examples import examples

COLORS = st.frozensets(st.integers(0, 3), min_size=1, max_size=3)


@examples(40)
@given(st.lists(COLORS, min_size=1, max_size=8))
def test_no_groups_have_more_links(colors: list[frozenset[int]]) -> None:
    """The links of a group are one fewer than its darts; all of these have one color in common."""
    allowed = {
        frozenset(map(frozenset, groups)): sum(len(group) - 1 for group in groups)
        for groups in noncrossing(len(colors))
        if all(frozenset.intersection(*(colors[dart] for dart in group)) for group in groups)
    }
    found = best_grouping(colors)
    assert sorted(chain(*(darts for _, darts in found))) == list(range(len(colors)))
    assert all(color in colors[dart] for color, darts in found for dart in darts)
    assert allowed[frozenset(frozenset(darts) for _, darts in found)] == max(allowed.values())
