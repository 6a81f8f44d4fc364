"""Paintings and their canonical form, the scheme."""

from __future__ import annotations

from copy import deepcopy

from dart_graphs import graph_of
from hypothesis import given
from hypothesis import strategies as st
from ortools.sat.python import cp_model
from rooms import hub

from cellcolor.checker.division import check_division
from cellcolor.lab.families import planar_graph
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.full import full_model, read_painting
from cellcolor.solvers.cpsat.painting import Block, canonical, division_of
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import refined
from cellcolor.solvers.cpsat.routes.segment_plans import PlannedSegment
from examples import examples

RED, BLUE = 0, 1

SEEDS = st.integers(0, 10**6)


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(1, 4))
def test_what_the_model_finds_has_a_scheme(seed: int, cells: int, colors: int) -> None:
    """The painting read off the model, made canonical, is a scheme with no more segments."""
    instance = planar_graph(seed, cells, cells + 4, colors)
    graph = graph_of(instance)
    built = full_model(graph, color_regions(instance))
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    # Any division will do, not just the best: sub-cells to be dissolved are more likely then.
    solver.parameters.stop_after_first_solution = True
    solver.solve(built.model)
    painting = canonical(graph, read_painting(graph, built.variables, solver))
    report = check_division(instance, division_of(graph, painting))
    assert report.is_scheme, (report.problems, report.not_canonical)
    assert report.segments is not None and report.segments <= round(solver.objective_value)


@examples(40)
@given(seed=SEEDS, cells=st.integers(2, 10), colors=st.integers(1, 4), chosen=st.integers(0, 99))
def test_a_change_is_made_canonical_where_it_was_made(
    seed: int, cells: int, colors: int, chosen: int
) -> None:
    """A cell of a scheme is cut off all round; only it and its neighbors are looked at again."""
    instance = planar_graph(seed, cells, cells + 5, colors)
    graph = graph_of(instance)
    plan = tuple(PlannedSegment(region, region[1]) for region in color_regions(instance))
    scheme = canonical(graph, route(refined(graph, 1), plan, 5, seed))
    cell = chosen % len(scheme)
    twins = {graph.darts[dart].twin for dart in graph.lists[cell]}
    around = {cell, *(graph.darts[twin].cell for twin in twins)}
    changed = [
        [Block(b.color, b.darts - twins - set(graph.lists[cell])) for b in blocks]
        for blocks in scheme
    ]
    changed = [[b for b in blocks if b.darts] or blocks[:1] for blocks in changed]
    before = deepcopy(changed)
    found = canonical(graph, changed, around)
    assert changed == before
    report = check_division(instance, division_of(graph, found))
    assert report.is_scheme, (report.problems, report.not_canonical)


def test_a_canonical_painting_has_no_idle_cuts_and_no_single_darts() -> None:
    """Three red darts in two sub-cells become one; a blue one alone beside them goes."""
    instance = hub(RED, RED, RED, BLUE)
    graph = graph_of(instance)
    hub_darts = graph.lists[0]
    outer = [graph.darts[dart].twin for dart in hub_darts]
    colors = (RED, RED, RED, BLUE)
    painting = [
        [Block(RED, set(hub_darts[:2])), Block(RED, {hub_darts[2]}), Block(BLUE, {hub_darts[3]})],
        *([Block(color, {dart})] for color, dart in zip(colors, outer, strict=True)),
    ]
    result = canonical(graph, painting)
    assert [(block.color, block.darts) for block in result[0]] == [(RED, set(hub_darts[:3]))]
    assert result[4] == [Block(BLUE, set())]


def test_a_canonical_painting_joins_what_shows_one_color() -> None:
    instance = hub(RED, RED)
    graph = graph_of(instance)
    result = canonical(graph, [[Block(RED, set())] for _ in instance.cells])
    assert result[0] == [Block(RED, set(graph.lists[0]))]
