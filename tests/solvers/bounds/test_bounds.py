"""Bounds beside the model: set cover, independent sets, crossings."""

from __future__ import annotations

import itertools
import math

from exhaustive_minima import minimum
from hypothesis import assume, given
from hypothesis import strategies as st
from library import PAPER
from vertex_minima import vertex_minimum

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, planar_graph
from cellcolor.solvers.bounds.cover import color_regions, hard_cells, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.cpsat.dart_graph import enough_crossings
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE = 0, 1
SEEDS = st.integers(0, 10**6)


@examples(15)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4))
def test_set_cover_is_a_lower_bound(seed: int, cells: int, colors: int) -> None:
    instance = planar_graph(seed, cells, cells + 3, colors)
    cover = set_cover(color_regions(instance)).regions
    assert set().union(*(touched for _, touched in cover)) == set(range(len(instance.cells)))
    assert len(cover) <= minimum(instance)


def test_set_cover_splits_colors_into_regions() -> None:
    # Two red cells that do not touch need a segment each.
    apart = Instance("apart", ("red",), (Cell(0, (RED,), ()), Cell(1, (RED,), ())), ())
    assert set_cover(color_regions(apart)).bound == 2


@examples(20)
@given(seed=SEEDS, cells=st.integers(1, 7), colors=st.integers(1, 4))
def test_hard_cells_need_as_many_regions_as_all(seed: int, cells: int, colors: int) -> None:
    """Against trying all sets of regions; strangers wherever there are as many of them."""
    instance = planar_graph(seed, cells, cells + 3, colors)
    regions = [touched for _, touched in color_regions(instance)]
    value = set_cover(color_regions(instance)).bound
    found = hard_cells(instance, value)
    assert found is not None
    for chosen in itertools.combinations(regions, min(value - 1, len(regions))):
        assert not set(found) <= set().union(*chosen)

    def apart(cells: tuple[int, ...]) -> bool:
        return all(len(touched.intersection(cells)) < 2 for touched in regions)

    sets_of_strangers = filter(apart, itertools.combinations(range(len(instance.cells)), value))
    assert (len(found) == value) == any(True for _ in sets_of_strangers)


def test_crossings_that_are_enough() -> None:
    """X and Y of the corridors share red and blue, and each touches two cells of one color more."""
    instance = Instance.read(PAPER / "parallel-corridors.json")
    enough = enough_crossings(instance)
    assert enough == {edge: 2 if edge == 2 else 1 for edge in (1, 2, 3, 5, 7)}


def test_a_ring_of_cells_that_share_two_colors_bounds_no_crossings() -> None:
    cells = tuple(Cell(i, (RED, BLUE), ((i + 1, -((i - 1) % 3 + 1)),)) for i in range(3))
    edges = tuple(Edge(i + 1, i, (i + 1) % 3) for i in range(3))
    instance = Instance("ring of three", ("red", "blue"), cells, edges)
    assert set(enough_crossings(instance).values()) == {math.inf}


@examples(20)
@given(seed=SEEDS, cells=st.integers(2, 6), colors=st.integers(2, 3))
def test_more_crossings_than_enough_gain_nothing(seed: int, cells: int, colors: int) -> None:
    """Against the reference solver, which knows nothing of this, with one strand more."""
    instance = planar_graph(seed, cells, cells + 2, colors)
    enough = max(enough_crossings(instance).values(), default=1)
    assume(enough <= 2)
    strands = int(enough)
    found = solve(instance, Options(search_space="surface", strands=strands))
    assert found.proved_for_surface
    wider = Options(search_space="surface", strands=strands + 1)
    assert solve(instance, wider, "dfs-cover").segments == found.segments


@examples(12)
@given(seed=SEEDS, colors=st.integers(2, 3), cracks=st.integers(0, 2))
def test_the_surface_bound_holds_for_vertex_colorings(seed: int, colors: int, cracks: int) -> None:
    """No painting of the mesh's vertices, found without the graph, has fewer segments."""
    surface = blobs(seed, size=5, colors=colors, waves=0.5, cracks=cracks)
    instance = decompose(surface)
    assume(1 < len(instance.cells) < 9)
    found = solve(instance, Options())
    assert found.surface_lower_bound <= vertex_minimum(surface)
