"""Local search: what comes of it is a legal division with fewer segments, counted right."""

from __future__ import annotations

from itertools import pairwise
from random import Random

import networkx as nx
import pytest
from dart_graphs import graph_of
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from rooms import hub

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.local_search import Recoloring, recolor
from cellcolor.solvers.cpsat.painting import (
    Block,
    Painting,
    canonical,
    division_of,
)
from cellcolor.solvers.cpsat.sectors import SectorGraph, sector_colors, sector_graph
from examples import examples

SEEDS = st.integers(0, 10**6)


def whole(instance: Instance) -> Painting:
    """Every cell painted in the first of its colors."""
    painting: Painting = [[Block(min(cell.colors), set())] for cell in instance.cells]
    return canonical(graph_of(instance), painting)


def numbers(instance: Instance, seed: int, enough: int = 0) -> list[int]:
    """Segments of every cell painted whole, and of each better division, all of them legal."""
    graph, start, regions = graph_of(instance), whole(instance), color_regions(instance)
    found = []
    for painting in [start, *recolor(graph, regions, start, Random(seed), enough, NEVER, 30)]:
        report = check_division(instance, division_of(graph, painting), seams=graph.seams)
        assert report.valid, report.problems
        found.append(report.segments)
    return found


def components(sectors: SectorGraph, colors: list[int]) -> int:
    """The connected sectors of one color, by another program."""
    painted = nx.Graph()
    painted.add_nodes_from(range(len(colors)))
    for node, (beside, across) in enumerate(zip(sectors.beside, sectors.across, strict=True)):
        joined = [*beside, *(other for other, joinable in across if colors[node] in joinable)]
        painted.add_edges_from((node, other) for other in joined if colors[node] == colors[other])
    return nx.number_connected_components(painted)


@examples(30)
@given(seed=SEEDS, cells=st.integers(1, 6), colors=st.integers(1, 4))
def test_each_division_is_legal_and_better(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 4, colors)
    found = numbers(instance, seed)
    assert all(after < before for before, after in pairwise(found))
    assert found[-1] >= minimum(instance)


@examples(40)
@given(
    seed=SEEDS, cells=st.integers(2, 25), colors=st.integers(2, 6), rings=st.sampled_from((0, 1, 2))
)
def test_segments_are_counted_right(seed: int, cells: int, colors: int, rings: int) -> None:
    """However segments came apart and together, there are as many as another program counts."""
    instance = planar_graph(seed, cells, 2 * cells, colors)
    graph = graph_of(instance)
    sectors = sector_graph(graph, rings)
    start = sector_colors(sectors, whole(instance))
    search = Recoloring(sectors, color_regions(instance), start, Random(seed))
    for _ in range(60):
        search.move()
        assert all(
            color in graph.colors[cell]
            for color, cell in zip(search.current, sectors.cell, strict=True)
        )
        assert search.segments == components(sectors, search.current)
        assert search.fewest <= search.segments
    assert search.fewest == components(sectors, search.best)


def test_few_enough_segments_end_it() -> None:
    instance = planar_graph(3, 25, 50, 5)
    first, second, *_ = numbers(instance, 0)
    assert numbers(instance, 0, enough=first) == [first]
    assert numbers(instance, 0, enough=second) == [first, second]


def test_no_time_leaves_what_there_was() -> None:
    instance = hub(0, 1, 0, 1)
    graph, start, regions = graph_of(instance), whole(instance), color_regions(instance)
    with pytest.raises(OutOfTime):
        next(recolor(graph, regions, start, Random(0), 0, Deadline.after(0), 30))
