"""Bounds and reductions beside the model: set cover, strangers, dominated colors, crossings."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

from bruteforce import minimum, vertex_minimum
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from library import PAPER
from ortools.sat.python import cp_model

from cellcolor.data.instance import Cell, Edge, Instance
from cellcolor.decomposition import decompose
from cellcolor.families import blobs, planar_graph
from cellcolor.solvers.bounds import color_regions, set_cover, smallest_covers, strangers
from cellcolor.solvers.cpsat.refutation import cover_colors, is_refuted
from cellcolor.solvers.crossings import enough_crossings
from cellcolor.solvers.interface import Options
from cellcolor.solvers.merging import bundled, merged, simplified
from cellcolor.solvers.reductions import drop_dominated
from cellcolor.solvers.run import solve

RED, BLUE = 0, 1
SEEDS = st.integers(0, 10**6)


@settings(max_examples=30, deadline=None)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4))
def test_set_cover_is_a_lower_bound(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    cover = set_cover(instance)
    assert set().union(*(touched for _, touched in cover)) == set(range(len(instance.cells)))
    assert len(cover) <= minimum(instance)


def test_set_cover_splits_colors_into_regions() -> None:
    # Two red cells that do not touch need a segment each.
    apart = Instance("apart", ("red",), (Cell(0, (RED,), ()), Cell(1, (RED,), ())), ())
    assert len(set_cover(apart)) == 2


@settings(max_examples=30, deadline=None)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(2, 4))
def test_dropping_dominated_colors_keeps_the_minimum(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    reduced = drop_dominated(instance)
    assert all(own <= set(cell.colors) for own, cell in zip(reduced, instance.cells, strict=True))
    assert minimum(with_colors(instance, reduced)) == minimum(instance)


def with_colors(instance: Instance, colors: tuple[frozenset[int], ...]) -> Instance:
    """The instance with fewer colors a cell."""
    cells = tuple(
        replace(cell, colors=tuple(sorted(own)))
        for cell, own in zip(instance.cells, colors, strict=True)
    )
    edges = []
    for edge in instance.edges:
        left = instance.joinable(edge.id)
        if left:
            left = tuple(c for c in left if c in colors[edge.left] & colors[edge.right])
        edges.append(replace(edge, colors=left))
    return replace(instance, cells=cells, edges=tuple(edges))


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4))
def test_strangers_share_no_region(seed: int, cells: int, colors: int) -> None:
    """Against trying all sets of cells."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    regions = [touched for _, touched in color_regions(instance)]

    def apart(chosen: tuple[int, ...]) -> bool:
        return all(len(touched.intersection(chosen)) < 2 for touched in regions)

    found = strangers(instance)
    assert apart(tuple(found)) and len(found) <= len(set_cover(instance))
    more = itertools.combinations(range(len(instance.cells)), len(found) + 1)
    assert not any(map(apart, more))


def test_a_color_is_not_dominated_by_one_that_an_edge_keeps_out() -> None:
    """Cells 0 and 1 have red and blue, but blue goes from one to the other through cell 2 only.

    There a green corridor from 3 to 4 would be in its way: red is needed for 2 segments.
    """
    green = 2
    instance = Instance(
        "way round",
        ("red", "blue", "green"),
        (
            Cell(0, (RED, BLUE), ((1, 2),)),
            Cell(1, (RED, BLUE), ((-1, 3),)),
            Cell(2, (BLUE, green), ((-2, 4, -3, 5),)),
            Cell(3, (green,), ((-4,),)),
            Cell(4, (green,), ((-5,),)),
        ),
        (
            Edge(1, 0, 1, (RED,)),
            Edge(2, 0, 2),
            Edge(3, 1, 2),
            Edge(4, 2, 3),
            Edge(5, 2, 4),
        ),
    )
    assert minimum(instance) == 2
    assert solve(instance, Options()).segments == 2


def test_a_crack_keeps_a_color_from_being_dominated() -> None:
    # Blue is everywhere where red is, but only red passes the one edge.
    instance = Instance.read(PAPER / "dominated-by-crack.json")
    assert drop_dominated(instance) == (frozenset({RED}), frozenset({RED}))
    assert solve(instance, Options()).segments == 1


def test_crossings_that_are_enough() -> None:
    """X and Y of the corridors share red and blue, and each touches two cells of one color more."""
    instance = Instance.read(PAPER / "parallel-corridors.json")
    colors = [frozenset(cell.colors) for cell in instance.cells]
    enough = enough_crossings(instance, colors)
    assert enough == {edge: 2 if edge == 2 else 1 for edge in (1, 2, 3, 5, 7)}


def test_a_ring_of_cells_that_share_two_colors_bounds_no_crossings() -> None:
    cells = tuple(Cell(i, (RED, BLUE), ((i + 1, -((i - 1) % 3 + 1)),)) for i in range(3))
    edges = tuple(Edge(i + 1, i, (i + 1) % 3) for i in range(3))
    instance = Instance("ring of three", ("red", "blue"), cells, edges)
    both = [frozenset({RED, BLUE})] * 3
    assert set(enough_crossings(instance, both).values()) == {math.inf}


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS, cells=st.integers(2, 6), colors=st.integers(2, 3))
def test_more_crossings_than_enough_gain_nothing(seed: int, cells: int, colors: int) -> None:
    """Against the reference solver, which knows nothing of this, with one strand more."""
    instance = planar_graph(seed, cells, cells + 2, colors)
    enough = max(enough_crossings(instance, drop_dominated(instance)).values(), default=1)
    assume(enough <= 2)
    strands = int(enough)
    found = solve(instance, Options(search_space="surface", strands=strands))
    assert found.proved_for_surface
    wider = Options(search_space="surface", strands=strands + 1)
    assert solve(instance, wider, "dfs").segments == found.segments


@settings(max_examples=25, deadline=None)
@given(seed=SEEDS, colors=st.integers(2, 3), cracks=st.integers(0, 2))
def test_the_surface_bound_holds_for_vertex_colorings(seed: int, colors: int, cracks: int) -> None:
    """No painting of the mesh's vertices, found without the graph, has fewer segments."""
    surface = blobs(seed, size=5, colors=colors, waves=0.5, cracks=cracks)
    instance = decompose(surface)
    assume(1 < len(instance.cells) < 9)
    found = solve(instance, Options())
    assert found.surface_lower_bound <= vertex_minimum(surface)


@settings(max_examples=12, deadline=None)
@given(seed=SEEDS, cells=st.integers(2, 6), colors=st.integers(1, 3))
def test_a_simplified_graph_is_a_lower_bound(seed: int, cells: int, colors: int) -> None:
    """Every bundle crossed as often as it has edges; against brute force on the whole graph."""
    instance = planar_graph(seed, cells, cells + 5, colors)
    own = tuple(frozenset(cell.colors) for cell in instance.cells)
    smaller, parallel = simplified(instance, own)
    assert sum(parallel.values()) <= sum(bool(instance.joinable(e.id)) for e in instance.edges)
    assert len(smaller.cells) <= len(instance.cells)
    most = max(parallel.values(), default=1)
    assume(most <= 2)
    options = Options(search_space="surface", strands=most)
    assert solve(smaller, options, "dfs").segments <= minimum(instance)  # type: ignore[operator]


def test_two_cells_that_nothing_separates_become_one() -> None:
    """A row of three cells of red and blue; the crack on the last edge lets only red through."""
    cells = tuple(
        Cell(i, (RED, BLUE), loops) for i, loops in enumerate((((1,),), ((-1, 2),), ((-2,),)))
    )
    instance = Instance("row", ("red", "blue"), cells, (Edge(1, 0, 1), Edge(2, 1, 2, (RED,))))
    smaller = merged(instance, [frozenset({RED, BLUE})] * 3)
    assert [cell.loops for cell in smaller.cells] == [((2,),), ((-2,),)]
    assert [(edge.left, edge.right, edge.colors) for edge in smaller.edges] == [(0, 1, (RED,))]


def test_merging_around_a_cell_leaves_a_hole() -> None:
    """Two half rings of red and blue between a cell inside and one outside."""
    instance = Instance(
        "ring",
        ("red", "blue", "green"),
        (
            Cell(0, (RED, BLUE), ((1, 2, 3, 5),)),
            Cell(1, (RED, BLUE), ((-1, 6, -3, 4),)),
            Cell(2, (2, RED), ((-2, -4),)),
            Cell(3, (RED,), ((-5, -6),)),
        ),
        (Edge(1, 0, 1), Edge(2, 0, 2), Edge(3, 0, 1), Edge(4, 1, 2), Edge(5, 0, 3), Edge(6, 1, 3)),
    )
    smaller = merged(instance, [frozenset(cell.colors) for cell in instance.cells])
    loops = {frozenset(loop) for loop in smaller.cells[0].loops}
    assert loops == {frozenset({2, 4}), frozenset({5, 6})}


def test_parallel_edges_become_one() -> None:
    cells = (Cell(0, (RED,), ((1, 2, 3),)), Cell(1, (RED, BLUE), ((-3, -2, -1),)))
    instance = Instance(
        "pair", ("red", "blue"), cells, (Edge(1, 0, 1), Edge(2, 0, 1), Edge(3, 0, 1))
    )
    smaller, count = bundled(instance)
    assert list(count.values()) == [3]
    (edge,) = count
    assert [cell.loops for cell in smaller.cells] == [((edge,),), ((-edge,),)]
    # In the same order on both sides they are not parallel: the surface between them is twisted.
    twisted = replace(instance, cells=(cells[0], replace(cells[1], loops=((-1, -2, -3),))))
    assert len(bundled(twisted)[1]) > 1


@settings(max_examples=40, deadline=None)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4))
def test_smallest_covers(seed: int, cells: int, colors: int) -> None:
    """Against trying all sets of regions."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    own = [frozenset(cell.colors) for cell in instance.cells]
    size = len(set_cover(instance))
    every = [
        frozenset(chosen)
        for chosen in itertools.combinations(color_regions(instance), size)
        if len(set().union(*(touched for _, touched in chosen))) == cells
    ]
    found = smallest_covers(instance, own, size, 10**6)
    assert sorted(map(hash, map(frozenset, found))) == sorted(map(hash, every))
    assert smallest_covers(instance, own, size, 0) == []


@settings(max_examples=60, deadline=None)
@given(seed=SEEDS, cells=st.integers(2, 7), colors=st.integers(1, 3))
def test_only_covers_that_cannot_be_painted_are_refuted(seed: int, cells: int, colors: int) -> None:
    """Against brute force with the cover's colors alone."""
    instance = planar_graph(seed, cells, cells + 4, colors)
    own = [frozenset(cell.colors) for cell in instance.cells]
    size = len(set_cover(instance))
    for cover in smallest_covers(instance, own, size, 20):
        solver = cp_model.CpSolver()
        refuted = is_refuted(instance, cover, solver, lambda s, m: s.solve(m))
        fewest = minimum(with_colors(instance, cover_colors(instance, cover)))
        assert fewest > size if refuted else fewest >= size


def test_a_cover_is_refuted() -> None:
    """Red and blue petals in turn: the colors cover the hub, but only one can cross it."""
    petals = (RED, BLUE, RED, BLUE)
    instance = Instance(
        "hub",
        ("red", "blue"),
        (
            Cell(0, (RED, BLUE), ((1, 2, 3, 4),)),
            *(Cell(i, (color,), ((-i,),)) for i, color in enumerate(petals, start=1)),
        ),
        tuple(Edge(i, 0, i) for i in range(1, 5)),
    )
    # Petals of one color lie in one region, through the hub.
    (cover,) = smallest_covers(instance, [frozenset(c.colors) for c in instance.cells], 2, 9)
    assert is_refuted(instance, cover, cp_model.CpSolver(), lambda s, m: s.solve(m))
    assert solve(instance, Options()).lower_bound == 3
