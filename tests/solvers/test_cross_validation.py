"""Depth-first search, CP-SAT model and brute force say the same, down to the set of schemes."""

from __future__ import annotations

from collections import Counter
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from exhaustive_minima import literal_minimum, live_darts, minimum, optimal_schemes
from library import PAPER
from vertex_minima import vertex_minimum

from cellcolor.checker.division import check_division
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SchemeKey, scheme_key
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.solvers.cpsat import CpSatSolver
from cellcolor.solvers.dfs import CoverReferenceSolver, ReferenceSolver
from cellcolor.solvers.interface import Options, Solver

pytestmark = pytest.mark.second

PAPERS, COVERED = ReferenceSolver(), CoverReferenceSolver()
WITH_STRANDS: tuple[Solver, ...] = (COVERED, CpSatSolver(), CpSatSolver(plans=False))
"""Those that finish where cells have several loops or edges have several strands."""
SOLVERS: tuple[Solver, ...] = (PAPERS, *WITH_STRANDS)
LISTING = SOLVERS[:3]  # plans have no part in the schemes that CP-SAT lists
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
CHUNKS, PER_CHUNK = 4, 10
"""Every recipe gives CHUNKS tests of PER_CHUNK surfaces: 320 in all, 80 of them by default."""


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
    answer = solver.minimize(instance, options)
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


@pytest.mark.parametrize("path", KNOWN, ids=lambda path: path.stem)
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


def test_known_cases_are_there() -> None:
    assert {"crossing-zeros", "three-loops", "annulus", "triple-junction"} <= {
        path.stem for path in KNOWN
    }


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


@pytest.mark.slow
@pytest.mark.parametrize("recipe", ["rim, three colors", *LOOPS])
def test_more_surfaces_against_vertex_colorings(recipe: str) -> None:
    """Many colors everywhere, islands and holes: strands and seams together are too much for a
    depth-first search, so it takes part only without islands."""
    for surface, instance in sample(recipe, 0):
        solvers = WITH_STRANDS if recipe in SURFACES else WITH_STRANDS[1:]
        against_vertex_colorings(solvers, surface, instance)


@pytest.mark.parametrize("chunks", [1, pytest.param(CHUNKS, marks=pytest.mark.slow)])
def test_random_surfaces_are_not_trivial(chunks: int, capsys: pytest.CaptureFixture[str]) -> None:
    """What the random surfaces ask for, by the sets of schemes that brute force confirms.

    With several workers pytest shows no output of passing tests: use ``-n 0`` to see the histogram.
    """
    traits: Counter[str] = Counter()
    counts: Counter[str] = Counter()
    for recipe in SURFACES:
        for chunk in range(chunks):
            for surface, instance in sample(recipe, chunk):
                best = segments_of(PAPERS, instance, Options())
                schemes = list(PAPERS.optimal_schemes(instance, Options(), best))
                cut = all(any(len(cell.subcells) > 1 for cell in scheme) for scheme in schemes)
                traits["surfaces"] += 1
                traits["cut in every optimum"] += cut
                traits["5 optima or more"] += len(schemes) >= 5
                traits["one or the other"] += cut or len(schemes) >= 5
                traits["cracks"] += bool(surface.cracks)
                traits["self-edges"] += any(e.left == e.right for e in instance.edges)
                traits["live self-edges"] += any(
                    e.left == e.right and bool(instance.joinable(e.id)) for e in instance.edges
                )
                size = len(schemes)
                bins = ((1, "1"), (2, "2"), (4, "3-4"), (9, "5-9"), (99, "10-99"))
                counts[next((name for most, name in bins if size <= most), "100+")] += 1
    with capsys.disabled():
        print("\nrandom surfaces:", ", ".join(f"{name} {n}" for name, n in traits.items()))
        bars = ("1", "2", "3-4", "5-9", "10-99", "100+")
        print("optimal schemes:", ", ".join(f"{name}: {counts[name]}" for name in bars))
    assert traits["surfaces"] == chunks * PER_CHUNK * len(SURFACES)
    assert traits["one or the other"] >= 0.3 * traits["surfaces"]
    for name in ("cut in every optimum", "5 optima or more", "cracks", "live self-edges"):
        assert traits[name] >= 2 * chunks, name


@pytest.mark.parametrize("seed", range(30))
def test_brute_force_against_the_product_of_all_choices(seed: int) -> None:
    """The sweep over the cells that the solvers are held to, against trying everything at once."""
    instance = planar_graph(seed, 3, 5, 2, self_edges=seed % 2 == 1)
    assert minimum(instance) == literal_minimum(instance)
