"""Segment plans respect separating pairs, and every division is one."""

from __future__ import annotations

import pytest
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from ortools.sat.python import cp_model
from rooms import hub, hub_with_a_hole

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.bounds.cover import Region, color_regions, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.segment_plans import Planner, SegmentPlan
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE, GREEN = 0, 1, 2

SEEDS = st.integers(0, 10**6)


def planner_of(instance: Instance) -> Planner:
    return Planner(instance, color_regions(instance), set_cover(color_regions(instance)).bound)


def one_worker(model: cp_model.CpModel) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    return solver, solver.solve(model)


def fewest_planned(instance: Instance) -> tuple[int, SegmentPlan]:
    """The fewest segments for which there is a plan in which none are known to cross."""
    planner = planner_of(instance)
    segments = set_cover(color_regions(instance)).bound
    while True:
        plan = planner.plan(segments, one_worker)
        if plan is None:
            segments += 1
        elif not planner.find_separations(plan, NEVER):
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
def test_plans_respect_separations(petals: tuple[int, ...], segments: int) -> None:
    fewest, plan = fewest_planned(hub(*petals))
    assert len(plan) == fewest == segments == minimum(hub(*petals))
    assert set().union(*(cells for _, cells in plan)) == set(range(len(petals) + 1))


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(2, 3))
def test_what_cannot_be_planned_cannot_be_painted(seed: int, cells: int, colors: int) -> None:
    """Against brute force, which paints with one strand, and the DFS with two."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    fewest, plan = fewest_planned(instance)
    assert set_cover(color_regions(instance)).bound <= fewest <= minimum(instance)
    wide = solve(instance, Options(search_space="surface", strands=2), "dfs-cover")
    assert wide.segments is not None
    assert fewest <= wide.segments
    for cell in instance.cells:
        assert sum(cell.id in cells for _, cells in plan) == 1
    assert all(cells <= region[1] for region, cells in plan)


def test_a_refuted_plan_does_not_come_again() -> None:
    """Not even with a segment that touches nothing of its own: with one more than a smallest cover
    has, each set of regions is refuted once, until none is left."""
    instance = hub_with_a_hole()
    planner, segments = planner_of(instance), set_cover(color_regions(instance)).bound + 1
    seen: list[frozenset[Region]] = []
    while planner.plan(segments, one_worker) is not None:
        seen.append(frozenset(planner.regions_in_use))
        assert len(seen) == len(set(seen))
        planner.refute(segments)
    assert seen


def test_no_time() -> None:
    planner = planner_of(hub(RED, BLUE, RED, BLUE))
    plan = planner.plan(2, one_worker)
    assert plan is not None
    with pytest.raises(OutOfTime):
        planner.find_separations(plan, Deadline.after(-1))
