"""Segments left out: what comes of it is a legal division with fewer of them."""

from __future__ import annotations

from itertools import pairwise

import pytest
from dart_graphs import graph_of
from examples import examples
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from petals import hub

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import planar_graph, voronoi
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, division_of
from cellcolor.solvers.cpsat.routes.dropping import drop_segments

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


def test_a_surface_with_holes_and_cracks() -> None:
    surface = voronoi(1, "annulus", 12, 20, 6, scattered=True, cracks=2, holes=2)
    found = numbers(decompose(surface), 0)
    assert len(found) > 1


def test_no_time_leaves_what_there_was() -> None:
    assert len(numbers(hub(0, 1, 0, 1), 0, Deadline.after(0))) == 1
