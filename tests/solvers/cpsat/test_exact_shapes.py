"""Exact minima of trees, wheels and hubs: against brute force, with a division that has them."""

from __future__ import annotations

import random

import pytest
from dart_graphs import graph_of
from exhaustive_minima import minimum
from hypothesis import given
from hypothesis import strategies as st
from library import INSTANCES

from cellcolor.checker.division import check_division
from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.lab.families import hub_grid
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat import exact_shapes
from cellcolor.solvers.cpsat.dart_graph import split
from cellcolor.solvers.cpsat.exact_shapes import exact_minimum, painting_of_areas
from cellcolor.solvers.cpsat.painting import division_of
from cellcolor.solvers.interface import Options
from examples import examples

SEEDS = st.integers(0, 10**6)


def graph_with(colors: list[set[int]], edges: list[tuple[int, int]], seed: int) -> Instance:
    """Cells with darts in any order, so that the surface may have handles."""
    chance = random.Random(seed)
    darts: list[list[int]] = [[] for _ in colors]
    for number, (left, right) in enumerate(edges, start=1):
        darts[left].append(number)
        darts[right].append(-number)
    for own in darts:
        chance.shuffle(own)
    cells = tuple(
        Cell(number, tuple(sorted(own)), (tuple(loop),) if loop else ())
        for number, (own, loop) in enumerate(zip(colors, darts, strict=True))
    )
    names = tuple(f"color {color}" for color in range(1 + max(map(max, colors))))
    return Instance("graph", names, cells, tuple(Edge(n, *e) for n, e in enumerate(edges, start=1)))


def a_tree(seed: int, cells: int, colors: int) -> Instance:
    chance = random.Random(seed)
    own = [set(chance.choices(range(colors), k=chance.randint(1, 3))) for _ in range(cells)]
    edges = [(chance.randrange(cell), cell) for cell in range(1, cells)]
    return graph_with(own, edges, seed)


def a_wheel(seed: int, petals: int, colors: int) -> Instance:
    """The rim may have gaps."""
    chance = random.Random(seed)
    own = [set(chance.choices(range(colors), k=chance.randint(1, 3))) for _ in range(petals)]
    cells = [Cell(0, tuple(range(colors)), (tuple(range(1, petals + 1)),))]
    edges = [Edge(n, 0, n) for n in range(1, petals + 1)]
    rim = [n for n in range(1, petals + 1) if chance.random() < 0.8]
    edges += [Edge(petals + n, n, n % petals + 1) for n in rim]
    for n in range(1, petals + 1):
        before = (n - 2) % petals + 1
        darts = [
            -n,
            *([petals + n] if n in rim else ()),
            *([-petals - before] if before in rim else ()),
        ]
        cells.append(Cell(n, tuple(sorted(own[n - 1])), (tuple(darts),)))
    return Instance("wheel", tuple("abcdef"[:colors]), tuple(cells), tuple(edges))


def some_hubs(seed: int, hubs: int, petals: int, edges: int) -> Instance:
    """Hubs that share petals, several times perhaps, and petals beside each other."""
    chance = random.Random(seed)
    own = [{0, 1, 2}] * hubs + [{chance.randrange(3)} for _ in range(petals)]
    pairs = [(chance.randrange(hubs), hubs + chance.randrange(petals)) for _ in range(edges)]
    if petals > 1 and chance.random() < 0.5:
        pairs.append((hubs, hubs + 1))
    return graph_with(own, pairs, seed)


def exact(instance: Instance, *, certain: bool = True) -> int | None:
    """The sum of the parts' minima; each part's division is legal and has as many segments."""
    total: int | None = 0
    for part, _ in split(instance):
        found = exact_minimum(part, NEVER)
        assert found is not None or not certain
        if found is None:
            total = None
            continue
        segments, areas = found
        graph = graph_of(part)
        painting = painting_of_areas(graph, areas)
        report = check_division(part, division_of(graph, painting), seams=())
        assert report.valid, report.problems
        assert report.segments == segments
        total = None if total is None else total + segments
    return total


@examples(60)
@given(seed=SEEDS, cells=st.integers(1, 8), colors=st.integers(1, 4))
def test_trees(seed: int, cells: int, colors: int) -> None:
    instance = a_tree(seed, cells, colors)
    assert exact(instance) == minimum(instance)


@examples(60)
@given(seed=SEEDS, petals=st.integers(3, 6), colors=st.integers(2, 4))
def test_wheels(seed: int, petals: int, colors: int) -> None:
    instance = a_wheel(seed, petals, colors)
    assert exact(instance) == minimum(instance)


@examples(60)
@given(seed=SEEDS, hubs=st.integers(1, 3), petals=st.integers(1, 5), edges=st.integers(1, 9))
def test_hubs_that_share_petals(seed: int, hubs: int, petals: int, edges: int) -> None:
    instance = some_hubs(seed, hubs, petals, edges)
    assert exact(instance) == minimum(instance)


@pytest.mark.parametrize(
    ("name", "segments"),
    [("2x2x3", 16), ("3x3x2", 22), ("4x4x2", 32), ("5x5x2", 48), ("6x6x2", 63)],
)
def test_grids_of_hubs(name: str, segments: int) -> None:
    """Their minima were proved by a CP-SAT model, most of them by clingo as well."""
    instance = Instance.read(INSTANCES / "hubs" / f"hub_grid_{name}.json")
    assert exact(instance) == segments


def test_other_shapes_are_left_to_others() -> None:
    """Cells with several colors beside each other, on a cycle."""
    square = [(0, 1), (1, 2), (2, 3), (3, 0)]
    assert exact(graph_with([{0, 1}] * 4, square, 0), certain=False) is None


def test_limits_leave_hubs_to_others(monkeypatch: pytest.MonkeyPatch) -> None:
    instance = hub_grid(0, 3, 3, 2, 3)
    assert exact(instance) is not None
    for limit in ("MOST_STATES", "MOST_WAYS"):
        with monkeypatch.context() as patch:
            patch.setattr(exact_shapes, limit, 1)
            assert exact(instance, certain=False) is None


def test_no_time() -> None:
    ((part, _),) = split(a_tree(0, 5, 1))
    with pytest.raises(OutOfTime):
        exact_minimum(part, Deadline.after(-1))


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 8), strands=st.sampled_from((1, 2)))
def test_the_solver_claims_no_more_than_holds(seed: int, cells: int, strands: int) -> None:
    """With two strands an edge of a tree may be crossed twice, and there may be fewer segments."""
    instance = a_tree(seed, cells, 3)
    options = Options(
        search_space="surface" if strands > 1 else "paper", strands=strands, workers=1
    )
    assert solve(instance, options).segments == solve(instance, options, "dfs-cover").segments
