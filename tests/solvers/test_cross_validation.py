"""Depth-first search, CP-SAT model and brute force say the same, down to the set of schemes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import holes
import pytest
from exhaustive_minima import live_darts, minimum, optimal_schemes
from hypothesis import assume, given
from hypothesis import strategies as st
from library import INSTANCES, PAPER
from meshes import beside
from ortools.sat.python import cp_model
from vertex_minima import vertex_minimum

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SchemeKey, count_segments, scheme_key
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, planar_graph, voronoi
from cellcolor.lab.families.meshes import SHAPES, Topology
from cellcolor.lab.families.registry import SMALL
from cellcolor.solvers.cpsat import CompleteModel, CompleteModelSolver, CpSatSolver
from cellcolor.solvers.dfs import CoverReferenceSolver, ReferenceSolver
from cellcolor.solvers.interface import Options, Solver
from examples import examples

PAPERS, COVERED = ReferenceSolver(), CoverReferenceSolver()
WITH_STRANDS: tuple[Solver, ...] = (COVERED, CpSatSolver(), CompleteModelSolver())
"""Those that finish where cells have several loops, or edges several strands, and on scenes."""
SOLVERS: tuple[Solver, ...] = (PAPERS, *WITH_STRANDS)
LISTING = (PAPERS, COVERED, CpSatSolver())
KNOWN = sorted(p for p in PAPER.glob("*.json") if not p.name.endswith(".surface.json"))
DRAWN = sorted(PAPER.glob("*.surface.json"))

SURFACES: dict[str, dict[str, Any]] = {
    "two colors": {"size": 7, "colors": 2, "waves": 1.0},
    "three colors": {"size": 7, "colors": 3, "waves": 0.5},
    "four colors": {"size": 6, "colors": 4, "waves": 0.3},
    "thin": {"size": 8, "colors": 2, "waves": 0.5, "thin": True},
    "rim, two colors": {"size": 8, "colors": 2, "coverage": (0.8, 1.0), "rim": 5},
    "rim, three colors": {"size": 8, "colors": 3, "coverage": (1.0, 1.0), "rim": 7},
    "rim, cracks": {"size": 8, "colors": 2, "coverage": (0.8, 1.0), "rim": 5, "cracks": 2},
    "cracks": {"size": 6, "colors": 3, "waves": 0.4, "cracks": 3},
}
LOOPS: dict[str, dict[str, Any]] = {
    "islands": {"size": 9, "colors": 2, "coverage": (0.9, 1.0), "rim": 4, "islands": 1},
    "islands, holes, cracks": {
        "size": 8,
        "colors": 3,
        "coverage": (0.8, 1.0),
        "rim": 2,
        "islands": 1,
        "holes": 1,
        "cracks": 2,
    },
}
CHUNKS, PER_CHUNK = 4, 8
"""Every recipe gives CHUNKS tests of PER_CHUNK surfaces: 256 in all, 64 of them by default."""


def first_is_fast(numbers: range) -> list[Any]:
    """Parameters of a test whose first one runs by default, the others with those marked slow."""
    return [numbers[0], *(pytest.param(number, marks=pytest.mark.slow) for number in numbers[1:])]


def live_loops(instance: Instance) -> int:
    """The most loops with live darts that a cell has."""
    return max(
        sum(any(instance.joinable(dart) for dart in loop) for loop in cell.loops)
        for cell in instance.cells
    )


@cache
def sample(
    recipe: str, chunk: int, count: int = PER_CHUNK
) -> tuple[tuple[LabelledSurface, Instance], ...]:
    """Random surfaces with 2 to 8 cells: with one loop each, or with several loops somewhere.

    Brute force bounds the darts of a cell (at most 7): the partitions are Catalan numbers.
    """
    found: list[tuple[LabelledSurface, Instance]] = []
    for seed in range(1000 * chunk, 1000 * (chunk + 1)):
        surface = blobs(seed, **(SURFACES | LOOPS)[recipe])
        instance = decompose(surface)
        if not 2 <= len(instance.cells) <= 8 or (live_loops(instance) > 1) != (recipe in LOOPS):
            continue
        if recipe in LOOPS or max(len(live_darts(instance, c)) for c in instance.cells) <= 7:
            found.append((surface, instance))
        if len(found) == count:
            return tuple(found)
    raise AssertionError(f"{recipe}: too few surfaces")


def segments_of(solver: Solver, instance: Instance, options: Options) -> int:
    """The segments of a solver's answer, counted by the checker."""
    answer = solver.minimize(instance, replace(options, workers=1))
    assert answer.division is not None
    report = check_division(instance, answer.division, answer.seams, options.strands)
    assert report.valid, (solver, report.problems)
    assert report.segments is not None and answer.lower_bound <= report.segments
    if options.search_space == "paper":
        assert answer.lower_bound == report.segments, f"{solver} stopped without a proof"
    return report.segments


def schemes_of(solver: Solver, instance: Instance, segments: int) -> set[SchemeKey]:
    """A solver's optimal schemes, each held against the checker and found once only."""
    keys = set()
    for division in solver.optimal_schemes(instance, Options(), segments):
        report = check_division(instance, division)
        assert report.is_scheme, (solver, report.problems, report.not_canonical)
        assert report.segments == segments
        key = scheme_key(division)
        assert key not in keys, f"{solver} lists a scheme twice"
        keys.add(key)
    return keys


def compare(instance: Instance) -> None:
    """Every solver against brute force: minimum and, as a set, the optimal schemes."""
    expected = minimum(instance)
    fewest, schemes = optimal_schemes(instance)
    assert fewest == expected, "some optimum over all partitions is a scheme"
    for solver in SOLVERS:
        assert segments_of(solver, instance, Options()) == expected, solver
    for solver in LISTING:
        found = schemes_of(solver, instance, expected)
        assert found == schemes, (solver, len(found), len(schemes))


@pytest.mark.parametrize(
    "path",
    [pytest.param(path, marks=[pytest.mark.slow] * (path.stem == "three-loops")) for path in KNOWN],
    ids=lambda path: path.stem,
)
def test_known_cases(path: Path) -> None:
    """Results that come with the cases, from a proof or another program."""
    instance = Instance.read(path)
    assert instance.known is not None and instance.known.paper is not None
    for solver in SOLVERS if live_loops(instance) < 2 else WITH_STRANDS:
        found = segments_of(solver, instance, Options())
        assert found == instance.known.paper.segments, solver
        if instance.known.paper.schemes is not None and solver in LISTING:
            schemes = schemes_of(solver, instance, found)
            assert len(schemes) == instance.known.paper.schemes, solver
        if instance.known.surface is not None and solver is not PAPERS:
            options = Options(search_space="surface", strands=2)
            found = segments_of(solver, instance, options)
            assert found == instance.known.surface.segments, solver
    if live_loops(instance) < 2:
        compare(instance)


@pytest.mark.parametrize("chunk", first_is_fast(range(CHUNKS)))
@pytest.mark.parametrize("recipe", SURFACES)
def test_random_surfaces(recipe: str, chunk: int) -> None:
    for surface, instance in sample(recipe, chunk):
        try:
            compare(instance)
        except AssertionError as error:
            raise AssertionError(f"{recipe}, {surface.name}: {error}") from error


@pytest.mark.parametrize("first", first_is_fast(range(0, 60, 12)))
@pytest.mark.parametrize("self_edges", [False, True])
def test_random_graphs(self_edges: bool, first: int) -> None:
    """Graphs without a surface behind them: more live self-edges and partly dead edges."""
    for seed in range(first, first + 12):
        instance = planar_graph(seed, 4 + seed % 3, 7, 3, self_edges=self_edges)
        if max(len(live_darts(instance, cell)) for cell in instance.cells) <= 7:
            try:
                compare(instance)
            except AssertionError as error:
                raise AssertionError(f"{instance.name}: {error}") from error


@examples(15)
@given(
    seed=st.integers(0, 10**6),
    shapes=st.lists(st.sampled_from(sorted(SHAPES)), min_size=1, max_size=2),
    cracks=st.integers(0, 2),
)
def test_surfaces_of_any_genus(seed: int, shapes: list[Topology], cracks: int) -> None:
    """Open and closed ones, tori among them, with cracks, in one part or two."""
    drawn = [voronoi(seed + n, shape, 6, 5, 3, cracks=cracks) for n, shape in enumerate(shapes)]
    instance = decompose(beside(drawn))
    assume(1 < len(instance.cells) < 11 and instance.most_live_loops < 2)
    assume(instance.most_live_darts < 8)
    compare(instance)


def drawn_graphs(family: str, seeds: range) -> Iterator[Instance]:
    """Graphs of a family."""
    for seed in seeds:
        made = SMALL[family](seed)
        yield made if isinstance(made, Instance) else decompose(made)


@pytest.mark.parametrize("family", sorted(set(SMALL) - {"grids of hubs"}))
def test_the_model_says_what_the_depth_first_search_says(family: str) -> None:
    """300 graphs in all: discs, holes, cracks, several parts, hubs. The model is built for each.

    One seed in three is solved without a hint.
    """
    compared = 0
    for seed, instance in enumerate(drawn_graphs(family, range(300))):
        if not instance.cells:
            continue
        reference = COVERED.minimize(instance, Options(deadline=Deadline.after(0.3)))
        assert reference.division is not None
        found = count_segments(reference.division)
        if reference.lower_bound < found:
            continue
        assert CpSatSolver().minimize(instance, Options(workers=1)).lower_bound == found
        if seed % 3:
            answer = CompleteModelSolver().minimize(instance, Options(workers=1))
            assert answer.model is not None and answer.model.constraints > 0
            assert answer.lower_bound == found, instance.name
            assert answer.division is not None
            report = check_division(instance, answer.division, answer.seams)
            assert report.valid and report.segments == found, instance.name
        else:
            built = CompleteModel(instance)
            built.model.clear_hints()
            solver = cp_model.CpSolver()
            solver.parameters.num_workers = 1
            assert solver.solve(built.model) == cp_model.OPTIMAL
            assert round(solver.objective_value) == found, instance.name
        compared += 1
        if compared == 38:
            return
    raise AssertionError("too few graphs")


SCENES = {
    "half_pipe": 4,
    "hemisphere_flat": None,
    "hemisphere_tilted": None,
    "square": 2,
    "wok": 16,
    "wok_obstacle": 64,
}
"""The paper's experiments, and how many optimal schemes each has; None where that is not known."""


@pytest.mark.parametrize("name", SCENES)
def test_the_papers_experiments(name: str) -> None:
    """Minima by all three; schemes as sets where the depth-first search lists all of them."""
    instance = Instance.read(INSTANCES / "scenes" / f"{name}.json")
    found = [segments_of(solver, instance, Options()) for solver in WITH_STRANDS]
    assert len(set(found)) == 1
    if (count := SCENES[name]) is not None:
        listed = CpSatSolver().optimal_schemes(instance, Options(), found[0])
        next(listed)
        assert listed.count == count
        if count <= 100:
            counted = schemes_of(CpSatSolver(), instance, found[0])
            assert len(counted) == count
            assert counted == schemes_of(COVERED, instance, found[0])


@pytest.mark.parametrize("chunk", first_is_fast(range(2)))
@pytest.mark.parametrize("recipe", LOOPS)
def test_cells_with_several_loops(recipe: str, chunk: int) -> None:
    """Minima only: schemes are not defined there."""
    for surface, instance in sample(recipe, chunk):
        found = [segments_of(s, instance, Options()) for s in WITH_STRANDS]
        assert len(set(found)) == 1, (surface.name, found)


def against_vertex_colorings(
    solvers: tuple[Solver, ...], surface: LabelledSurface, instance: Instance
) -> None:
    """A coloring of the mesh's vertices is a division of the surface, found without the graph.

    So its minimum is never below a lower bound for the surface, and it is the surface's minimum
    where the mesh has room for every corridor, as it has on these.
    """
    expected = vertex_minimum(surface)
    options = Options(search_space="surface", strands=2)
    for solver in solvers:
        assert segments_of(solver, instance, options) == expected, (surface.name, solver)


@pytest.mark.parametrize("path", DRAWN, ids=lambda path: path.stem)
def test_drawn_surfaces_against_vertex_colorings(path: Path) -> None:
    surface = LabelledSurface.read(path)
    against_vertex_colorings(WITH_STRANDS, surface, decompose(surface))


@pytest.mark.parametrize("quarter", first_is_fast(range(4)))
@pytest.mark.parametrize(
    "recipe", ["two colors", "three colors", "thin", "rim, two colors", "rim, cracks"]
)
def test_surfaces_against_vertex_colorings(recipe: str, quarter: int) -> None:
    for surface, instance in sample(recipe, 0)[quarter::4]:
        against_vertex_colorings(WITH_STRANDS, surface, instance)


@pytest.mark.parametrize("seed", range(30))
def test_brute_force_against_the_product_of_all_choices(seed: int) -> None:
    """The sweep over the cells that the solvers are held to, against trying everything at once."""
    instance = planar_graph(seed, 3, 5, 2, self_edges=seed % 2 == 1)
    assert (minimum(instance), optimal_schemes(instance)[1]) == holes.optimal_schemes(instance)
