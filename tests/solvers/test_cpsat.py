"""The CP-SAT model: its constraint groups, its bounds and reductions, its enumeration."""

from __future__ import annotations

import time
from dataclasses import replace
from queue import SimpleQueue

import pytest
from exhaustive_minima import minimum, optimal_schemes
from hypothesis import given, settings
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from ortools.sat.python import cp_model

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Cell, Edge, Instance
from cellcolor.data.solution import scheme_key
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.errors import TooLarge
from cellcolor.lab.families import blobs, hub, hub_minimum, planar_graph
from cellcolor.solvers.bounds.cover import color_regions, strangers
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.cpsat.model.constraints import DEFINING, REDUNDANT, Group
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model.full import add_hint, full_model, read_painting
from cellcolor.solvers.cpsat.model.painting import Block, canonical, division_of, painting_of
from cellcolor.solvers.cpsat.schemes import enumeration
from cellcolor.solvers.interface import Options, Start

RED, BLUE = 0, 1
SEEDS = st.integers(0, 10**6)


def graph_of(instance: Instance, strands: int = 1) -> DartGraph:
    colors = [frozenset(cell.colors) for cell in instance.cells]
    counts = {edge.id: strands for edge in instance.edges}
    return dart_graph(instance, colors, counts, seams_of(instance, colors, counts, None))


def effort(instance: Instance, groups: tuple[Group, ...], limit: float) -> tuple[bool, int]:
    """Whether one worker proves the minimum within so many deterministic seconds; its conflicts."""
    built = full_model(graph_of(instance), color_regions(instance), groups)
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = 0
    solver.parameters.max_deterministic_time = limit
    return solver.solve(built.model) == cp_model.OPTIMAL, solver.num_conflicts


def model_minimum(instance: Instance, groups: tuple[Group, ...], strands: int = 1) -> int:
    solver = cp_model.CpSolver()
    solver.parameters.num_workers = 1
    built = full_model(graph_of(instance, strands), color_regions(instance), groups)
    assert solver.solve(built.model) == cp_model.OPTIMAL
    return round(solver.objective_value)


def petals(*colors: int) -> Instance:
    """A hub of red and blue with single-colored petals."""
    return Instance(
        "petals",
        ("red", "blue"),
        (
            Cell(0, (RED, BLUE), (tuple(range(1, len(colors) + 1)),)),
            *(Cell(i, (color,), ((-i,),)) for i, color in enumerate(colors, start=1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, len(colors) + 1)),
    )


TRIPLE = Instance.read(PAPER / "triple-junction.json")
MIXED = Instance(
    "a petal of both colors between a red and a blue one",
    ("red", "blue"),
    tuple(replace(c, colors=(RED, BLUE)) if c.id == 2 else c for c in petals(RED, RED, BLUE).cells),
    petals(RED, RED, BLUE).edges,
)


@pytest.mark.parametrize(
    ("group", "instance", "segments"),
    [
        # The middle petal, joined in both colors, would join the other two to one sub-cell.
        ("one_color", MIXED, 2),
        # Without pointers a cell joined on two sides need not be divided, nor have a root.
        ("one_pointer", petals(RED, BLUE), 2),
        # So would links between darts that are joined in different colors.
        ("equal_colors", MIXED, 2),
        # Red and blue petals in turn: only one color can be joined through the hub.
        ("no_crossing", petals(RED, BLUE, RED, BLUE), 3),
        # Cells without a joined dart cost a segment each.
        ("roots", petals(RED, BLUE), 2),
        # Three cells around a corner: their three joins would be a circle without a root.
        ("no_circles", TRIPLE, 1),
    ],
)
def test_every_defining_group_is_needed(group: str, instance: Instance, segments: int) -> None:
    assert minimum(instance) == segments
    assert model_minimum(instance, DEFINING) == segments
    rest = tuple(g for g in DEFINING if g.__name__ != group)
    assert len(rest) == len(DEFINING) - 1
    assert model_minimum(instance, rest) < segments


def feasible(instance: Instance, groups: tuple[Group, ...], *links: tuple[int, int]) -> bool:
    """Whether the first darts of cell 0 can be linked like this, the first of a pair pointing."""
    graph = graph_of(instance)
    built = full_model(graph, color_regions(instance), groups)
    for one, other in links:
        low, high = sorted((graph.lists[0][one], graph.lists[0][other]))
        built.model.add(built.variables.links(low, high)[one > other] == 1)
    solver = cp_model.CpSolver()
    return solver.solve(built.model) in (cp_model.OPTIMAL, cp_model.FEASIBLE)


def test_sub_cells_are_chains() -> None:
    """Without this group a sub-cell could be linked as a star, which is read as two sub-cells."""
    instance = petals(RED, RED, RED)
    rest = tuple(g for g in DEFINING if g.__name__ != "one_chain")
    assert feasible(instance, DEFINING, (2, 1), (1, 0))
    assert not feasible(instance, DEFINING, (2, 0), (1, 0))
    assert feasible(instance, rest, (2, 0), (1, 0))


@pytest.mark.parametrize("group", REDUNDANT, ids=lambda group: group.__name__)
def test_redundant_groups_change_no_minimum(group: Group) -> None:
    for seed in range(6):
        instance = planar_graph(seed, 5, 7, 3)
        assert model_minimum(instance, (*DEFINING, group)) == minimum(instance)


def test_strands_in_turn_change_no_minimum() -> None:
    rest = tuple(g for g in DEFINING + REDUNDANT if g.__name__ != "strands_in_turn")
    for seed in range(6):
        instance = planar_graph(seed, 4, 5, 3)
        plain = model_minimum(instance, rest, 2)
        assert model_minimum(instance, DEFINING + REDUNDANT, 2) == plain


def test_all_redundant_groups_together_change_no_minimum() -> None:
    for seed in range(20):
        instance = planar_graph(seed, 6, 10, 3)
        assert model_minimum(instance, DEFINING + REDUNDANT) == minimum(instance)


@pytest.mark.parametrize("name", ["cover", "forced_roots"])
def test_bounds_on_robot_scenes(name: str) -> None:
    """Each of the two lets one worker prove a scene that it cannot prove without both."""
    path = INSTANCES / "scenes" / "feasibility" / "hemisphere_flat_2000.surface.json"
    scene = decompose(LabelledSurface.read(path))
    group = next(g for g in REDUNDANT if g.__name__ == name)
    assert effort(scene, (*DEFINING, group), 0.4)[0]
    assert not effort(scene, DEFINING, 0.4)[0]


def test_strands_are_used_in_turn() -> None:
    """Two red corridors across one edge of two strands, or only its second strand."""
    instance = petals(RED)
    graph = graph_of(instance, 2)
    for used, expected in (((1,), True), ((2,), False), ((1, 2), False)):
        built = full_model(graph, color_regions(instance))
        names = {graph.darts[edge].name[1]: edge for edge in graph.edges}
        for strand, edge in names.items():
            built.model.add(built.variables.joined[edge, RED] == (strand in used))
        found = cp_model.CpSolver().solve(built.model)
        assert (found in (cp_model.OPTIMAL, cp_model.FEASIBLE)) == expected


def test_most_links_proves_hubs() -> None:
    instance = Instance.read(INSTANCES / "random" / "hub_24.json")
    rest = tuple(g for g in DEFINING + REDUNDANT if g.__name__ != "most_links")
    assert effort(instance, DEFINING + REDUNDANT, 2.0)[1] * 10 < effort(instance, rest, 2.0)[1]


@pytest.mark.parametrize("name", ["first_petal", "forced_roots"])
def test_only_the_first_petal_of_a_sub_cell_is_a_root(name: str) -> None:
    """Without that the first petal's dart can point at the second's, whose parent is its petal."""
    instance = petals(RED, RED, BLUE, BLUE)
    group = next(g for g in REDUNDANT if g.__name__ == name)
    assert not feasible(instance, (*DEFINING, group), (0, 1), (2, 3))
    assert feasible(instance, (*DEFINING, group), (1, 0), (3, 2))
    assert feasible(instance, DEFINING, (0, 1), (2, 3))


@settings(max_examples=40, deadline=None)
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


@settings(max_examples=25, deadline=None)
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


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS, cells=st.integers(2, 6), colors=st.integers(2, 3))
def test_fewest_cutting_paths(seed: int, cells: int, colors: int) -> None:
    """Against all optimal schemes: a division with the fewest sub-cells is a scheme."""
    instance = planar_graph(seed, cells, cells + 4, colors)
    found = solve(instance, Options(fewest_cuts=True))
    _, schemes = optimal_schemes(instance)
    fewest = min(sum(len(subcells) - 1 for subcells in scheme) for scheme in schemes)
    assert found.cutting_paths == found.cutting_paths_lower_bound == fewest


def test_fewest_cutting_paths_of_the_cell_that_must_be_split() -> None:
    instance = Instance.read(PAPER / "split-cell.json")
    found = solve(instance, Options(fewest_cuts=True))
    assert (found.segments, found.cutting_paths, found.cutting_paths_lower_bound) == (2, 1, 1)


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


def test_a_canonical_painting_has_no_idle_cuts_and_no_single_darts() -> None:
    """Three red darts in two sub-cells become one; a blue one alone beside them goes."""
    instance = petals(RED, RED, RED, BLUE)
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
    instance = petals(RED, RED)
    graph = graph_of(instance)
    result = canonical(graph, [[Block(RED, set())] for _ in instance.cells])
    assert result[0] == [Block(RED, set(graph.lists[0]))]


def test_without_any_time_there_is_a_division_all_the_same() -> None:
    """Every cell painted whole; and a bound that takes no search."""
    instance = decompose(blobs(3))
    found = solve(instance, Options(deadline=Deadline.after(0.0)))
    assert found.status == "feasible" and [bound.kind for bound in found.bounds] == ["strangers"]
    assert found.segments is not None and found.segments <= len(instance.cells)
    assert 1 <= found.surface_lower_bound <= len(strangers(instance)) < found.segments


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


@pytest.mark.parametrize(("edges", "catalan"), [(1, 1), (2, 2), (3, 5), (4, 14), (5, 42), (6, 132)])
def test_divisions_of_a_lone_cell(edges: int, catalan: int) -> None:
    """Colors ignored there are Catalan(n) + n: the paper's eight for three edges.

    Three colors are enough for all of them; the petals can be painted in any, so that a state is
    never forced. Every number of segments is asked for, not just the fewest.
    """
    every = (0, 1, 2)
    instance = Instance(
        "lone",
        ("red", "blue", "green"),
        (
            Cell(0, every, (tuple(range(1, edges + 1)),)),
            *(Cell(i, every, ((-i,),)) for i in range(1, edges + 1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, edges + 1)),
    )
    divisions = {
        frozenset(frozenset(sub.darts) for sub in division[0].subcells)
        for segments in range(1, edges + 2)
        for division in CpSatSolver().optimal_schemes(instance, Options(), segments)
    }
    assert len(divisions) == catalan + edges


def test_enumeration_gives_nothing_after_its_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """What waits to be taken when the time is over stays there: taking it needs time as well."""
    cells = tuple(Cell(i, (RED, BLUE), ()) for i in range(40))
    instance = Instance("many", ("red", "blue"), cells, ())
    found = CpSatSolver().optimal_schemes(instance, Options(deadline=Deadline.after(1e6)), 40)
    next(found)
    monkeypatch.setattr(Deadline, "over", property(lambda _: True))
    with pytest.raises(OutOfTime):
        next(found)


def test_enumeration_stops_when_its_time_is_over() -> None:
    # Forty cells of two free colors each have 2**40 optimal schemes.
    cells = tuple(Cell(i, (RED, BLUE), ()) for i in range(40))
    instance = Instance("many", ("red", "blue"), cells, ())
    found = CpSatSolver().optimal_schemes(instance, Options(deadline=Deadline.after(0.5)), 40)
    with pytest.raises(OutOfTime):
        for _ in found:
            pass


def test_enumeration_waits_for_who_takes_the_schemes(monkeypatch: pytest.MonkeyPatch) -> None:
    """No more than a few schemes wait in memory, however slowly they are taken."""
    monkeypatch.setattr(enumeration, "_AHEAD", 3)
    put: list[object] = []

    class Watched(SimpleQueue[object]):
        def put(self, item: object, block: bool = True, timeout: float | None = None) -> None:
            put.append(item)
            super().put(item, block, timeout)

    monkeypatch.setattr(enumeration, "SimpleQueue", Watched)
    cells = tuple(Cell(i, (RED, BLUE), ()) for i in range(40))
    instance = Instance("many", ("red", "blue"), cells, ())
    found = CpSatSolver().optimal_schemes(instance, Options(), 40)
    for taken in range(1, 6):
        next(found)
        time.sleep(0.05)  # the search could fill the memory meanwhile
        assert len(put) <= taken + 3


def test_a_model_of_schemes_that_is_too_large_is_not_built(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is counted beforehand is about what there would be."""
    instance = hub(0, 60, 3)
    graph = graph_of(instance)
    model = enumeration._SchemeModel(graph, 20, NEVER).model
    literals = sum(
        len(constraint.bool_or.literals) + len(constraint.at_most_one.literals)
        for constraint in model.proto.constraints
    )
    monkeypatch.setattr(enumeration, "_MOST_LITERALS", 1.5 * literals)
    enumeration._check_size(graph, NEVER)
    monkeypatch.setattr(enumeration, "_MOST_LITERALS", 0.7 * literals)
    with pytest.raises(TooLarge, match="one cell has 60 darts"):
        next(CpSatSolver().optimal_schemes(instance, Options(), 20))


def test_enumeration_can_be_left_early() -> None:
    cells = tuple(Cell(i, (RED, BLUE), ()) for i in range(40))
    instance = Instance("many", ("red", "blue"), cells, ())
    found = CpSatSolver().optimal_schemes(instance, Options(), 40)
    assert len({scheme_key(next(found)) for _ in range(5)}) == 5
    found.close()  # type: ignore[attr-defined]


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
