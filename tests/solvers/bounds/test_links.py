"""Links in a cell, held against everything that can be drawn in it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

from drawings import most_links_drawn, walks_and_parts
from exhaustive_minima import noncrossing
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.checker import hubs
from cellcolor.deadline import NEVER
from cellcolor.lab.families import hub_with_loops
from cellcolor.solvers.bounds.hubs import Grouping, best_grouping, joinable_colors, links_bound
from cellcolor.solvers.cpsat.hub_groups import many_links
from examples import examples

COLORS = st.frozensets(st.integers(0, 3), min_size=1, max_size=3)
LOOPS = st.lists(
    st.lists(st.integers(0, 3), min_size=1, max_size=4), min_size=2, max_size=3
).filter(lambda loops: sum(map(len, loops)) <= 8)


def check(grouping: Grouping, colors: Sequence[frozenset[int]]) -> None:
    """Each dart is in one group, in a color that it can be joined in."""
    assert sorted(chain(*(g.darts for g in grouping.groups))) == list(range(len(colors)))
    assert all(g.color in colors[dart] for g in grouping.groups for dart in g.darts)


@examples(40)
@given(st.lists(COLORS, min_size=1, max_size=8), st.data())
def test_one_loop_has_the_links_of_the_best_partition(
    colors: list[frozenset[int]], data: st.DataObject
) -> None:
    """The links of a group are one fewer than its darts; all of these have one color in common."""
    apart = data.draw(st.none() | st.integers(1, len(colors) - 1)) if len(colors) > 1 else None
    allowed = {
        frozenset(map(frozenset, groups)): sum(len(group) - 1 for group in groups)
        for groups in noncrossing(len(colors))
        if all(frozenset.intersection(*(colors[dart] for dart in group)) for group in groups)
        and not any(0 in group and apart in group for group in groups)
    }
    found = best_grouping(colors, apart)
    check(found, colors)
    assert allowed[frozenset(frozenset(g.darts) for g in found.groups)] == max(allowed.values())


def single(loops: Sequence[Sequence[int]]) -> list[list[frozenset[int]]]:
    return [[frozenset({color}) for color in loop] for loop in loops]


@examples(30)
@given(LOOPS)
def test_no_more_links_can_be_drawn_between_several_loops(loops: list[list[int]]) -> None:
    drawn = most_links_drawn(loops)
    bound = links_bound(single(loops))
    assert bound is not None and bound >= drawn
    # The checker counts by itself.
    assert hubs.most_links(loops, lambda: None) == bound


@examples(30)
@given(LOOPS, st.integers(0, 99))
def test_what_mergers_lead_to_can_be_drawn(loops: list[list[int]], seed: int) -> None:
    """By Euler's formula: points less lines plus walks round faces are two for each part."""
    colors = single(loops)
    found = many_links(colors, 0, seed, NEVER)
    check(found, list(chain(*colors)))
    groups = [group.darts for group in found.groups]
    walks, parts = walks_and_parts(loops, groups)
    assert len(loops) + len(groups) - sum(map(len, loops)) + walks == 2 * parts


def test_small_hubs_have_all_the_links_there_can_be() -> None:
    """The bound is reached, so neither of the two is in vain."""
    for seed in range(8):
        for count, petals in ((2, 4), (3, 3), (4, 4), (5, 6)):
            colors = joinable_colors(hub_with_loops(seed, count, petals, 4), 0)
            bound = links_bound(colors)
            assert bound is not None
            assert many_links(colors, bound, 0, NEVER).links == bound


def test_loops_that_no_walk_of_two_corners_connects() -> None:
    """Corners ab and ba beside ac and ca: a longer walk is needed to connect a with a."""
    assert links_bound(single([[0, 1, 0, 1], [0, 2, 0, 2]])) == 3
    assert most_links_drawn([[0, 1, 0, 1], [0, 2, 0, 2]]) == 3
    # Nothing connects these, and each has one link by itself.
    assert links_bound(single([[0, 1, 0, 1], [2, 3, 2, 3]])) == 2


def test_several_colors_beside_several_loops_are_not_counted() -> None:
    two = frozenset({0, 1})
    assert links_bound([[two, two], [two]]) is None
