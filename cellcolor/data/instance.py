"""The topological graph: cells, topological edges, and loops of darts (paper, section III-C)."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from os import PathLike
from typing import Any

from pydantic import ConfigDict, NonNegativeFloat, NonNegativeInt, TypeAdapter

from cellcolor.data.coverage import Coverage
from cellcolor.data.wording import count, listed
from cellcolor.errors import InputError
from cellcolor.files.documents import dump_lines, read_document, take_body, validate
from cellcolor.files.fingerprint import sha256_of
from cellcolor.files.validation import json_content, settle

FORMAT = "cellcolor/instance"
OUTSIDE = -1
"""The index of everything that no configuration reaches, and of what lies beyond the mesh."""

_STRICT = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)


@dataclass(frozen=True, slots=True)
class Cell:
    """A connected part of the surface whose points have the same available colors.

    Attributes:
        id: position in ``Instance.cells``.
        colors: ids of the available colors, ascending, at least one.
        loops: border loops as cyclic lists of darts, the cell on the left.
        area: square metres, if known.
    """

    __pydantic_config__ = _STRICT

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
class Edge:
    """A topological edge: a maximal border curve between the same two areas.

    Attributes:
        id: positive; ``+id`` is its dart in the cell on the left, ``-id`` on the right.
        left: cell on the left, or ``OUTSIDE``.
        right: cell on the right, or ``OUTSIDE``.
        colors: the joinable colors, ascending, where they are fewer than the two cells share; None
            else.
        length: metres, if known.
    """

    __pydantic_config__ = _STRICT

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


@dataclass(frozen=True, slots=True)
class SurfaceReference:
    """The labelled surface an instance was built from.

    Attributes:
        path: relative to the instance's file.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.
        sha256: the surface's fingerprint; None in files of version 1.
    """

    __pydantic_config__ = _STRICT

    path: str
    vertex_cell: tuple[int, ...]
    sha256: str | None = None

    def __post_init__(self) -> None:
        settle(self)


@dataclass(frozen=True, slots=True)
class KnownResult:
    """A result known from elsewhere: the minimum, and how many optimal schemes there are."""

    __pydantic_config__ = _STRICT

    segments: NonNegativeInt
    schemes: NonNegativeInt | None = None

    def __post_init__(self) -> None:
        settle(self)


@dataclass(frozen=True, slots=True)
class KnownResults:
    """Known results per search space."""

    __pydantic_config__ = _STRICT

    paper: KnownResult | None = None
    surface: KnownResult | None = None

    def __post_init__(self) -> None:
        settle(self)


@dataclass(frozen=True, repr=False)
class Instance:
    """A validated topological graph, all that is needed to solve.

    Attributes:
        name: what to call it.
        colors: the names of the colors.
        cells: numbered 0, 1, 2, …
        edges: in no particular order.
        meta: free, JSON-able.
        surface: the labelled surface it was built from, if any.
        known: results known from elsewhere.
        coverage: how much of that surface the cells cover, if known.

    Raises:
        InputError: anything that ``docs/formats.md`` forbids, with field and element.
    """

    __pydantic_config__ = _STRICT

    name: str
    colors: tuple[str, ...]
    cells: tuple[Cell, ...]
    edges: tuple[Edge, ...]
    meta: dict[str, Any] | None = field(default=None, hash=False)
    surface: SurfaceReference | None = None
    known: KnownResults | None = None
    coverage: Coverage | None = None

    def __post_init__(self) -> None:
        settle(self)
        if self.meta is not None:
            object.__setattr__(self, "meta", json_content(self.meta, "meta"))
        self._check_cells()
        self._check_edges()
        self._check_darts()
        if self.surface is not None:
            for vertex, cell in enumerate(self.surface.vertex_cell):
                if not OUTSIDE <= cell < len(self.cells):
                    raise InputError(
                        None, f"surface.vertex_cell[{vertex}]", f"no cell {cell} in this instance"
                    )

    def __str__(self) -> str:
        return (
            f"{self.name}: {count(len(self.cells), 'cell')}, {count(len(self.edges), 'edge')}, "
            f"{count(len(self.colors), 'color')}"
        )

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    def _check_cells(self) -> None:
        for position, cell in enumerate(self.cells):
            where = f"cells[{position}]"
            if cell.id != position:
                raise InputError(
                    None, f"{where}.id", f"cell ids are 0, 1, 2, … in this order; is {cell.id}"
                )
            if not cell.colors:
                raise InputError(None, f"{where}.colors", f"cell {cell.id} has no color")
            _check_colors(cell.colors, len(self.colors), f"{where}.colors")
            for number, loop in enumerate(cell.loops):
                if not loop:
                    raise InputError(None, f"{where}.loops[{number}]", "a loop without darts")

    def _check_edges(self) -> None:
        seen: set[int] = set()
        for position, edge in enumerate(self.edges):
            where = f"edges[{position}]"
            if edge.id < 1:
                raise InputError(None, f"{where}.id", f"must be positive, is {edge.id}")
            if edge.id in seen:
                raise InputError(None, f"{where}.id", f"edge {edge.id} stands twice")
            seen.add(edge.id)
            for side, cell in (("left", edge.left), ("right", edge.right)):
                if not OUTSIDE <= cell < len(self.cells):
                    raise InputError(None, f"{where}.{side}", f"no cell {cell} in this instance")
            if edge.left == OUTSIDE and edge.right == OUTSIDE:
                raise InputError(None, where, f"edge {edge.id} has -1 on both sides")
            if edge.colors is not None:
                _check_colors(edge.colors, len(self.colors), f"{where}.colors")
                surplus = set(edge.colors) - self._shared(edge)
                if surplus:
                    raise InputError(
                        None,
                        f"{where}.colors",
                        f"color {min(surplus)} is not shared by cells {edge.left} and {edge.right}",
                    )

    def _check_darts(self) -> None:
        owner = {edge.id: edge.left for edge in self.edges}
        owner |= {-edge.id: edge.right for edge in self.edges}
        seen: set[int] = set()
        for cell in self.cells:
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
                        raise InputError(None, where, f"dart {dart} stands twice")
                    seen.add(dart)
        for position, edge in enumerate(self.edges):
            for dart in (edge.id, -edge.id):
                if owner[dart] != OUTSIDE and dart not in seen:
                    raise InputError(
                        None,
                        f"edges[{position}]",
                        f"dart {dart} is missing from the loops of cell {owner[dart]}, "
                        "so they do not close",
                    )

    def _shared(self, edge: Edge) -> set[int]:
        if OUTSIDE in (edge.left, edge.right):
            return set()
        return set(self.cells[edge.left].colors) & set(self.cells[edge.right].colors)

    @cached_property
    def _edge_by_id(self) -> dict[int, Edge]:
        return {edge.id: edge for edge in self.edges}

    @cached_property
    def _joinable(self) -> dict[int, tuple[int, ...]]:
        return {
            edge.id: tuple(sorted(self._shared(edge))) if edge.colors is None else edge.colors
            for edge in self.edges
        }

    def edge(self, dart: int) -> Edge:
        """The edge that a dart is a side of."""
        return self._edge_by_id[abs(dart)]

    def joinable(self, dart: int) -> tuple[int, ...]:
        """The colors that may continue across a dart's edge, ascending; empty on a dead edge."""
        return self._joinable[abs(dart)]

    def across(self, dart: int) -> int:
        """The cell on the other side of a dart, or ``OUTSIDE``."""
        edge = self.edge(dart)
        return edge.right if dart > 0 else edge.left

    @property
    def nothing_to_cover(self) -> bool:
        """It was made of a surface no point of which has a color.

        An instance without cells and without a surface asks for nothing, which takes 0 segments.
        """
        return not self.cells and self.coverage is not None and self.coverage.covered == 0

    def to_json(self) -> str:
        """The file's text, as ``build`` writes it."""
        document = {"format": FORMAT, "version": 2} | self._body()
        return dump_lines(document, frozenset({"cells", "edges"}))

    def _body(self) -> dict[str, Any]:
        """The JSON object without its format and version."""
        document: dict[str, Any] = {"name": self.name, "colors": list(self.colors)}
        document["cells"] = [
            _given(
                {"id": c.id, "colors": c.colors, "loops": c.loops},
                area=c.area,
            )
            for c in self.cells
        ]
        document["edges"] = [
            _given({"id": e.id, "left": e.left, "right": e.right}, colors=e.colors, length=e.length)
            for e in self.edges
        ]
        if self.meta is not None:
            document["meta"] = self.meta
        if self.surface is not None:
            document["surface"] = _given(
                {"path": self.surface.path, "vertex_cell": self.surface.vertex_cell},
                sha256=self.surface.sha256,
            )
        if self.coverage is not None:
            document["coverage"] = self.coverage.to_document()
        if self.known is not None:
            results = {
                space: _given({"segments": result.segments}, schemes=result.schemes)
                for space, result in (("paper", self.known.paper), ("surface", self.known.surface))
                if result is not None
            }
            document["known"] = results
        return document

    @cached_property
    def sha256(self) -> str:
        """Fingerprint of what a solver reads (docs/formats.md): the graph, no names, no sizes.

        The order of edges, of loops and of a loop's first dart means nothing; the ids of cells
        and edges are in it, since a solution names them.
        """
        return sha256_of(
            {
                "colors": len(self.colors),
                "cells": [
                    [
                        cell.colors,
                        sorted([*loop[at:], *loop[:at]] for loop, at in _from_smallest(cell.loops)),
                    ]
                    for cell in self.cells
                ],
                "edges": sorted([e.id, e.left, e.right, self.joinable(e.id)] for e in self.edges),
            }
        )

    @cached_property
    def sha256_of_version_1(self) -> str:
        """Fingerprint of this instance in a solution of version 1: that of the whole file."""
        return _sha256_of_version_1(self._body())

    @classmethod
    def from_document(cls, document: dict[str, Any]) -> Instance:
        """An instance from a parsed JSON object."""
        body = take_body(document, FORMAT, ("coverage", "surface.sha256"))
        instance = validate(_ADAPTER, body)
        if document["version"] == 1:
            # The old fingerprint depends on the order of colors, which an instance does not keep.
            instance.__dict__["sha256_of_version_1"] = _sha256_of_version_1(body)
        return instance

    @classmethod
    def read(cls, path: str | PathLike[str]) -> Instance:
        """An instance from a file.

        Raises:
            InputError: the file cannot be read or holds something that the format forbids.
        """
        try:
            return cls.from_document(read_document(path))
        except InputError as error:
            raise error.in_file(str(path)) from error


_ADAPTER = TypeAdapter(Instance)


def _from_smallest(loops: Sequence[tuple[int, ...]]) -> list[tuple[tuple[int, ...], int]]:
    """Each loop with the place of its smallest dart."""
    return [(loop, loop.index(min(loop))) for loop in loops]


def _sha256_of_version_1(body: dict[str, Any]) -> str:
    """SHA-256 of the text that was written for an instance when there was only version 1."""

    def part(element: dict[str, Any], names: Sequence[str], measure: str = "") -> dict[str, Any]:
        taken = {name: element[name] for name in names if element.get(name) is not None}
        size = element.get(measure)
        return taken | ({} if size is None else {measure: float(size)})

    document: dict[str, Any] = {"format": FORMAT, "version": 1}
    document |= {"name": body["name"], "colors": body["colors"]}
    document["cells"] = [part(c, ("id", "colors", "loops"), "area") for c in body["cells"]]
    document["edges"] = [
        part(e, ("id", "left", "right", "colors"), "length") for e in body["edges"]
    ]
    if body.get("meta") is not None:
        document["meta"] = body["meta"]
    if body.get("surface") is not None:
        document["surface"] = part(body["surface"], ("path", "vertex_cell"))
    if body.get("known") is not None:
        document["known"] = {
            space: part(body["known"][space], ("segments", "schemes"))
            for space in ("paper", "surface")
            if body["known"].get(space) is not None
        }
    text = dump_lines(document, frozenset({"cells", "edges"}))
    return hashlib.sha256(text.encode()).hexdigest()


def _given(document: dict[str, Any], **optional: object) -> dict[str, Any]:
    return document | {name: value for name, value in optional.items() if value is not None}


def _check_colors(colors: Sequence[int], count: int, where: str) -> None:
    """Refuse what is no set of colors; they are in order by now, so no place is named."""
    for color in colors:
        if not 0 <= color < count:
            raise InputError(None, where, f"unknown color {color}")
    for color, following in pairwise(colors):
        if color == following:
            raise InputError(None, where, f"color {color} stands twice")
