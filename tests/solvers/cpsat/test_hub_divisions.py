"""Divisions of hubs: what is drawn has as many segments as its groups."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

import cellcolor
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER
from cellcolor.lab.families import hub, hub_grid, hub_minimum, hub_with_loops
from cellcolor.solvers.bounds.hubs import hub_bound, joinable_colors, links_bound
from cellcolor.solvers.cpsat.hub_division import divide_hubs
from cellcolor.solvers.cpsat.hub_groups import many_links
from cellcolor.solvers.cpsat.painting import division_of, segments_of
from cellcolor.solvers.cpsat.parts import split
from examples import examples

SEEDS = st.integers(0, 10**6)


def divided(instance: Instance) -> int:
    """Segments of the division of all hubs; the whole instance is one part."""
    colors = [frozenset(cell.colors) for cell in instance.cells]
    part = split(instance, colors)[-1]
    assert part.cells == list(range(len(instance.cells)))
    whole = {cell: min(own) for cell, own in enumerate(colors)}
    graph, painting = divide_hubs(part, hub_bound(instance).hubs, whole, 0, NEVER)
    assert division_of(graph, painting)
    return len(segments_of(graph, painting))


@examples(10)
@given(seed=SEEDS, petals=st.integers(4, 40), colors=st.integers(3, 6))
def test_a_single_hub_is_divided_best(seed: int, petals: int, colors: int) -> None:
    instance = hub(seed, petals, colors)
    assert divided(instance) == hub_minimum([cell.colors[0] for cell in instance.cells[1:]])


@examples(10)
@given(seed=SEEDS, loops=st.integers(2, 5), petals=st.integers(3, 6), colors=st.integers(3, 5))
def test_seams_lead_through_what_is_drawn(seed: int, loops: int, petals: int, colors: int) -> None:
    """Every petal is in one group, and each group is one segment, however seams part it."""
    instance = hub_with_loops(seed, loops, petals, colors)
    own = joinable_colors(instance, 0)
    enough = links_bound(own)
    assert enough is not None
    found = many_links(own, enough, 0, NEVER)
    if instance.most_live_loops == loops and hub_bound(instance).hubs:
        assert divided(instance) == loops * petals - found.links


def test_hubs_with_several_loops_are_proved() -> None:
    """With the checker's word on each division, and its certificate verified."""
    for seed, (loops, petals) in enumerate([(2, 6), (3, 4), (4, 4), (5, 3), (6, 4)]):
        solution = cellcolor.solve(hub_with_loops(seed, loops, petals, 4), workers=1).solution
        assert solution.status == "optimal"
        best = max(solution.bounds or (), key=lambda bound: bound.value)
        assert best.kind == "cover" or best.certificate is not None


def test_petals_that_hubs_share() -> None:
    """Links of several hubs may close a circle, but the division is legal."""
    instance = hub_grid(0, 2, 3, 4, 2)
    assert divided(instance) >= hub_bound(instance).value
