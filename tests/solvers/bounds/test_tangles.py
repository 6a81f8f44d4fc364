"""Tangles: segments that fit two at a time only, against colorings of mesh vertices."""

from __future__ import annotations

from itertools import combinations, product

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rooms import ISLAND_BETWEEN, ROUND_A_PETAL, can_be_drawn, room, rooms
from vertex_minima import vertex_minimum

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.decomposition import decompose
from cellcolor.solvers.bounds.cover import color_regions, set_cover
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.solvers.bounds.tangles import TangledSegment, Tangles, Touching
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options
from examples import examples

RED, BLUE, GREEN = 0, 1, 2


def tangles_of(instance: Instance) -> Tangles:
    own = {cell.id: frozenset(cell.colors) for cell in instance.cells}
    return Tangles(merge_cells(instance, own), color_regions(instance))


def all_petals(instance: Instance) -> list[Touching]:
    """One segment for each color, that touches all of its petals."""
    return [
        Touching(number, tuple(sorted(cells - {0})))
        for number, (_, cells) in enumerate(color_regions(instance))
    ]


def test_three_segments_that_fit_two_at_a_time() -> None:
    tangles = tangles_of(ISLAND_BETWEEN)
    plan = all_petals(ISLAND_BETWEEN)
    (found,) = tangles.find(plan, NEVER)
    groups = {own.region: set(own.groups) for own in found.segments}
    assert groups == {
        RED: {frozenset({1}), frozenset({3})},
        BLUE: {frozenset({2}), frozenset({5})},
        GREEN: {frozenset({4}), frozenset({6})},
    }
    for two in combinations(plan, 2):
        assert tangles.find(two, NEVER) == []


def test_their_minimum_is_proved() -> None:
    assert set_cover(ISLAND_BETWEEN).bound == 3
    found = solve(ISLAND_BETWEEN, Options())
    assert (found.segments, found.surface_lower_bound) == (4, 4)


@pytest.mark.parametrize(
    "instance",
    [
        # Red passes between the islands, or blue and green reach the one from the same side.
        room((RED, BLUE, RED, GREEN), (BLUE,), (GREEN,)),
        room((RED, RED, BLUE, GREEN), (BLUE, GREEN)),
    ],
)
def test_no_tangle_where_all_can_be_drawn(instance: Instance) -> None:
    assert tangles_of(instance).find(all_petals(instance), NEVER) == []
    assert solve(instance, Options()).segments == 3


def test_a_handle_leads_past() -> None:
    """The same room with a handle: nothing is concluded where ways may cross oddly."""
    island = ISLAND_BETWEEN
    (outer, inner), *_ = [cell.loops for cell in island.cells]
    with_handle = Instance(
        "handle",
        island.colors,
        (Cell(0, (RED, BLUE, GREEN), ((*outer, 7), inner, (-7,))), *island.cells[1:]),
        (*island.edges, Edge(7, 0, 0)),
    )
    assert tangles_of(with_handle).find(all_petals(with_handle), NEVER) == []


def test_a_handle_that_no_segment_can_use_changes_nothing() -> None:
    """The same handle in a fourth color: as the three segments see it, the surface is a plane."""
    island = ISLAND_BETWEEN
    (outer, inner), *_ = [cell.loops for cell in island.cells]
    with_handle = Instance(
        "handle",
        (*island.colors, "fourth"),
        (Cell(0, (RED, BLUE, GREEN, 3), ((*outer, 7), inner, (-7,))), *island.cells[1:]),
        (*island.edges, Edge(7, 0, 0, (3,))),
    )
    (found,) = tangles_of(with_handle).find(all_petals(with_handle)[:3], NEVER)
    assert len(found.segments) == 3


def test_a_way_round_a_cell_that_a_segment_does_not_touch() -> None:
    tangles = tangles_of(ROUND_A_PETAL)
    blue, red = Touching(BLUE, (3, 6)), Touching(RED, (2, 4))
    assert tangles.find([blue, red], NEVER) == []
    (found,) = tangles.find([blue, Touching(RED, (2, 4), frozenset({6}))], NEVER)
    assert set(found.segments) == {
        TangledSegment(BLUE, (frozenset({3}), frozenset({6}))),
        TangledSegment(RED, (frozenset({2}), frozenset({4})), frozenset({6})),
    }


def test_a_segment_does_not_pass_what_it_avoids() -> None:
    tangles = tangles_of(ROUND_A_PETAL)
    plan = [Touching(RED, (2, 4), frozenset({0})), Touching(BLUE, (0,))]
    (found,) = tangles.find(plan, NEVER)
    (own,) = found.segments
    assert (own.region, own.avoided) == (RED, {0})
    assert {min(group) for group in own.groups} == {2, 4}


def test_looking_for_tangles_ends_at_the_deadline() -> None:
    with pytest.raises(OutOfTime):
        tangles_of(ISLAND_BETWEEN).find(all_petals(ISLAND_BETWEEN), Deadline.after(0))


@examples(6)
@given(mesh=rooms(6, 7), data=st.data())
def test_what_is_tangled_cannot_be_drawn_on_the_mesh(
    mesh: LabelledSurface, data: st.DataObject
) -> None:
    """Against trying all paths over mesh vertices, without cells, edges or parities."""
    instance = decompose(mesh, "mesh")
    assert instance.surface is not None
    cell_of = instance.surface.vertex_cell

    def vertices(cell: int) -> set[int]:
        return {v for v, own in enumerate(cell_of) if own == cell}

    regions = color_regions(instance)
    ends: list[tuple[int, tuple[int, ...]]] = []
    for number, (_, cells) in enumerate(regions):
        small = sorted(cell for cell in cells if len(instance.cells[cell].colors) < 3)
        if len(small) > 1:
            two = st.lists(st.sampled_from(small), min_size=2, max_size=2, unique=True)
            ends.append((number, tuple(data.draw(two))))
    every = {cell for _, cells in ends for cell in cells}
    plan = [
        Touching(
            number,
            cells,
            frozenset(data.draw(st.sets(st.sampled_from(sorted(every)))) & regions[number][1])
            - set(cells),
        )
        for number, cells in ends
    ]
    for tangle in tangles_of(instance).find(plan, NEVER):
        for chosen in product(*(product(*map(sorted, own.groups)) for own in tangle.segments)):
            segments = [
                (
                    regions[own.region][0],
                    [vertices(cell) for cell in cells],
                    set[int]().union(*map(vertices, own.avoided)),
                )
                for own, cells in zip(tangle.segments, chosen, strict=True)
            ]
            assert all(len(ends) == 2 for _, ends, _ in segments)
            assert not can_be_drawn(mesh, segments)


@examples(12)
@given(mesh=rooms(6, 7))
def test_the_bound_holds_on_the_mesh(mesh: LabelledSurface) -> None:
    """Against a sweep over vertex colorings, which knows no cells."""
    found = solve(decompose(mesh), Options())
    assert found.surface_lower_bound <= vertex_minimum(mesh)
