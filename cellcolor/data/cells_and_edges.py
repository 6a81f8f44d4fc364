"""Cells, edges and darts, and the rules that make them a topological graph."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import overload

from pydantic import NonNegativeFloat

from cellcolor.data.value import Value
from cellcolor.data.wording import count, listed
from cellcolor.errors import InputError
from cellcolor.files.validation import settle

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
    colors: tuple[int, ...]
    loops: tuple[tuple[int, ...], ...]
    area: NonNegativeFloat | None = None

    def __post_init__(self) -> None:
        settle(self)
        object.__setattr__(self, "colors", tuple(sorted(self.colors)))

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
    colors: tuple[int, ...] | None = None
    length: NonNegativeFloat | None = None

    def __post_init__(self) -> None:
        settle(self)
        if self.colors is not None:
            object.__setattr__(self, "colors", tuple(sorted(self.colors)))

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
    _check_cells(cells, color_count)
    _check_edges(cells, edges, color_count)
    _check_darts(cells, edges)


def _check_cells(cells: Sequence[Cell], color_count: int) -> None:
    for position, cell in enumerate(cells):
        where = f"cells[{position}]"
        if cell.id != position:
            raise InputError(
                None, f"{where}.id", f"cell ids are 0, 1, 2, … in this order; is {cell.id}"
            )
        if not cell.colors:
            raise InputError(None, f"{where}.colors", f"cell {cell.id} has no color")
        _check_colors(cell.colors, color_count, f"{where}.colors")
        for number, loop in enumerate(cell.loops):
            if not loop:
                raise InputError(None, f"{where}.loops[{number}]", "a loop without darts")


def _check_edges(cells: Sequence[Cell], edges: Sequence[Edge], color_count: int) -> None:
    seen: set[int] = set()
    for position, edge in enumerate(edges):
        where = f"edges[{position}]"
        if edge.id < 1:
            raise InputError(None, f"{where}.id", f"must be positive, is {edge.id}")
        if edge.id in seen:
            raise InputError(None, f"{where}.id", f"edge {edge.id} appears twice")
        seen.add(edge.id)
        for side, cell in (("left", edge.left), ("right", edge.right)):
            if not OUTSIDE <= cell < len(cells):
                raise InputError(None, f"{where}.{side}", f"no cell {cell} in this instance")
        if edge.left == OUTSIDE and edge.right == OUTSIDE:
            raise InputError(None, where, f"edge {edge.id} has -1 on both sides")
        if edge.colors is not None:
            _check_colors(edge.colors, color_count, f"{where}.colors")
            surplus = set(edge.colors) - shared_colors(cells, edge)
            if surplus:
                raise InputError(
                    None,
                    f"{where}.colors",
                    f"color {min(surplus)} is not shared by cells {edge.left} and {edge.right}",
                )


def _check_darts(cells: Sequence[Cell], edges: Sequence[Edge]) -> None:
    owner = {edge.id: edge.left for edge in edges}
    owner |= {-edge.id: edge.right for edge in edges}
    seen: set[int] = set()
    for cell in cells:
        for number, loop in enumerate(cell.loops):
            for place, dart in enumerate(loop):
                where = f"cells[{cell.id}].loops[{number}][{place}]"
                if dart not in owner:
                    raise InputError(None, where, f"dart {dart} belongs to no edge")
                if owner[dart] != cell.id:
                    side = "left" if dart > 0 else "right"
                    raise InputError(
                        None,
                        where,
                        f"dart {dart} is not cell {cell.id}'s: edge {abs(dart)} has "
                        f"{owner[dart]} on its {side}, so this loop does not close",
                    )
                if dart in seen:
                    raise InputError(None, where, f"dart {dart} appears twice")
                seen.add(dart)
    for position, edge in enumerate(edges):
        for dart in (edge.id, -edge.id):
            if owner[dart] != OUTSIDE and dart not in seen:
                raise InputError(
                    None,
                    f"edges[{position}]",
                    f"dart {dart} is missing from the loops of cell {owner[dart]}, "
                    "so they do not close",
                )


def _check_colors(colors: Sequence[int], count: int, where: str) -> None:
    """Refuse what is no set of colors; they are in order by now, so no place is named."""
    for color in colors:
        if not 0 <= color < count:
            raise InputError(None, where, f"unknown color {color}")
    for color, following in pairwise(colors):
        if color == following:
            raise InputError(None, where, f"color {color} appears twice")


def check_color_names(colors: Sequence[str]) -> None:
    """Reject color names that are not distinct: plans and pictures refer to colors by name.

    Raises:
        InputError: a name appears twice.
    """
    first: dict[str, int] = {}
    for number, name in enumerate(colors):
        if first.setdefault(name, number) != number:
            message = f"{name!r} is the name of color {first[name]} already"
            raise InputError(None, f"colors[{number}]", message)


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
