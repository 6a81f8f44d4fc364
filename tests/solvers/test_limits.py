"""The solver's limits: what is bounded, estimated and divided up, so that time and memory hold."""

from __future__ import annotations

from itertools import combinations

import pytest
from conflicts import conflicts
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES
from ortools.sat.python import cp_model

from cellcolor.checker.division import check_division, check_solution
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, hub, planar_graph
from cellcolor.lab.families.hubs import hub_with_loops
from cellcolor.solvers.bounds.cover import color_regions, greedy_strangers, set_cover
from cellcolor.solvers.bounds.reductions import drop_dominated, left_out
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import model_search
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model import full as model_module
from cellcolor.solvers.cpsat.model.full import full_model, model_size
from cellcolor.solvers.cpsat.painting import Block, Painting, canonical, division_of
from cellcolor.solvers.cpsat.parts import split
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import refined
from cellcolor.solvers.cpsat.routes.segment_plans import Planner
from cellcolor.solvers.interface import Options
from examples import examples

SEEDS = st.integers(0, 10**6)
OVER = Deadline.after(-1.0)


def graph_of(instance: Instance, most: int | None = 2) -> DartGraph:
    colors = [frozenset(cell.colors) for cell in instance.cells]
    once = {edge.id: 1 for edge in instance.edges}
    return dart_graph(instance, colors, once, seams_of(instance, colors, once, most))


def whole_cells(graph: DartGraph) -> Painting:
    return canonical(graph, [[Block(min(colors), set())] for colors in graph.colors])


def solved(model: cp_model.CpModel, seed: int) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = seed
    solver.parameters.max_deterministic_time = 0.05
    return solver, solver.solve(model)


# --- conflicts ------------------------------------------------------------------------------------


def test_conflicts_between_forty_loops() -> None:
    """A way past each loop has two sides to choose: 2^40 ways, had they to be tried one by one."""
    instance = hub_with_loops(1, 40, 2, 2)
    for first, second in combinations(color_regions(instance), 2):
        # With so many loops there is always a way around, so nothing is in conflict.
        assert conflicts(instance, first, second) == []


@pytest.mark.parametrize("islands", [0, 25])
def test_loops_beside_do_not_hide_a_conflict(islands: int) -> None:
    """Petals in turn on one loop cross, whatever single petals lie on loops within."""
    around = [Cell(n, (n % 2,), ((-n,),)) for n in range(1, 5)]
    inside = [Cell(n, (n % 2,), ((-n,),)) for n in range(5, 5 + islands)]
    loops = ((1, 2, 3, 4), *((n,) for n in range(5, 5 + islands)))
    cells = (Cell(0, (0, 1), loops), *around, *inside)
    edges = tuple(Edge(n, 0, n) for n in range(1, 5 + islands))
    instance = Instance("islands", ("red", "blue"), cells, edges)
    found = conflicts(instance, *color_regions(instance))
    outer = [c for c in found if all(max(area) < 5 for area in (*c.one, *c.other))]
    assert [({*map(min, c.one)}, {*map(min, c.other)}) for c in outer] == [({2, 4}, {1, 3})]


# --- bounds ---------------------------------------------------------------------------------------


@examples(30)
@given(seed=SEEDS, cells=st.integers(1, 12), colors=st.integers(1, 5))
def test_strangers_found_at_once_share_no_region(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    found = greedy_strangers(instance)
    for one, other in combinations(found, 2):
        assert not any({one, other} <= region for _, region in color_regions(instance))
    assert 1 <= len(found) <= set_cover(instance).bound


@examples(15)
@given(seed=SEEDS, cells=st.integers(1, 12), colors=st.integers(1, 5))
def test_a_cover_without_time_is_a_cover_all_the_same(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    hasty, exact = set_cover(instance, deadline=OVER), set_cover(instance)
    assert set().union(*(touched for _, touched in hasty.regions)) == set(range(cells))
    assert 1 <= hasty.bound <= exact.bound == len(exact.regions) <= len(hasty.regions)


def test_without_time_no_color_is_dropped() -> None:
    instance = planar_graph(3, 8, 12, 4)
    assert drop_dominated(instance, left_out(instance, OVER)) == tuple(
        frozenset(c.colors) for c in instance.cells
    )
    assert drop_dominated(instance, left_out(instance)) != drop_dominated(
        instance, left_out(instance, OVER)
    )


# --- deadlines ------------------------------------------------------------------------------------


def test_plans_partings_and_models_end_with_the_deadline() -> None:
    instance = hub(5, 12, 2)
    graph = graph_of(instance)
    regions = color_regions(instance)
    planner = Planner(instance, regions, set_cover(instance).bound, solved)
    plan = planner.plan(2, 0)
    assert plan is not None
    with pytest.raises(OutOfTime):
        planner.find_partings(plan, OVER)
    with pytest.raises(OutOfTime):
        full_model(graph, regions, deadline=OVER)
    # What is left of a route is a division.
    painting = route(refined(graph, 1), plan, 1000, 0, OVER)
    assert check_division(instance, division_of(graph, painting), graph.seams).valid


@pytest.mark.parametrize("solver", ["cp-sat", "cp-sat-model"])
def test_an_interrupt_at_any_moment_leaves_a_division(
    solver: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Out of time after n looks at the clock, for every n that there is."""
    instance = decompose(blobs(5, size=12, colors=4))
    looks = 0

    def over(deadline: Deadline) -> bool:
        nonlocal looks
        if deadline == NEVER:  # the checker looks at this one, and is not to be stopped
            return False
        looks -= 1
        return looks < 0

    monkeypatch.setattr(Deadline, "over", property(over))
    best = []
    for allowed in (0, 1, 2, 3, 5, 8, 13, 30, 10**9):
        looks = allowed
        found = solve(instance, Options(deadline=Deadline.after(1000.0), workers=1), solver)
        assert found.segments is not None and check_solution(instance, found).valid
        assert found.lower_bound <= found.segments
        best.append(found.segments)
    assert best[-1] == found.lower_bound < best[0]


# --- memory ---------------------------------------------------------------------------------------


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 9), colors=st.integers(1, 4))
def test_the_estimate_of_a_model_is_near_its_size(seed: int, cells: int, colors: int) -> None:
    """Counted in the model itself: variables in all of its constraints."""
    instance = planar_graph(seed, cells, cells + 5, colors)
    graph = graph_of(instance, None)
    assume(len(graph.darts) > 6)
    proto = full_model(graph, color_regions(instance)).model.proto
    terms = sum(
        len(c.linear.vars)
        + sum(len(g.literals) for g in (c.bool_or, c.bool_and, c.at_most_one, c.exactly_one))
        + len(c.enforcement_literal)
        for c in proto.constraints
    )
    assert terms / 6 < model_size(graph) + 40 * len(graph.darts)
    assert model_size(graph) < 3 * terms


def test_the_estimate_for_one_hub_grows_with_the_cube() -> None:
    sizes = [model_size(graph_of(hub(1, petals, 2))) for petals in (100, 200, 300)]
    # Twice and half as many darts again: 2^3 and 1.5^3 times the terms.
    assert 7 < sizes[1] / sizes[0] < 8.5 and 3 < sizes[2] / sizes[1] < 3.6


def test_what_is_too_large_is_not_built_and_that_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = hub(3, 12, 3)
    monkeypatch.setattr(model_search, "LARGEST_MODEL", 10)
    monkeypatch.setattr(model_module, "LARGEST_MODEL", 10)

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("built")

    monkeypatch.setattr(model_search, "full_model", refuse)
    found = solve(instance, Options(), "cp-sat-model")
    assert found.status == "feasible"
    assert len(found.notes) == 1 and "was not built" in found.notes[0]


def test_six_loops_of_four_petals() -> None:
    """Seams twice as wide from loop to loop make its model 300 million terms."""
    instance = hub_with_loops(2, 6, 4, 4)
    assert model_size(graph_of(instance, None)) > model_module.LARGEST_MODEL
    found = solve(instance, Options(deadline=Deadline.after(25.0), workers=1))
    assert found.segments is not None
    assert any("was not built" in note for note in found.notes) or found.proved_for_surface


@pytest.mark.parametrize("name", ["machined-part", "machined-part-raw"])
def test_a_real_part_is_proved(name: str) -> None:
    """Up to 90 darts and 6 loops a cell; cover 3 and 4, and the checker sees the division."""
    instance = Instance.read(INSTANCES / "parts" / f"{name}.json")
    found = solve(instance, Options(deadline=Deadline.after(100.0), workers=1))
    assert found.proved_for_surface and check_solution(instance, found).valid
    assert found.lower_bound == found.segments == 4


# --- parts ----------------------------------------------------------------------------------------


def side_by_side(instances: list[Instance]) -> Instance:
    """Several instances as one, with nothing between them."""
    cells: list[Cell] = []
    edges: list[Edge] = []
    for instance in instances:
        first, low = len(cells), max((edge.id for edge in edges), default=0)

        def turned(dart: int, low: int = low) -> int:
            return dart + low if dart > 0 else dart - low

        cells += [
            Cell(
                cell.id + first, cell.colors, tuple(tuple(map(turned, loop)) for loop in cell.loops)
            )
            for cell in instance.cells
        ]
        edges += [
            Edge(
                edge.id + low,
                *(side + first if side >= 0 else side for side in (edge.left, edge.right)),
                edge.colors,
            )
            for edge in instance.edges
        ]
    names = max((instance.colors for instance in instances), key=len)
    return Instance("side by side", names, tuple(cells), tuple(edges))


@examples(12)
@given(seeds=st.lists(SEEDS, min_size=2, max_size=3), cells=st.integers(2, 6))
def test_minima_of_parts_add_up(seeds: list[int], cells: int) -> None:
    instances = [planar_graph(seed, cells, cells + 3, 3) for seed in seeds]
    apart = [solve(instance, Options(workers=1), "dfs") for instance in instances]
    together = solve(side_by_side(instances), Options(workers=1))
    assert together.status == "optimal"
    assert together.segments == sum(found.segments or 0 for found in apart)


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 10), colors=st.integers(2, 4))
def test_parts_are_what_live_edges_connect(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    left = drop_dominated(instance, left_out(instance))
    parts = split(instance, left)
    assert sorted(cell for part in parts for cell in part.cells) == list(range(cells))
    part_of = {cell: number for number, part in enumerate(parts) for cell in part.cells}
    for edge in instance.edges:
        if set(instance.joinable(edge.id)) & left[edge.left] & left[edge.right]:
            assert part_of[edge.left] == part_of[edge.right]
    for part in parts:
        regions = color_regions(part.instance)
        assert all(cells <= set(range(len(part.cells))) for _, cells in regions)
        assert [frozenset(c.colors) for c in part.instance.cells] == [left[c] for c in part.cells]


@pytest.mark.second
def test_twenty_loops() -> None:
    """Seams of half a million strands are told by their widths; not even their darts are made."""
    instance = hub_with_loops(1, 20, 3, 3)
    once = {edge.id: 1 for edge in instance.edges}
    colors = [frozenset(cell.colors) for cell in instance.cells]
    seams = seams_of(instance, colors, once, None)
    assert max(seam.strands for seam in seams) > 500_000
    assert model_module.seams_size(seams) > model_module.LARGEST_MODEL
    found = solve(instance, Options(deadline=Deadline.after(4.0), workers=1))
    assert found.segments is not None
    assert any("was not built" in note for note in found.notes) or found.proved_for_surface


def test_what_there_is_no_time_to_build_is_not_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hub of 130 petals: by the estimate its model takes longer than all the time there is."""

    def never(*_arguments: object, **_named: object) -> None:
        raise AssertionError("a model was begun")

    monkeypatch.setattr(model_search, "full_model", never)
    instance = hub(1, 130, 4)
    assert 4e5 * model_module.SECONDS_A_TERM > 1.0
    found = solve(instance, Options(deadline=Deadline.after(1.0)), "cp-sat-model")
    assert found.segments is not None
