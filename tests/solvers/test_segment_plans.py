"""Conflicts between segments, plans, and divisions routed from them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from pathlib import Path

import networkx as nx
import pytest
from exhaustive_minima import minimum, vertex_minimum
from hypothesis import given, settings
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from meshes import grid_faces, grid_points, surface
from ortools.sat.python import cp_model

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Cell, Edge, Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.solvers.bounds.conflicts import MergedCell, conflicts
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model.painting import division_of
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import refined
from cellcolor.solvers.cpsat.routes.segment_plans import PlannedSegment, Planner, SegmentPlan
from cellcolor.solvers.interface import Options

RED, BLUE, GREEN = 0, 1, 2
SEEDS = st.integers(0, 10**6)


def hub(*petals: int) -> Instance:
    """A cell of all colors with single-colored petals."""
    colors = tuple(range(max(petals) + 1))
    return Instance(
        "hub",
        tuple(f"color {c}" for c in colors),
        (
            Cell(0, colors, (tuple(range(1, len(petals) + 1)),)),
            *(Cell(i, (color,), ((-i,),)) for i, color in enumerate(petals, start=1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, len(petals) + 1)),
    )


def areas(pair: tuple[MergedCell, MergedCell]) -> tuple[list[int], list[int]]:
    one, other = pair
    return sorted(one), sorted(other)


# --- conflicts ----------------------------------------------------------------------------------


def test_petals_in_turn_are_in_conflict() -> None:
    red, blue = color_regions(hub(RED, BLUE, RED, BLUE))
    (found,) = conflicts(hub(RED, BLUE, RED, BLUE), red, blue)
    assert areas(found.one) == ([1], [3])
    assert areas(found.other) == ([2], [4])


def test_petals_side_by_side_are_not() -> None:
    red, blue = color_regions(hub(RED, RED, BLUE, BLUE))
    assert conflicts(hub(RED, RED, BLUE, BLUE), red, blue) == []


def test_a_way_around_is_no_conflict() -> None:
    """The red petals of the hub also meet behind one of the blue ones."""
    instance = Instance(
        "around",
        ("red", "blue"),
        (
            Cell(0, (RED, BLUE), ((1, 2, 3, 4),)),
            Cell(1, (RED,), ((-1, 5),)),
            Cell(2, (BLUE,), ((-2,),)),
            Cell(3, (RED,), ((-3, -5),)),
            Cell(4, (BLUE,), ((-4,),)),
        ),
        (*(Edge(i, 0, i) for i in range(1, 5)), Edge(5, 1, 3)),
    )
    red, blue = color_regions(instance)
    assert conflicts(instance, red, blue) == []


def test_corridors_side_by_side_are_no_conflict() -> None:
    """They cross one edge together, which paper forbids and the surface does not."""
    instance = Instance.read(PAPER / "parallel-corridors.json")
    for first, second in combinations(color_regions(instance), 2):
        assert conflicts(instance, first, second) == []


def test_a_handle_leads_past() -> None:
    """Petals in turn, but the hub's edge 1 leads from between two of them to a second border."""
    petals = (RED, BLUE, RED, BLUE)
    instance = Instance(
        "handle",
        ("red", "blue"),
        (
            Cell(0, (RED, BLUE), ((1, 2, 3, 4, 5), (-1,))),
            *(Cell(i, (color,), ((-i - 1,),)) for i, color in enumerate(petals, start=1)),
        ),
        (Edge(1, 0, 0), *(Edge(i + 1, 0, i) for i in range(1, 5))),
    )
    red, blue = color_regions(instance)
    assert conflicts(instance, red, blue) == []
    found = solve(instance, Options())
    assert (found.segments, found.lower_bound) == (2, 2)


def test_a_conflict_is_proved_for_any_division() -> None:
    """Red from top to bottom and blue from left to right, over two cells of both colors.

    Nothing limits how often the edge between these two is crossed, and one strand is tried.
    """
    instance = Instance(
        "crossing",
        ("red", "blue"),
        (
            Cell(0, (RED,), ((1, 2),)),
            Cell(1, (RED,), ((3, 4),)),
            Cell(2, (RED, BLUE), ((-1, 5, -3, 6),)),
            Cell(3, (RED, BLUE), ((-2, -6, -4, 7),)),
            Cell(4, (BLUE,), ((-5,),)),
            Cell(5, (BLUE,), ((-7,),)),
        ),
        (
            Edge(1, 0, 2),
            Edge(2, 0, 3),
            Edge(3, 1, 2),
            Edge(4, 1, 3),
            Edge(5, 2, 4),
            Edge(6, 2, 3),
            Edge(7, 3, 5),
        ),
    )
    assert set_cover(instance).bound == 2
    found = solve(instance, Options())
    assert (found.segments, found.surface_lower_bound) == (3, 3)
    assert found.proved_for_surface


@st.composite
def framed(draw: st.DrawFn, width: int, height: int) -> LabelledSurface:
    """Single-colored pieces of frame around an inside of two or three blocks with islands."""
    inside = draw(
        st.lists(
            st.sampled_from([(RED, BLUE), (RED, GREEN), (RED, BLUE, GREEN)]),
            min_size=2,
            max_size=3,
        )
    )
    pieces = draw(st.lists(st.sampled_from([RED, BLUE, GREEN]), min_size=6, max_size=8))
    rim = [(0, column) for column in range(width)]
    rim += [(row, width - 1) for row in range(1, height)]
    rim += [(height - 1, column) for column in reversed(range(width - 1))]
    rim += [(row, 0) for row in reversed(range(1, height - 1))]
    labels: dict[tuple[int, int], Sequence[int]] = {
        place: (pieces[number * len(pieces) // len(rim)],) for number, place in enumerate(rim)
    }
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            labels[row, column] = inside[(row - 1) * len(inside) // (height - 2)]
    for row in draw(st.sets(st.integers(2, height - 3), max_size=2)):
        labels[row, width // 2] = draw(st.sampled_from([(), (RED,), (BLUE,), (GREEN,)]))
    return surface(
        grid_points(width, height),
        grid_faces(width, height),
        [labels[row, column] for row in range(height) for column in range(width)],
    )


def can_pass(
    mesh: LabelledSurface, colors: tuple[int, int], one: list[set[int]], other: list[set[int]]
) -> bool:
    """Whether two disjoint sets of mesh vertices exist, connected in the one and the other color,
    that each touch two sets of vertices: every path without shortcuts is tried for the first."""
    graphs = []
    for color in colors:
        graph: nx.Graph[int] = nx.Graph()
        graph.add_nodes_from(v for v, own in enumerate(mesh.vertex_colors) if color in own)
        cracked = {(c.i, c.j) for c in mesh.cracks if color in c.colors}
        graph.add_edges_from(
            (i, j)
            for i, j in mesh.left_of
            if i in graph and j in graph and (min(i, j), max(i, j)) not in cracked
        )
        graphs.append(graph)
    first, second = graphs

    def others_meet(path: list[int]) -> bool:
        rest = second.subgraph(second.nodes - set(path))
        return any(
            not part.isdisjoint(other[0]) and not part.isdisjoint(other[1])
            for part in nx.connected_components(rest)
        )

    def extend(path: list[int]) -> bool:
        if not others_meet(path):
            return False
        if path[-1] in one[1]:
            return True
        near = set().union(*(first[v] for v in path[:-1])) | set(path)
        return any(extend([*path, v]) for v in first[path[-1]] if v not in near)

    return any(extend([start]) for start in sorted(one[0]))


@settings(max_examples=60, deadline=None)
@given(mesh=framed(5, 7))
def test_what_is_in_conflict_cannot_pass_on_the_mesh(mesh: LabelledSurface) -> None:
    """Against trying all paths over mesh vertices, without cells, edges or merging."""
    instance = decompose(mesh, "mesh")
    assert instance.surface is not None
    cell_of = instance.surface.vertex_cell
    for first, second in combinations(color_regions(instance), 2):
        for found in conflicts(instance, first, second):
            one, other = (
                [{v for v, c in enumerate(cell_of) if c in area} for area in pair]
                for pair in (found.one, found.other)
            )
            assert not can_pass(mesh, (first[0], second[0]), one, other)


@settings(max_examples=60, deadline=None)
@given(mesh=framed(5, 7))
def test_the_surface_bound_holds_where_segments_are_in_conflict(mesh: LabelledSurface) -> None:
    """Against a sweep over vertex colorings, which knows no cells."""
    found = solve(decompose(mesh), Options())
    assert found.surface_lower_bound <= vertex_minimum(mesh)


# --- plans --------------------------------------------------------------------------------------


def planner_of(instance: Instance) -> Planner:
    def run(
        model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.random_seed = seed
        return solver, solver.solve(model)

    return Planner(instance, color_regions(instance), set_cover(instance).bound, run, NEVER)


def fewest_planned(instance: Instance) -> tuple[int, SegmentPlan]:
    """The fewest segments for which there is a plan without conflicts."""
    planner = planner_of(instance)
    segments = set_cover(instance).bound
    while True:
        plan = planner.plan(segments, 0)
        if plan is None:
            segments += 1
        elif not planner.find_partings(plan):
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


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(2, 3))
def test_what_cannot_be_planned_cannot_be_painted(seed: int, cells: int, colors: int) -> None:
    """Against brute force, which paints with one strand, and the DFS with two."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    fewest, plan = fewest_planned(instance)
    assert set_cover(instance).bound <= fewest <= minimum(instance)
    wide = solve(instance, Options(search_space="surface", strands=2), "dfs")
    assert wide.segments is not None
    assert fewest <= wide.segments
    for cell in instance.cells:
        assert sum(cell.id in segment.cells for segment in plan) == 1
    assert all(segment.cells <= segment.region[1] for segment in plan)


# --- routing ------------------------------------------------------------------------------------


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


@settings(max_examples=60, deadline=None)
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
    instance = Instance(
        "crack",
        ("red", "blue"),
        (
            Cell(0, (BLUE,), ((1,),)),
            Cell(1, (RED, BLUE), ((-1, 2, 3),)),
            Cell(2, (RED, BLUE), ((-2, 4, 5),)),
            Cell(3, (BLUE,), ((-5,),)),
            Cell(4, (RED, BLUE), ((-3, 6, -4),)),
            Cell(5, (RED,), ((-6,),)),
        ),
        (
            Edge(1, 0, 1),
            Edge(2, 1, 2, (RED,)),
            Edge(3, 1, 4),
            Edge(4, 2, 4),
            Edge(5, 2, 3),
            Edge(6, 4, 5),
        ),
    )
    assert segments_of(instance, whole_cover(instance), 1) == 2


def test_what_no_route_touches_is_connected_next() -> None:
    """Cell 0, of red and blue, lies behind cells that green and gray flood at first."""
    gray = 3
    instance = Instance(
        "behind",
        ("red", "blue", "green", "gray"),
        (
            Cell(0, (RED, BLUE), ((1, 2),)),
            Cell(1, (RED, GREEN), ((3, -1, 4, 5),)),
            Cell(2, (BLUE, gray), ((6, -2, 7, 8),)),
            *(Cell(i, (c,), ((-i,),)) for i, c in ((3, RED), (4, GREEN), (5, GREEN))),
            *(Cell(i, (c,), ((-i,),)) for i, c in ((6, BLUE), (7, gray), (8, gray))),
        ),
        (
            Edge(1, 0, 1),
            Edge(2, 0, 2),
            *(Edge(i, 1, i) for i in (3, 4, 5)),
            *(Edge(i, 2, i) for i in (6, 7, 8)),
        ),
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
def test_raw_scenes_need_no_cutting_paths(file: Path) -> None:
    """Cells are divided only where whole ones do not do."""
    instance = decompose(LabelledSurface.read(file))
    found = solve(instance, Options(fewest_cuts=True))
    assert found.segments == set_cover(instance).bound
    assert (found.cutting_paths, found.cutting_paths_lower_bound) == (0, 0)
