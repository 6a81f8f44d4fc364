"""Make a disagreement small: leave out whatever it does not need."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import TypeVar

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import Crack, LabelledSurface

_Subject = TypeVar("_Subject")


def shrink_instance(
    instance: Instance, wrong: Callable[[Instance], bool], seconds: float
) -> Instance:
    """A smallest instance with the same fault (delta debugging): nothing more can be left out.

    Cells, edges, colors of cells and joinable colors of edges are left out one at a time, as long
    as there is time.
    """
    bare = replace(instance, meta=None, surface=None, known=None)
    return _shrink(bare, _smaller_instances, wrong, seconds)


def shrink_surface(
    surface: LabelledSurface, wrong: Callable[[LabelledSurface], bool], seconds: float
) -> LabelledSurface:
    """The same for a labelled surface: colors, points that are reached, colors of points, cracks.

    The mesh stays as it is.
    """
    return _shrink(surface, _smaller_surfaces, wrong, seconds)


def _shrink(
    subject: _Subject,
    smaller: Callable[[_Subject], Iterable[_Subject]],
    wrong: Callable[[_Subject], bool],
    seconds: float,
) -> _Subject:
    deadline = time.monotonic() + seconds
    while True:
        for candidate in smaller(subject):
            if time.monotonic() > deadline:
                return subject
            if wrong(candidate):
                subject = candidate
                break
        else:
            return subject


def _smaller_instances(instance: Instance) -> Iterator[Instance]:
    for cell in instance.cells:
        yield _without_cell(instance, cell.id)
    for edge in instance.edges:
        yield _without_edge(instance, edge.id)
    for cell in instance.cells:
        for color in cell.colors:
            if len(cell.colors) > 1:
                yield _without_color(instance, cell.id, color)
    for edge in instance.edges:
        for color in instance.joinable(edge.id):
            fewer = tuple(other for other in instance.joinable(edge.id) if other != color)
            edges = [replace(e, colors=fewer) if e is edge else e for e in instance.edges]
            yield replace(instance, edges=tuple(edges))


def _without_cell(instance: Instance, gone: int) -> Instance:
    """The instance without a cell, whose place becomes unreachable."""
    number = {OUTSIDE: OUTSIDE, gone: OUTSIDE}
    for cell in instance.cells:
        number.setdefault(cell.id, len(number) - 2)
    edges = tuple(
        Edge(
            edge.id,
            number[edge.left],
            number[edge.right],
            edge.colors if gone not in (edge.left, edge.right) else None,
        )
        for edge in instance.edges
        if number[edge.left] != OUTSIDE or number[edge.right] != OUTSIDE
    )
    cells = tuple(
        Cell(number[cell.id], cell.colors, cell.loops) for cell in instance.cells if cell.id != gone
    )
    return replace(instance, cells=cells, edges=edges)


def _without_edge(instance: Instance, gone: int) -> Instance:
    """The instance without an edge: as if it were dead, and left out as dead edges may be."""
    cells = []
    for cell in instance.cells:
        loops = (tuple(d for d in loop if abs(d) != gone) for loop in cell.loops)
        cells.append(Cell(cell.id, cell.colors, tuple(filter(None, loops))))
    edges = tuple(edge for edge in instance.edges if edge.id != gone)
    return replace(instance, cells=tuple(cells), edges=edges)


def _without_color(instance: Instance, cell_id: int, color: int) -> Instance:
    cells = list(instance.cells)
    kept = tuple(own for own in cells[cell_id].colors if own != color)
    cells[cell_id] = replace(cells[cell_id], colors=kept)
    edges = tuple(
        replace(edge, colors=tuple(own for own in edge.colors if own != color))
        if edge.colors is not None and cell_id in (edge.left, edge.right)
        else edge
        for edge in instance.edges
    )
    return replace(instance, cells=tuple(cells), edges=edges)


def _smaller_surfaces(surface: LabelledSurface) -> Iterator[LabelledSurface]:
    reached = [v for v, colors in enumerate(surface.vertex_colors) if colors]
    for color in range(len(surface.colors)):
        if any(color in own for own in surface.vertex_colors):
            yield _recolored(surface, dict.fromkeys(reached, color))
    if surface.cracks:
        yield replace(surface, cracks=())
    for crack in surface.cracks:
        yield replace(surface, cracks=tuple(other for other in surface.cracks if other != crack))
    for vertex in reached:
        yield _recolored(surface, {vertex: None})
    for vertex in reached:
        for color in surface.vertex_colors[vertex]:
            if len(surface.vertex_colors[vertex]) > 1:
                yield _recolored(surface, {vertex: color})


def _recolored(surface: LabelledSurface, gone: dict[int, int | None]) -> LabelledSurface:
    """The surface without one color at each of the given vertices; None stands for all its
    colors."""
    colors = tuple(
        tuple(c for c in own if gone[vertex] not in (None, c)) if vertex in gone else own
        for vertex, own in enumerate(surface.vertex_colors)
    )
    cracks = []
    for crack in surface.cracks:
        common = set(colors[crack.i]) & set(colors[crack.j])
        left = tuple(color for color in crack.colors if color in common)
        if left:
            cracks.append(Crack(crack.i, crack.j, left))
    return replace(surface, vertex_colors=colors, cracks=tuple(cracks))
