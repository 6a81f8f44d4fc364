"""Segment plans heed conflicts, and every division is one."""

from __future__ import annotations

import pytest
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from rooms import graph, hub, petal_cells, planner_of

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.bounds.cover import set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.routes import segment_plans
from cellcolor.solvers.cpsat.routes.segment_plans import SegmentPlan, Undecided
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE, GREEN = 0, 1, 2

SEEDS = st.integers(0, 10**6)


def fewest_planned(instance: Instance, avoiding: bool = False) -> tuple[int, SegmentPlan]:
    """The fewest segments for which there is a plan without conflicts and tangles."""
    planner = planner_of(instance)
    segments = set_cover(instance).bound
    while True:
        plan = planner.plan(segments, 0)
        if plan is None:
            segments += 1
        elif not planner.find_conflicts(plan, NEVER, avoiding=avoiding):
            return segments, plan


@pytest.mark.parametrize(
    ("petals", "segments"),
    [
        ((RED, RED, BLUE), 2),
        ((RED, BLUE, RED, BLUE), 3),
        # Both red or both blue petals meet in the hub, and the green one is alone.
        ((RED, BLUE, GREEN, RED, BLUE), 4),
        # Three of one color meet, the others are three segments.
        ((RED, BLUE, RED, BLUE, RED, BLUE), 4),
    ],
)
def test_plans_heed_conflicts(petals: tuple[int, ...], segments: int) -> None:
    fewest, plan = fewest_planned(hub(*petals))
    assert len(plan) == fewest == segments == minimum(hub(*petals))
    assert set().union(*(s.cells for s in plan)) == set(range(len(petals) + 1))


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(2, 3), avoiding=st.booleans())
def test_what_cannot_be_planned_cannot_be_painted(
    seed: int, cells: int, colors: int, avoiding: bool
) -> None:
    """Against brute force, which paints with one strand, and the DFS with two."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    fewest, plan = fewest_planned(instance, avoiding)
    assert set_cover(instance).bound <= fewest <= minimum(instance)
    wide = solve(instance, Options(search_space="surface", strands=2), "dfs-cover")
    assert wide.segments is not None
    assert fewest <= wide.segments
    for cell in instance.cells:
        assert sum(cell.id in segment.cells for segment in plan) == 1
    assert all(segment.cells <= segment.region[1] for segment in plan)


def test_plans_heed_what_segments_do_not_touch() -> None:
    """Blue can join the petals 3 and 6 only if red, that joins 2 and 4, has petal 6 as well. Then
    red would part both green petals, too."""
    instance = hub(GREEN, RED, (BLUE, GREEN), RED, GREEN, (RED, BLUE))
    assert fewest_planned(instance)[0] == 3
    assert fewest_planned(instance, avoiding=True)[0] == 4 == minimum(instance)


@examples(10)
@given(
    petals=st.lists(
        st.sampled_from([RED, BLUE, GREEN, (RED, BLUE), (BLUE, GREEN), (RED, GREEN)]),
        min_size=4,
        max_size=6,
    )
)
def test_what_segments_avoid_rules_out_no_division(petals: list[int | tuple[int, ...]]) -> None:
    """Around a hub, where one time in ten it makes a difference, against brute force."""
    instance = hub(*petals)
    assert fewest_planned(instance)[0] <= fewest_planned(instance, avoiding=True)[0]
    assert fewest_planned(instance, avoiding=True)[0] <= minimum(instance)


def test_more_partings_are_heeded_where_there_is_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Around a hub of two colors in turn: undecided at first, then the bound rises as ever."""
    planner = planner_of(hub(RED, BLUE, RED, BLUE))
    plan = planner.plan(2, 0)
    assert plan is not None and planner.find_partings(plan, NEVER)
    monkeypatch.setattr(segment_plans, "MOST_PARTED", 0)
    with pytest.raises(Undecided):
        planner.plan(2, 0)
    assert planner.plan(2, 0, thoroughly=True) is None


def test_segments_are_told_apart_where_a_plan_has_several(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two hubs side by side: that one of them is too few is seen in a model of one copy each."""
    one = petal_cells(RED, BLUE, RED, BLUE)
    other = [((colors[0] + 2,), (loop[0] - 4,)) for colors, loop in one]
    hubs = ((RED, BLUE), (1, 2, 3, 4)), ((RED + 2, BLUE + 2), (5, 6, 7, 8))
    planner = planner_of(graph(*hubs, *one, *other))
    while (plan := planner.plan(4, 0)) is not None:
        assert planner.find_partings(plan, NEVER)
    size = sum(2 + len(parting.groups) for _, _, parting in planner.partings)
    monkeypatch.setattr(segment_plans, "MOST_PARTED", size)
    assert planner.plan(5, 0) is None
    with pytest.raises(Undecided):
        planner.plan(6, 0)
    monkeypatch.undo()
    assert len(planner.plan(6, 0) or ()) == 6
