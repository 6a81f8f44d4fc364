"""Links in hubs: held against all non-crossing partitions, and the bound against all divisions."""

from __future__ import annotations

import rooms
from exhaustive_minima import minimum
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES

import cellcolor
from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.color_regions import regions_of_cells
from cellcolor.checker.hubs import Hubs
from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.lab.families import hub, hub_grid, hub_with_loops, planar_graph
from cellcolor.lab.families.hubs import hub_minimum
from cellcolor.solvers.bounds.hubs import best_grouping, hub_bound
from examples import examples

SEEDS = st.integers(0, 10**6)
COLORS = st.frozensets(st.integers(0, 3), min_size=1, max_size=3)


def wheel(*petals: frozenset[int]) -> Instance:
    """A cell with four colors and a petal on each of its edges, with the colors given."""
    around = rooms.petal_cells(*(tuple(sorted(own)) for own in petals))
    return rooms.graph((range(4), range(1, len(petals) + 1)), *around)


@examples(40)
@given(st.lists(COLORS, min_size=1, max_size=8))
def test_the_checker_counts_the_same_links(colors: list[frozenset[int]]) -> None:
    instance = wheel(*colors)
    tried = []
    hubs = Hubs(instance, regions_of_cells(instance), [0])
    assert hubs.links(0, lambda: tried.append(1)) == best_grouping(colors).links


@examples(12)
@given(seed=SEEDS, petals=st.integers(4, 30), colors=st.integers(3, 6))
def test_a_single_hub_is_bounded_by_its_minimum(seed: int, petals: int, colors: int) -> None:
    instance = hub(seed, petals, colors)
    ring = [cell.colors[0] for cell in instance.cells[1:]]
    assert hub_bound(instance).value == hub_minimum(ring)


@examples(10)
@given(seed=SEEDS, colors=st.integers(2, 3))
def test_no_division_has_fewer_segments(seed: int, colors: int) -> None:
    for instance in (planar_graph(seed, 4, 8, colors), hub_grid(seed, 1, 2, 3, 1)):
        assert hub_bound(instance).value <= minimum(instance)


def test_an_edge_that_two_corridors_may_cross_makes_no_hub() -> None:
    """With one corridor an edge three segments are needed here, with two of them two."""
    instance = Instance.read(INSTANCES / "paper" / "parallel-corridors.json")
    assert hub_bound(instance).value <= 2


def test_minima_of_hubs_and_grids_are_verified() -> None:
    for instance in (hub(3, 24, 4), hub_grid(0, 2, 2, 4, 3), hub_with_loops(0, 4, 4, 4)):
        solution = cellcolor.solve(instance).solution
        bound = max(solution.bounds or (), key=lambda bound: bound.value)
        assert (bound.kind, bound.value) == ("hubs", solution.segments)
        assert verify_bound(instance, bound, regions_of_cells(instance)).outcome == "verified"


def part(value: int, cells: list[int], hubs: list[int]) -> Bound:
    """A bound by one part with hubs."""
    document = {"value": value, "cells": cells, "conflicts": [], "hubs": hubs}
    return Bound("hubs", value, "surface", {"left_out": [], "parts": [document]})


@examples(12)
@given(seed=SEEDS, data=st.data())
def test_nothing_false_is_verified(seed: int, data: st.DataObject) -> None:
    """Any cells and hubs, for one segment more than some division has."""
    instance = planar_graph(seed, 4, 8, 3)
    assume(instance.most_live_darts <= 8)  # more take minutes to try all divisions of
    numbers = range(len(instance.cells))
    hubs = data.draw(st.lists(st.sampled_from(numbers), unique=True, max_size=2))
    chosen = [cell for cell in numbers if cell not in hubs]
    claim = part(minimum(instance) + 1, chosen, hubs)
    assert verify_bound(instance, claim, regions_of_cells(instance)).outcome == "refused"


def test_what_is_no_hub_is_refused_with_its_reason() -> None:
    a, b, both = frozenset({0}), frozenset({1}), frozenset({0, 1})
    instance = wheel(a, b, a, b)
    regions = regions_of_cells(instance)
    cases = [
        (part(3, [1, 2, 3, 4], [0]), "verified", ""),
        (part(4, [1, 2, 3, 4], [0]), "refused", "fewer than 5 color regions touch all"),
        (part(3, [0, 1, 2, 3, 4], [0]), "refused", "hub 0 is to be touched"),
        (part(3, [2, 3, 4], [0, 1]), "refused", "shares edge 1 with a hub"),
        (part(3, [1, 2, 3, 4], [7]), "refused", "there is no cell 7"),
        (part(3, [1, 2, 3, 4], []), "refused", "fewer than 3 color regions touch all"),
    ]
    for claim, outcome, reason in cases:
        verdict = verify_bound(instance, claim, regions)
        assert verdict.outcome == outcome and reason in verdict.reason
    # Two cells with an edge for two colors between them, each with a petal.
    cells = [(both, (1, 2)), (both, (-1, 3)), (a, (-2,)), (b, (-3,))]
    wide = rooms.graph(*((sorted(own), loop) for own, loop in cells))
    verdict = verify_bound(wide, part(1, [2, 3], [0]), regions_of_cells(wide))
    assert verdict.reason == "edge 1 of hub 0 may be crossed more than once"
