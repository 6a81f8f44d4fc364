"""The CP-SAT solver: known minima, search spaces, starts, odd instances, progress."""

from __future__ import annotations

import pytest
from dart_graphs import graph_of
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from ortools.sat.python import cp_model

from cellcolor.checker.division import check_division
from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import scheme_key
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, hub, hub_minimum, planar_graph
from cellcolor.lab.families.registry import MEDIUM
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.bounds.reductions import drop_dominated, left_out
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.cpsat.model.full import add_hint, full_model
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.painting import division_of, painting_of
from cellcolor.solvers.cpsat.part_search import PartSearch
from cellcolor.solvers.cpsat.parts import split
from cellcolor.solvers.interface import Options, Start
from examples import examples

RED, BLUE = 0, 1

SEEDS = st.integers(0, 10**6)


@examples(12)
@given(seed=SEEDS, petal_count=st.integers(2, 14), colors=st.integers(2, 5))
def test_hubs_have_their_known_minimum(seed: int, petal_count: int, colors: int) -> None:
    if colors == 2 and petal_count % 2:
        petal_count += 1  # two colors can alternate around an even ring only
    instance = hub(seed, petal_count, colors)
    ring = [cell.colors[0] for cell in instance.cells[1:]]
    assert solve(instance, Options()).segments == hub_minimum(ring)


@pytest.mark.parametrize(
    ("name", "paper", "surface"),
    [("parallel-corridors", 3, 2), ("parallel-corridors-private", 4, 3)],
)
def test_surface_may_beat_paper(name: str, paper: int, surface: int) -> None:
    instance = Instance.read(PAPER / f"{name}.json")
    found = solve(instance, Options())
    assert (found.status, found.segments) == ("optimal", paper)
    assert not found.proved_for_surface
    found = solve(instance, Options(search_space="surface", strands=2))
    assert (found.status, found.segments, found.proved_for_surface) == ("optimal", surface, True)


def test_three_loops_need_more_strands_than_two_at_a_time_would_get() -> None:
    instance = Instance.read(PAPER / "three-loops.json")
    found = solve(instance, Options())
    assert (found.status, found.segments) == ("optimal", 4)


def test_without_a_proof_for_the_surface_nothing_is_called_optimal() -> None:
    # With one strand the corridors' two segments are not found, and two could cross edge 2.
    instance = Instance.read(PAPER / "parallel-corridors.json")
    found = solve(instance, Options(search_space="surface", strands=1))
    assert (found.segments, found.surface_lower_bound, found.status) == (3, 2, "feasible")
    assert not found.proved_for_surface


def test_a_start_is_kept_when_there_is_no_time() -> None:
    instance = decompose(blobs(3))
    good = solve(instance, Options())
    assert good.cells is not None
    start = Start(good.cells, good.seams)
    found = solve(instance, Options(deadline=Deadline.after(0.0), start=start))
    assert found.segments == good.segments


def test_a_start_helps_the_model() -> None:
    """Its hint is complete: the model's first solution is the division that was handed in."""
    for seed in range(10):
        instance = planar_graph(seed, 6, 10, 3)
        best = solve(instance, Options())
        assert best.cells is not None
        graph = graph_of(instance)
        built = full_model(graph, color_regions(instance))
        add_hint(built, graph, painting_of(graph, best.cells))
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.stop_after_first_solution = True
        solver.parameters.fix_variables_to_their_hinted_value = True
        assert solver.solve(built.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)
        assert round(solver.objective_value) == best.segments


def test_without_any_time_there_is_a_division_all_the_same() -> None:
    """Every cell painted whole; and a bound that takes no search."""
    instance = decompose(blobs(3))
    found = solve(instance, Options(deadline=Deadline.after(0.0)))
    assert found.status == "feasible" and [bound.kind for bound in found.bounds] == ["strangers"]
    assert found.segments is not None and found.segments <= len(instance.cells)
    assert 1 <= found.surface_lower_bound <= set_cover(instance).bound < found.segments


@pytest.mark.parametrize("instance", [Instance("empty", (), (), ()), Instance("e", ("r",), (), ())])
def test_empty_instance(instance: Instance) -> None:
    found = solve(instance, Options())
    assert (found.status, found.segments, found.lift_offs, found.cells) == ("optimal", 0, 0, ())
    assert list(CpSatSolver().optimal_schemes(instance, Options(), 0)) == [()]


def test_a_closed_surface_of_one_cell() -> None:
    instance = Instance("sphere", ("red", "blue"), (Cell(0, (RED, BLUE), ()),), ())
    assert solve(instance, Options()).segments == 1
    # It may be painted in either color.
    schemes = list(CpSatSolver().optimal_schemes(instance, Options(), 1))
    assert {scheme_key(s) for s in schemes} == {
        (frozenset({(color, frozenset())}),) for color in (RED, BLUE)
    }


def test_progress_reports_the_best_and_the_bound() -> None:
    seen: list[tuple[int | None, int]] = []
    instance = Instance.read(PAPER / "split-cell.json")
    CpSatSolver().minimize(instance, Options(), lambda best, bound: seen.append((best, bound)))
    # A division is there from the beginning: every cell painted whole.
    assert all(found is not None and bound <= 2 <= found for found, bound in seen)
    assert seen[-1] == (2, 2)


def test_progress_comes_closer_and_never_passes_the_minimum() -> None:
    seen: list[tuple[int | None, int]] = []
    instance = hub(3, 12, 3)
    minimum = hub_minimum([cell.colors[0] for cell in instance.cells[1:]])
    CpSatSolver().minimize(instance, Options(), lambda best, bound: seen.append((best, bound)))
    assert seen[-1] == (minimum, minimum)
    assert all(bound <= minimum for _, bound in seen)
    best = [found for found, _ in seen if found is not None]
    assert best == sorted(best, reverse=True) and best[-1] == minimum


def _routed_rim() -> PartSearch:
    """The one part of a surface with 26 cells at its rim, covered and routed."""
    instance = decompose(MEDIUM["rim"](26))
    (part,) = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    search.cover(NEVER)
    search.planning.route(NEVER)
    return search


def test_what_segments_avoid_proves_the_last_one() -> None:
    """Where segments two and three at a time may pass through each other's cells, six are not ruled
    out. But one that touches the cell between two of another color cannot get out of there."""
    search = _routed_rim()
    search.recolor_best(NEVER)
    assert (search.segments, search.surface_bound) == (7, 6)
    search.plan_harder(NEVER)
    assert search.surface_bound == 7


def test_a_turn_of_plans_ends_with_its_share_of_the_time() -> None:
    search = _routed_rim()
    search.plan_harder(Deadline.after(0))
    assert not search.done


def test_a_large_part_begins_with_local_search() -> None:
    """Routes and windows came to 18 segments of this graph in minutes, 17 of the large part."""
    instance = Instance.read(INSTANCES / "hard" / "large_part_1.json")
    *_, part = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    assert search.large
    search.cover(NEVER)
    search.begin_large(NEVER)
    assert search.bound <= search.segments < 17
    graph, painting = search.best
    report = check_division(part.instance, division_of(graph, painting), seams=graph.seams)
    assert report.valid, report.problems
    assert report.segments == search.segments


def test_a_small_part_is_improved_by_local_search_after_plans() -> None:
    """Before plans its cells stay whole; afterwards what local search finds is a legal division."""
    instance = decompose(MEDIUM["rim"](26))
    (part,) = split(instance, drop_dominated(instance, left_out(instance)))
    options = Options()
    search = PartSearch(part, options, Runner(options), lambda: None)
    search.cover(NEVER)
    whole, before = search.best, search.segments
    search.begin_large(NEVER)
    assert search.best is whole
    search.recolor_best(NEVER)
    graph, painting = search.best
    report = check_division(part.instance, division_of(graph, painting), seams=graph.seams)
    assert report.valid, report.problems
    assert search.bound <= report.segments == search.segments < before
