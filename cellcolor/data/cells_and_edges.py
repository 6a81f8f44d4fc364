"""Cells, edges and darts, and the rules that make them a topological graph."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import overload

from pydantic import NonNegativeFloat

from cellcolor.data.value import Value
from cellcolor.data.wording import count, listed
from cellcolor.errors import refuse
from cellcolor.files.validation import Ascending

OUTSIDE = -1
"""The index of everything that no configuration reaches, and of what lies beyond the mesh."""


@dataclass(frozen=True, slots=True)
class Cell(Value):
    """A connected part of the surface whose points have the same available colors.

    Attributes:
        id: position in the instance.
        colors: ids of the available colors, ascending, at least one.
        loops: border loops as cyclic lists of darts, the cell on the left.
        area: square metres, if known.
    """

    id: int
    colors: Ascending
    loops: tuple[tuple[int, ...], ...]
    area: NonNegativeFloat | None = None

    def __str__(self) -> str:
        numbers = "color" if len(self.colors) == 1 else "colors"
        size = "" if self.area is None else f", {self.area:.4g} m²"
        return (
            f"cell {self.id}: {numbers} {listed(self.colors)}, "
            f"{count(sum(map(len, self.loops)), 'dart')} on {count(len(self.loops), 'loop')}{size}"
        )


@dataclass(frozen=True, slots=True)
class Edge(Value):
    """A topological edge: a maximal border curve between the same two areas.

    Attributes:
        id: positive; ``+id`` is its dart in the cell on the left, ``-id`` on the right.
        left: cell on the left, or ``OUTSIDE``.
        right: cell on the right, or ``OUTSIDE``.
        colors: the joinable colors, ascending, if they are fewer than the two cells share; None
            otherwise.
        length: metres, if known.
    """

    id: int
    left: int
    right: int
    colors: Ascending | None = None
    length: NonNegativeFloat | None = None

    def __str__(self) -> str:
        left, right = (
            "the outside" if cell == OUTSIDE else f"cell {cell}" for cell in (self.left, self.right)
        )
        size = "" if self.length is None else f", {self.length:.4g} m"
        few = "" if self.colors is None else f", joinable colors: {listed(self.colors)}"
        return f"edge {self.id}: {left} on its left, {right} on its right{few}{size}"


def shared_colors(cells: Sequence[Cell], edge: Edge) -> set[int]:
    """The colors that the cells on both sides of an edge have, whether or not they are cracked."""
    if OUTSIDE in (edge.left, edge.right):
        return set()
    return set(cells[edge.left].colors) & set(cells[edge.right].colors)


def check_graph(cells: Sequence[Cell], edges: Sequence[Edge], color_count: int) -> None:
    """Reject anything that is not a topological graph.

    Raises:
        InputError: anything that ``docs/formats.md`` forbids, with field and element.
    """
    refuse(_faults_of_cells(cells, color_count))
    refuse(_faults_of_edges(cells, edges, color_count))
    refuse(_faults_of_darts(cells, edges))


_Faults = Iterator[tuple[str, str]]
"""Fields, and what is wrong with them."""


def _faults_of_cells(cells: Sequence[Cell], color_count: int) -> _Faults:
    for position, cell in enumerate(cells):
        where = f"cells[{position}]"
        if cell.id != position:
            yield f"{where}.id", f"cell ids are 0, 1, 2, … in this order; is {cell.id}"
        if not cell.colors:
            yield f"{where}.colors", f"cell {cell.id} has no color"
        yield from _faults_of_colors(cell.colors, color_count, f"{where}.colors")
        for number, loop in enumerate(cell.loops):
            if not loop:
                yield f"{where}.loops[{number}]", "a loop without darts"


def _faults_of_edges(cells: Sequence[Cell], edges: Sequence[Edge], color_count: int) -> _Faults:
    seen: set[int] = set()
    for position, edge in enumerate(edges):
        where = f"edges[{position}]"
        if edge.id < 1:
            yield f"{where}.id", f"must be positive, is {edge.id}"
        if edge.id in seen:
            yield f"{where}.id", f"edge {edge.id} appears twice"
        seen.add(edge.id)
        for side, cell in (("left", edge.left), ("right", edge.right)):
            if not OUTSIDE <= cell < len(cells):
                yield f"{where}.{side}", f"no cell {cell} in this instance"
        if edge.left == OUTSIDE and edge.right == OUTSIDE:
            yield where, f"edge {edge.id} has -1 on both sides"
        yield from _faults_of_colors(edge.colors or (), color_count, f"{where}.colors")
        for color in sorted(set(edge.colors or ()) - shared_colors(cells, edge)):
            sides = f"cells {edge.left} and {edge.right}"
            yield f"{where}.colors", f"color {color} is not shared by {sides}"


def _faults_of_darts(cells: Sequence[Cell], edges: Sequence[Edge]) -> _Faults:
    owner = {edge.id: edge.left for edge in edges}
    owner |= {-edge.id: edge.right for edge in edges}
    seen: set[int] = set()
    for cell in cells:
        for number, loop in enumerate(cell.loops):
            for place, dart in enumerate(loop):
                where = f"cells[{cell.id}].loops[{number}][{place}]"
                if dart not in owner:
                    yield where, f"dart {dart} belongs to no edge"
                if owner[dart] != cell.id:
                    has = f"{owner[dart]} on its {'left' if dart > 0 else 'right'}"
                    message = f"dart {dart} is not cell {cell.id}'s: edge {abs(dart)} has {has}"
                    yield where, f"{message}, so this loop does not close"
                if dart in seen:
                    yield where, f"dart {dart} appears twice"
                seen.add(dart)
    for position, edge in enumerate(edges):
        for dart in (edge.id, -edge.id):
            if owner[dart] != OUTSIDE and dart not in seen:
                message = f"dart {dart} is missing from the loops of cell {owner[dart]}"
                yield f"edges[{position}]", f"{message}, so they do not close"


def _faults_of_colors(colors: Sequence[int], count: int, where: str) -> _Faults:
    """What is no set of colors; they are in order by now, so no place is named."""
    for color in colors:
        if not 0 <= color < count:
            yield where, f"unknown color {color}"
    for color, following in pairwise(colors):
        if color == following:
            yield where, f"color {color} appears twice"


def faults_of_color_names(colors: Sequence[str]) -> _Faults:
    """Color names that are not distinct: plans and pictures refer to colors by name."""
    first: dict[str, int] = {}
    for number, name in enumerate(colors):
        if first.setdefault(name, number) != number:
            yield f"colors[{number}]", f"{name!r} is the name of color {first[name]} already"


DartName = int | tuple[int, int]
"""A dart ``±e``, or ``(±e, strand)`` where an edge or a seam has several parallel strands, which
are numbered from 1 along ``+e``."""

Strand = tuple[int, int]
"""A dart and its strand."""


def strand_of(dart: DartName) -> Strand:
    """A dart with its strand; one that is named without a strand has its edge's only one."""
    return (dart, 1) if isinstance(dart, int) else dart


@overload
def twin(dart: Strand) -> Strand: ...
@overload
def twin(dart: DartName) -> DartName: ...
def twin(dart: DartName) -> DartName:
    """The other side of the same edge, or of the same strand of it."""
    return -dart if isinstance(dart, int) else (-dart[0], dart[1])
