"""Conflicts: pairs of segments that would have to cross, against paths on the mesh itself."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, product

from conflicts import conflicts
from hypothesis import given, reject
from hypothesis import strategies as st
from library import PAPER
from meshes import grid_faces, grid_points, surface
from rooms import can_pass, crossed_rings, graph, hub, petal_cells
from vertex_minima import vertex_minimum

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.solvers.bounds.conflicts import MergedCell
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE, GREEN = 0, 1, 2


def areas(pair: tuple[MergedCell, MergedCell]) -> tuple[list[int], list[int]]:
    one, other = pair
    return sorted(one), sorted(other)


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
    instance = graph(
        ((RED, BLUE), (1, 2, 3, 4)),
        ((RED,), (-1, 5)),
        ((BLUE,), (-2,)),
        ((RED,), (-3, -5)),
        ((BLUE,), (-4,)),
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
    instance = graph(((RED, BLUE), (5, 1, 2, 3, 4), (-5,)), *petal_cells(RED, BLUE, RED, BLUE))
    red, blue = color_regions(instance)
    assert conflicts(instance, red, blue) == []
    found = solve(instance, Options())
    assert (found.segments, found.lower_bound) == (2, 2)


def test_a_conflict_is_proved_for_any_division() -> None:
    """Red from top to bottom and blue from left to right, over two cells of both colors.

    Nothing limits how often the edge between these two is crossed, and one strand is tried.
    """
    instance = graph(
        ((RED,), (1, 2)),
        ((RED,), (3, 4)),
        ((RED, BLUE), (-1, 5, -3, 6)),
        ((RED, BLUE), (-2, -6, -4, 7)),
        ((BLUE,), (-5,)),
        ((BLUE,), (-7,)),
    )
    assert set_cover(color_regions(instance)).bound == 2
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


@examples(30)
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


@examples(30)
@given(mesh=framed(5, 7))
def test_the_surface_bound_holds_where_segments_are_in_conflict(mesh: LabelledSurface) -> None:
    """Against a sweep over vertex colorings, which knows no cells."""
    found = solve(decompose(mesh), Options())
    assert found.surface_lower_bound <= vertex_minimum(mesh)


def test_a_handle_of_one_color_leads_nobody_past() -> None:
    """Petals in turn; one of the red ones is a torus with a hole, which blue never enters."""
    with_handle = ((RED,), (-1, 5, 6, -5, -6))
    instance = graph(
        ((RED, BLUE), (1, 2, 3, 4)), with_handle, *petal_cells(RED, BLUE, RED, BLUE)[1:]
    )
    red, blue = color_regions(instance)
    (found,) = conflicts(instance, red, blue)
    assert (areas(found.one), areas(found.other)) == (([1], [3]), ([2], [4]))
    assert solve(instance, Options()).surface_lower_bound == 3


@examples(30)
@given(mesh=crossed_rings())
def test_what_is_in_conflict_cannot_pass_around_a_handle(mesh: LabelledSurface) -> None:
    """Against trying all paths over mesh vertices."""
    try:
        instance = decompose(mesh, "mesh")
    except InputError:
        reject()
    assert instance.surface is not None
    cell_of = instance.surface.vertex_cell
    first, second = ([r for r in color_regions(instance) if r[0] == color] for color in (RED, BLUE))
    for one_region, other_region in product(first, second):
        for found in conflicts(instance, one_region, other_region):
            one, other = (
                [{v for v, c in enumerate(cell_of) if c in area} for area in pair]
                for pair in (found.one, found.other)
            )
            assert not can_pass(mesh, (RED, BLUE), one, other)
