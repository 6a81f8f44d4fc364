"""Routes: whatever is routed is a legal division."""

from __future__ import annotations

from pathlib import Path

import pytest
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from rooms import graph, hub, petal_cells

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.solvers.bounds.cover import set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.painting import division_of
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import refined
from cellcolor.solvers.cpsat.routes.segment_plans import PlannedSegment, SegmentPlan
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE, GREEN = 0, 1, 2

SEEDS = st.integers(0, 10**6)


def whole_cover(instance: Instance) -> SegmentPlan:
    return tuple(PlannedSegment(region, region[1]) for region in set_cover(instance).regions)


def graph_of(instance: Instance) -> DartGraph:
    colors = [frozenset(cell.colors) for cell in instance.cells]
    once = {edge.id: 1 for edge in instance.edges}
    return dart_graph(instance, colors, once, seams_of(instance, colors, once, 2))


def segments_of(instance: Instance, plan: SegmentPlan, rings: int, rounds: int = 40) -> int:
    graph = graph_of(instance)
    painting = route(refined(graph, rings), plan, rounds, 0)
    report = check_division(instance, division_of(graph, painting), seams=graph.seams)
    assert report.valid, report.problems
    return report.segments


@examples(30)
@given(
    seed=SEEDS,
    cells=st.integers(1, 9),
    colors=st.integers(1, 4),
    rings=st.integers(0, 3),
    rounds=st.integers(0, 12),
)
def test_whatever_is_routed_is_legal(
    seed: int, cells: int, colors: int, rings: int, rounds: int
) -> None:
    """Also when the rounds end before the nets have found their places."""
    instance = planar_graph(seed, cells, cells + 4, colors)
    plan = whole_cover(instance)
    assert segments_of(instance, plan, rings, rounds) >= len(plan)


@pytest.mark.parametrize("seed", range(8))
def test_holes_and_cracks_are_routed_around(seed: int) -> None:
    instance = decompose(blobs(seed, size=14, colors=4, cracks=3, holes=2, islands=2))
    segments_of(instance, whole_cover(instance), 1)


def test_chords_side_by_side_need_rings() -> None:
    """Four pairs of petals, two of which are not neighbors: only one fits through the center."""
    instance = hub(0, 1, 2, 3, 3, 2, 1, 0)
    assert minimum(instance) == 4
    assert segments_of(instance, whole_cover(instance), 1) == 5
    assert segments_of(instance, whole_cover(instance), 2) == 4


def test_a_crack_is_routed_around() -> None:
    """Blue cannot go from cell 1 to cell 2 directly; in cell 4 there is room beside red."""
    instance = graph(
        ((BLUE,), (1,)),
        ((RED, BLUE), (-1, 2, 3)),
        ((RED, BLUE), (-2, 4, 5)),
        ((BLUE,), (-5,)),
        ((RED, BLUE), (-3, 6, -4)),
        ((RED,), (-6,)),
        cracks={2: (RED,)},
    )
    assert segments_of(instance, whole_cover(instance), 1) == 2


def test_what_no_route_touches_is_connected_next() -> None:
    """Cell 0, of red and blue, lies behind cells that green and gray flood at first."""
    gray = 3
    instance = graph(
        ((RED, BLUE), (1, 2)),
        ((RED, GREEN), (3, -1, 4, 5)),
        ((BLUE, gray), (6, -2, 7, 8)),
        *petal_cells(RED, BLUE, RED, GREEN, GREEN, BLUE, gray, gray)[2:],
    )
    assert segments_of(instance, whole_cover(instance), 1, rounds=1) == 5
    assert segments_of(instance, whole_cover(instance), 1) == 4


def test_the_cell_that_must_be_split_is_routed() -> None:
    instance = Instance.read(PAPER / "split-cell.json")
    assert segments_of(instance, whole_cover(instance), 1) == 2


@pytest.mark.parametrize("rings", [0, 1])
@pytest.mark.parametrize("name", ["hemisphere_tilted", "half_pipe", "wok", "wok_obstacle"])
def test_robot_scenes_are_routed_to_their_cover(name: str, rings: int) -> None:
    """Which is the minimum, since no division has fewer segments than a smallest cover."""
    instance = Instance.read(INSTANCES / "scenes" / f"{name}.json")
    plan = whole_cover(instance)
    assert segments_of(instance, plan, rings) == len(plan)


@pytest.mark.parametrize("file", sorted((INSTANCES / "scenes" / "feasibility").glob("*.json")))
def test_raw_scenes_need_their_cover(file: Path) -> None:
    instance = decompose(LabelledSurface.read(file))
    assert solve(instance, Options()).segments == set_cover(instance).bound
