"""The topological graph: cells, topological edges, loops of darts (paper, III-C), and coverage."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Annotated

from annotated_types import Ge, Le
from pydantic import NonNegativeFloat, NonNegativeInt

from cellcolor.data.cells_and_edges import (
    OUTSIDE,
    Cell,
    Edge,
    check_graph,
    faults_of_color_names,
    shared_colors,
)
from cellcolor.data.value import Document, Drawn, Value
from cellcolor.data.wording import count
from cellcolor.errors import InputError, refuse
from cellcolor.files.documents import sha256_of
from cellcolor.files.validation import FreeContent, settle


@dataclass(frozen=True, slots=True)
class SurfaceReference(Value):
    """The labelled surface an instance was built from.

    Attributes:
        path: relative to the instance's file.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.
        sha256: the surface's fingerprint; None in files of version 1.
    """

    path: str
    vertex_cell: tuple[int, ...]
    sha256: str | None = None


@dataclass(frozen=True, slots=True)
class KnownResult(Value):
    """A result known from elsewhere: the minimum, and how many optimal schemes there are."""

    segments: NonNegativeInt
    schemes: NonNegativeInt | None = None


@dataclass(frozen=True, slots=True)
class KnownResults(Value):
    """Known results per search space."""

    paper: KnownResult | None = None
    surface: KnownResult | None = None


_ROUNDING = 1e-9
"""Shares are sums of floating-point areas, divided."""

Share = Annotated[float, Ge(0), Le(1)]


@dataclass(frozen=True, slots=True)
class Coverage(Value):
    """How much of a surface the cells cover; nobody paints the rest.

    Attributes:
        area_m2: the whole surface, square metres.
        unreachable: the share of its area that no color reaches, 0 to 1.
        given_up: the share that some color reaches and that was taken away on purpose, by the
            sliver policy or as a place to leave alone, 0 to 1; not part of ``unreachable``.
    """

    area_m2: NonNegativeFloat
    unreachable: Share
    given_up: Share

    def __post_init__(self) -> None:
        settle(self)
        if self.unreachable + self.given_up > 1 + _ROUNDING:
            raise InputError(None, "coverage", "unreachable and given_up are more than the whole")

    @property
    def covered(self) -> float:
        """The share of the cells, 0 to 1."""
        share = 1 - self.unreachable - self.given_up
        return share if share > _ROUNDING else 0.0

    def __str__(self) -> str:
        given_up = f", {100 * self.given_up:.1f} % given up" if self.given_up else ""
        return (
            f"{100 * self.covered:.1f} % of {self.area_m2:.4g} m² can be covered, "
            f"{100 * self.unreachable:.1f} % is unreachable{given_up}"
        )


@dataclass(frozen=True, repr=False)
class Instance(Document, Drawn):
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

    FORMAT = "cellcolor/instance"
    ADDED = (("coverage", "surface.sha256"),)
    LINES = ("cells", "edges")
    LAST = ("known",)

    name: str
    colors: tuple[str, ...]
    cells: tuple[Cell, ...]
    edges: tuple[Edge, ...]
    meta: FreeContent | None = field(default=None, hash=False)
    surface: SurfaceReference | None = None
    known: KnownResults | None = None
    coverage: Coverage | None = None

    def __post_init__(self) -> None:
        settle(self)
        refuse(faults_of_color_names(self.colors))
        check_graph(self.cells, self.edges, len(self.colors))
        refuse(
            (f"surface.vertex_cell[{vertex}]", f"no cell {cell} in this instance")
            for vertex, cell in enumerate(() if self.surface is None else self.surface.vertex_cell)
            if not OUTSIDE <= cell < len(self.cells)
        )

    @property
    def size(self) -> str:
        """``2 cells, 5 edges, 3 colors``."""
        cells, edges = count(len(self.cells), "cell"), count(len(self.edges), "edge")
        return f"{cells}, {edges}, {count(len(self.colors), 'color')}"

    def __str__(self) -> str:
        return f"{self.name}: {self.size}"

    @cached_property
    def _edge_by_id(self) -> dict[int, Edge]:
        return {edge.id: edge for edge in self.edges}

    @cached_property
    def _joinable(self) -> dict[int, tuple[int, ...]]:
        return {
            edge.id: tuple(sorted(shared_colors(self.cells, edge)))
            if edge.colors is None
            else edge.colors
            for edge in self.edges
        }

    def edge(self, dart: int) -> Edge:
        """The edge of a dart."""
        return self._edge_by_id[abs(dart)]

    def joinable(self, dart: int) -> tuple[int, ...]:
        """The colors that may continue across a dart's edge, ascending; empty on a dead edge."""
        return self._joinable[abs(dart)]

    def across(self, dart: int) -> int:
        """The cell on the other side of a dart, or ``OUTSIDE``."""
        edge = self.edge(dart)
        return edge.right if dart > 0 else edge.left

    @cached_property
    def live_edges(self) -> tuple[int, ...]:
        """The ids of the live edges, which some color may continue across, in their order."""
        return tuple(edge.id for edge in self.edges if self.joinable(edge.id))

    @cached_property
    def live_loops(self) -> tuple[tuple[tuple[int, ...], ...], ...]:
        """Of each cell the loops with live darts, each without its dead darts, in cyclic order."""
        return tuple(
            tuple(
                live
                for loop in cell.loops
                if (live := tuple(dart for dart in loop if self.joinable(dart)))
            )
            for cell in self.cells
        )

    @property
    def most_live_darts(self) -> int:
        """The most live darts that a cell has; 0 without cells. It makes an instance hard."""
        return max((sum(map(len, loops)) for loops in self.live_loops), default=0)

    @property
    def most_live_loops(self) -> int:
        """The most loops with live darts that a cell has; 0 without cells."""
        return max(map(len, self.live_loops), default=0)

    @property
    def nothing_to_cover(self) -> bool:
        """Whether it was made from a surface without any colored point.

        An instance without cells and without a surface requires nothing, which takes 0 segments.
        """
        return not self.cells and self.coverage is not None and self.coverage.covered == 0

    def without_cells(self, left_out: Collection[int]) -> tuple[Instance, list[int]]:
        """The graph of a surface that is not to be covered in some cells.

        Args:
            left_out: the cells that are not to be covered.

        Returns:
            The graph of the other cells, which are renumbered in the same order, without a
            reference to the surface; and the number that each of them had.
        """
        kept = [cell.id for cell in self.cells if cell.id not in set(left_out)]
        number = {cell: place for place, cell in enumerate(kept)}
        cells = tuple(replace(self.cells[cell], id=number[cell]) for cell in kept)
        edges = []
        for edge in self.edges:
            left, right = number.get(edge.left, OUTSIDE), number.get(edge.right, OUTSIDE)
            if left == OUTSIDE and right == OUTSIDE:
                continue
            # A list of joinable colors is one of those that both sides share.
            colors = None if OUTSIDE in (left, right) else edge.colors
            edges.append(Edge(edge.id, left, right, colors, edge.length))
        graph = replace(
            self, cells=cells, edges=tuple(edges), surface=None, known=None, coverage=None
        )
        return graph, kept

    @cached_property
    def sha256(self) -> str:
        """Fingerprint of what a solver reads (docs/formats.md): the graph, no names, no sizes.

        The order of edges and of loops and the choice of a loop's first dart mean nothing. The ids
        of cells and edges are included, since a solution names them.
        """
        return sha256_of(
            {
                "colors": len(self.colors),
                "cells": [
                    [
                        cell.colors,
                        sorted(
                            [*loop[at:], *loop[:at]]
                            for loop in cell.loops
                            for at in (loop.index(min(loop)),)
                        ),
                    ]
                    for cell in self.cells
                ],
                "edges": sorted([e.id, e.left, e.right, self.joinable(e.id)] for e in self.edges),
            }
        )
