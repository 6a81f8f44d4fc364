"""Plans decided one after the other by the full model in their colors."""

from __future__ import annotations

from itertools import product

import pytest
from exhaustive_minima import literal_minimum, minimum
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES
from rooms import hub, planner_of

from cellcolor.data.bounds import greatest
from cellcolor.data.instance import Instance
from cellcolor.data.objective import Objective
from cellcolor.deadline import NEVER, Deadline
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.part_search import PartSearch
from cellcolor.solvers.cpsat.parts import split
from cellcolor.solvers.cpsat.routes.segment_plans import Planner
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE = 0, 1

EFFORT = 100.0


def searches(instance: Instance, options: Options | None = None) -> list[PartSearch]:
    """The parts of an instance in all colors, covered."""
    options = options or Options(workers=1)
    own = tuple(frozenset(cell.colors) for cell in instance.cells)
    found = [
        PartSearch(part, options, Runner(options), lambda: None) for part in split(instance, own)
    ]
    for search in found:
        search.cover(NEVER)
    return found


@examples(40)
@given(seed=st.integers(0, 10**6), cells=st.integers(2, 8), colors=st.integers(2, 4))
def test_plans_decided_one_by_one_come_to_the_minimum(seed: int, cells: int, colors: int) -> None:
    """Against brute force."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    assert decided(searches(instance)) == minimum(instance)


def decided(parts: list[PartSearch]) -> int:
    """What the parts come to by plans decided one by one: no routes, no model of the whole."""
    for part in parts:
        part.planning._route = lambda *_: None  # type: ignore[method-assign]
        part.planning.planner = Planner(
            part.instance,
            part.regions,
            part.cover_bound,
            part.planning._solve_plan,
            costs=part.costs,
            at_once=True,
        )
        part.planning.decide(part.models.draw, NEVER)
        assert part.segments == part.bound
    return sum(part.bound for part in parts)


@examples(15)
@given(seed=st.integers(0, 10**6), costs=st.tuples(*[st.integers(1, 4)] * 3))
def test_with_costs_they_come_to_the_least_cost(seed: int, costs: tuple[int, ...]) -> None:
    """Against every division, literally."""
    instance = planar_graph(seed, 3, 4, 3)
    objective = Objective(dict(zip(instance.colors, costs, strict=False)))
    parts = searches(instance, Options(workers=1, objective=objective))
    assert decided(parts) == literal_minimum(instance, costs)


@examples(10)
@given(seed=st.integers(0, 10**6), cells=st.integers(2, 7))
def test_with_two_corridors_they_come_to_the_minimum_of_the_depth_first_search(
    seed: int, cells: int
) -> None:
    instance = planar_graph(seed, cells, cells + 3, 3)
    wide = Options(workers=1, search_space="surface", strands=2)
    assert decided(searches(instance, wide)) == solve(instance, wide, "dfs-cover").segments


@pytest.mark.parametrize(
    ("quota", "drawn"),
    [
        # Either color may join its two petals in the hub, and the others are one segment each.
        ({RED: 1, BLUE: 2}, True),
        ({RED: 2, BLUE: 1}, True),
        ({RED: 2, BLUE: 2}, True),
        ({RED: 1, BLUE: 1}, False),
    ],
)
def test_what_keeps_to_a_quota_is_drawn(quota: dict[int, int], drawn: bool) -> None:
    (part,) = searches(hub(RED, BLUE, RED, BLUE))
    planner = planner_of(part.instance)
    part.raise_to(3, for_surface=True)
    own = {region: quota[region[0]] for region in color_regions(part.instance)}
    assert part.models.draw(planner, own, EFFORT, NEVER) is drawn


@examples(30)
@given(
    seed=st.integers(0, 10**6),
    most=st.lists(st.integers(0, 2), min_size=12, max_size=12),
    more=st.integers(0, 2),
)
def test_plans_keep_to_no_quota_that_was_refused(seed: int, most: list[int], more: int) -> None:
    """And if there is no plan then, each cover of that size keeps to one of them."""
    instance = planar_graph(seed, 7, 10, 3)
    planner = planner_of(instance)
    regions = color_regions(instance)
    refused = [
        {region: number for region, number in zip(regions, numbers, strict=False) if number}
        for numbers in (most[:6] + most[6:], most[6:] + most[:6])
    ]
    fewest = next(n for n in range(1, 20) if planner.plan(n, 0) is not None)
    plan = planner.plan(fewest + more, 0, refused=refused)
    if plan is not None:
        used = planner.quota
        assert sum(used.values()) == fewest + more
        assert {segment.region for segment in plan} <= used.keys()
        assert all(any(used[r] > quota.get(r, 0) for r in used) for quota in refused)
        return
    every = {cell.id for cell in instance.cells}
    for counts in product(range(fewest + more + 1), repeat=len(regions)):
        if sum(counts) != fewest + more:
            continue
        used_cells = {c for (_, cells), n in zip(regions, counts, strict=True) if n for c in cells}
        if used_cells == every:
            kept = [
                all(n <= quota.get(r, 0) for r, n in zip(regions, counts, strict=True))
                for quota in refused
            ]
            assert any(kept)


def test_a_quota_grows_with_the_plans_that_cannot_be_drawn() -> None:
    """On this double torus, 153 choices of regions cover all cells. A handful of models decide."""
    instance = Instance.read(INSTANCES / "hard" / "large_double_torus_1.json")
    asked = []
    for part in searches(instance):
        part.planning.route(NEVER)

        def draw(planner, quota, effort, deadline, part=part):  # type: ignore[no-untyped-def]
            asked.append(quota)
            return part.models.draw(planner, quota, effort, deadline)

        part.planning.decide(draw, Deadline.after(60))
        assert part.done
    assert len(asked) < 30


def test_a_limit_of_corridors_proves_nothing_for_the_surface() -> None:
    """With two corridors across an edge six segments are enough for this surface, with one seven:
    what models in the colors of plans prove is true in their search space only."""
    instance = Instance.read(INSTANCES / "hard" / "large_double_torus_1.json")
    solution = solve(instance, Options(deadline=Deadline.after(60), workers=1))
    assert (solution.status, solution.segments) == ("optimal", 7)
    assert greatest(solution.bounds or (), "surface") == 6
    wide = solve(instance, Options(deadline=Deadline.after(60), search_space="surface", workers=1))
    assert (wide.status, wide.segments) == ("optimal", 6)


def test_what_is_not_decided_is_not_refused() -> None:
    """In all colors of this part the model decides nothing in a hundredth of a second."""
    instance = Instance.read(INSTANCES / "hard" / "large_double_torus_1.json")
    part = max(searches(instance), key=lambda part: len(part.cells))
    quota = dict.fromkeys(part.regions, part.bound)
    assert part.models.draw(planner_of(part.instance), quota, 0.01, NEVER) is None
