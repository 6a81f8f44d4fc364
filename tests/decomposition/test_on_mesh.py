"""Where a graph lies on its mesh: what curves and cells of vertices say, held to the graph."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import assume, given
from library import PAPER
from meshes import drawn, surfaces

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import Decomposition, decomposition_of, locate
from cellcolor.errors import InputError


def found(surface: LabelledSurface) -> Decomposition:
    try:
        return decomposition_of(surface, "s.json")
    except InputError:  # a cell with a handle
        assume(False)
        raise


@given(surfaces())
def test_curves_lie_between_the_cells_of_their_edges(surface: LabelledSurface) -> None:
    """Every crossed mesh edge has the edge's cells on its sides and its joinable colors; every
    mesh edge between cells, and every crack, is crossed once on each side."""
    made = found(surface)
    crossed = set()
    inside = len(surface.vertices)
    for edge in made.instance.edges:
        for left, right in made.curves[edge.id]:
            sides = [made.vertex_cell[v] if v < inside else OUTSIDE for v in (left, right)]
            assert sides == [edge.left, edge.right]
            if OUTSIDE not in sides:
                shared = set(surface.vertex_colors[left]) & set(surface.vertex_colors[right])
                joinable = shared - surface.cracked(left, right)
                assert joinable == set(made.instance.joinable(edge.id))
            if right < inside:
                crossed.add(frozenset((left, right)))
    expected = {
        frozenset((a, b))
        for a, b in surface.left_of
        if made.vertex_cell[a] != made.vertex_cell[b] or surface.cracked(a, b)
    }
    assert crossed == expected


@given(surfaces())
def test_a_graph_that_was_read_is_found_again(surface: LabelledSurface) -> None:
    made = found(surface)
    # As a file has it that leaves out what can be measured.
    bare = replace(
        made.instance,
        cells=tuple(replace(cell, area=None) for cell in made.instance.cells),
        coverage=None,
    )
    again = locate(surface, bare, made.vertex_cell)
    assert (again.curves, again.vertex_cell) == (made.curves, made.vertex_cell)
    assert again.instance.coverage == made.instance.coverage
    for one, other in zip(again.instance.cells, made.instance.cells, strict=True):
        assert one.area == pytest.approx(other.area, abs=1e-9)


def test_no_curve_is_known_of_edges_that_somebody_else_has_numbered() -> None:
    surface = LabelledSurface.read(PAPER / "split-cell.surface.json")
    instance = Instance.read(PAPER / "split-cell.json")
    made = decomposition_of(surface)
    assert made.curves
    other = {edge.id: edge.id + 100 for edge in made.instance.edges}
    renumbered = replace(
        made.instance,
        edges=tuple(replace(edge, id=other[edge.id]) for edge in made.instance.edges),
        cells=tuple(
            replace(
                cell,
                loops=tuple(
                    tuple(other[d] if d > 0 else -other[-d] for d in loop) for loop in cell.loops
                ),
            )
            for cell in made.instance.cells
        ),
    )
    assert locate(surface, renumbered, made.vertex_cell).curves == {}
    assert len(instance.cells) == len(made.instance.cells)


def test_two_edges_alike_that_have_changed_their_numbers_are_noticed() -> None:
    """Above and below a hole: the same cells, the same colors, but not the same neighbors."""
    made = decomposition_of(drawn("aabb a..b aabb", {"a": [0, 1], "b": [0], ".": []}))
    alike = [e.id for e in made.instance.edges if (e.left, e.right) == (0, 1)]
    assert len(alike) == 2
    other = dict(zip(alike, reversed(alike), strict=True))
    cells = tuple(
        replace(
            cell,
            loops=tuple(
                tuple(other.get(abs(d), abs(d)) * (1 if d > 0 else -1) for d in loop)
                for loop in cell.loops
            ),
        )
        for cell in made.instance.cells
    )
    surface = drawn("aabb a..b aabb", {"a": [0, 1], "b": [0], ".": []})
    assert locate(surface, made.instance, made.vertex_cell).curves
    swapped = replace(made.instance, cells=cells)
    assert not locate(surface, swapped, made.vertex_cell).curves


def test_a_color_less_across_one_edge_is_noticed() -> None:
    surface = drawn("ab ab", {"a": [0, 1], "b": [0, 1, 2]})
    made = decomposition_of(surface)
    (live,) = made.instance.live_edges
    edges = tuple(
        replace(edge, colors=(0,)) if edge.id == live else edge for edge in made.instance.edges
    )
    assert locate(surface, made.instance, made.vertex_cell).curves
    assert not locate(surface, replace(made.instance, edges=edges), made.vertex_cell).curves
