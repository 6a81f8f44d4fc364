"""Segments left out: what comes of it is a legal division with fewer of them."""

from __future__ import annotations

from itertools import pairwise

import pytest
from dart_graphs import graph_of
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from rooms import graph, hub

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import planar_graph, voronoi
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.painting import (
    Block,
    Painting,
    canonical,
    division_of,
    segments_of,
)
from cellcolor.solvers.cpsat.routes.dropping import drop_segments
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import held_nodes, painting_of_nodes, refined
from cellcolor.solvers.cpsat.routes.segment_plans import PlannedSegment
from examples import examples

RED, BLUE = 0, 1

SEEDS = st.integers(0, 10**6)


def numbers(instance: Instance, seed: int, deadline: Deadline = NEVER) -> list[int]:
    """Segments of every cell painted whole, and of each better division, all of them legal."""
    graph = graph_of(instance)
    whole: Painting = [[Block(min(cell.colors), set())] for cell in instance.cells]
    start = canonical(graph, whole)
    regions = color_regions(instance)
    found = []
    for painting in [start, *drop_segments(graph, start, regions, seed, deadline)]:
        report = check_division(instance, division_of(graph, painting), seams=graph.seams)
        assert report.valid, report.problems
        found.append(report.segments)
    return found


@examples(20)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4))
def test_each_division_is_legal_and_better(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 4, colors)
    found = numbers(instance, seed)
    assert all(after < before for before, after in pairwise(found))
    assert found[-1] >= minimum(instance)


@pytest.mark.parametrize("petals", [(0, 1, 0, 1), (0, 1, 0, 1, 0, 1), (0, 1, 2, 0, 1, 2)])
def test_a_segment_that_others_can_do_without_goes(petals: tuple[int, ...]) -> None:
    """Each petal alone to begin with, save those of the hub's color."""
    assert numbers(hub(*petals), 0)[-1] == minimum(hub(*petals))


@pytest.mark.parametrize("seed", range(3))
def test_two_colors_take_the_place_of_three(seed: int) -> None:
    """Three colors have two cells of a row of six each, and two others have three each.

    Painted in the three, no segment can be left out, not even for one of the other colors.
    """
    colors = (0, 3), (0, 3), (1, 3), (1, 4), (2, 4), (2, 4)
    around = (1,), (-1, 2), (-2, 3), (-3, 4), (-4, 5), (-5,)
    row = graph(*zip(colors, around, strict=True))
    assert numbers(row, seed) == [3, 2]


def test_a_surface_with_holes_and_cracks() -> None:
    surface = voronoi(1, "annulus", 12, 20, 6, scattered=True, cracks=2, holes=2)
    found = numbers(decompose(surface), 0)
    assert len(found) > 1


def test_no_time_leaves_what_there_was() -> None:
    assert len(numbers(hub(0, 1, 0, 1), 0, Deadline.after(0))) == 1


@examples(40)
@given(seed=SEEDS, cells=st.integers(1, 12), colors=st.integers(1, 5), rings=st.integers(0, 2))
def test_what_a_division_holds_is_a_division_again(
    seed: int, cells: int, colors: int, rings: int
) -> None:
    """Each node is held once, in one of its cell's colors; drawn again there are no more segments.

    That is so where no two sub-cells of a cell need its center, as in what was routed.
    """
    instance = planar_graph(seed, cells, cells + 6, colors)
    graph = graph_of(instance)
    regions = color_regions(instance)
    plan = tuple(PlannedSegment(region, region[1]) for region in regions)
    ways = refined(graph, 1)
    routed = canonical(graph, route(ways, plan, 5, seed))
    ways = refined(graph, max(rings, 1))
    held = held_nodes(ways, routed)
    node_colors = [-1] * len(ways.cell)
    for color, nodes in held:
        for node in nodes:
            assert node_colors[node] == -1
            node_colors[node] = color
            assert color in graph.colors[ways.cell[node]]
    again = canonical(graph, painting_of_nodes(ways, node_colors))
    assert len(segments_of(graph, again)) <= len(segments_of(graph, routed))


def test_routes_begin_with_what_is_held() -> None:
    """Before any round the blue petals are connected; without that the hub is red."""
    instance = hub(RED, BLUE, RED, BLUE)
    graph = graph_of(instance)
    red, blue = color_regions(instance)
    plan = tuple(
        PlannedSegment(region, frozenset(cells))
        for region, cells in ((red, {1}), (red, {3}), (blue, {0, 2, 4}))
    )
    ways = refined(graph, 1)
    held = [{node for cell in segment.cells for node in ways.nodes[cell]} for segment in plan]
    assert {0, 2, 4} in segments_of(graph, route(ways, plan, 0, 0, NEVER, held))
    assert {0, 1, 3} in segments_of(graph, route(ways, plan, 0, 0))
