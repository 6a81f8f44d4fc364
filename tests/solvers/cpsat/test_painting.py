"""Paintings and their canonical form, the scheme."""

from __future__ import annotations

from random import Random

import holes
import pytest
from dart_graphs import graph_of
from hypothesis import given
from hypothesis import strategies as st
from rooms import graph as cells_of
from rooms import hub, petal_cells

from cellcolor.checker.division import check_division, check_scheme
from cellcolor.data.instance import Instance
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.cpsat import painting as paintings
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.cpsat.painting import Block, Painting, canonical, division_of, segments_of
from cellcolor.solvers.cpsat.sectors import painting_of_sectors, sector_graph
from examples import examples

RED, BLUE = 0, 1

SEEDS = st.integers(0, 10**6)


def at_random(graph: DartGraph, seed: int) -> Painting:
    """Every sector in any color of its cell.

    A few colors are preferred, so that sub-cells have some darts.
    """
    rng = Random(seed)
    sectors = sector_graph(graph)
    preferred = [rng.random() for _ in range(1 + max(map(max, graph.colors)))]
    colors = [
        rng.choices(own := sorted(graph.colors[cell]), [preferred[c] for c in own])[0]
        for cell in sectors.cell
    ]
    return painting_of_sectors(sectors, colors)


@examples(40)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(1, 4))
def test_any_painting_has_a_scheme(seed: int, cells: int, colors: int) -> None:
    """With no more segments than what it is made of."""
    instance = planar_graph(seed, cells, cells + 4, colors)
    graph = graph_of(instance)
    painting = at_random(graph, seed)
    segments = len(segments_of(graph, painting))
    found = canonical(graph, painting)
    report = check_division(instance, division_of(graph, found))
    assert report.is_scheme, (report.problems, report.not_canonical)
    assert report.segments is not None and report.segments <= segments


BOTH = RED, BLUE
SMALL = {
    "hub": hub(RED, RED, RED, RED, BLUE),
    "two loops": cells_of((BOTH, (1, 2), (3, 4)), *petal_cells(RED, RED, RED, RED)),
    "one in a hole": cells_of((BOTH, (1, 2, 3), (4,)), *petal_cells(RED, BLUE, RED, BOTH)),
}


def every_division_becomes_a_scheme(instance: Instance) -> bool:
    """With no more segments, as docs/semantics/schemes.md says of any division."""
    graph = dart_graph(instance, dict.fromkeys(instance.live_edges, 1), None)
    for division in holes.divisions(instance):
        painting = [
            [
                Block(color, {graph.number_of[d, 1] for d in own})
                for color, own in sorted(cell, key=str)
            ]
            for cell in division
        ]
        found = division_of(graph, paintings.canonical(graph, painting))
        report = check_scheme(instance, found)
        if not report.is_scheme or (report.segments or 0) > holes.segments(division):
            return False
    return True


@pytest.mark.parametrize("name", SMALL)
def test_every_division_becomes_a_scheme(name: str) -> None:
    assert every_division_becomes_a_scheme(SMALL[name])
