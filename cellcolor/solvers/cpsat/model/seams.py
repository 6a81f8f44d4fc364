"""Divisions without seams, written in the cyclic lists that seams make.

Where the sub-cells of a cell lie around its seams is found by painting a small instance: the cell
alone, in as many colors as it has sub-cells, with a cell of the sub-cell's color across each dart
in state 1. Its division with one segment for each color is the result; there is none if
the sub-cells would have to cross.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import Cell, Edge, Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam
from cellcolor.deadline import OutOfTime
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.dart_graph import (
    DartGraph,
    dart_graph,
    enough_strands,
    seams_of,
)
from cellcolor.solvers.cpsat.model.full import (
    LARGEST_MODEL,
    fewest_subcells,
    full_model,
    model_size,
    not_built,
    read_painting,
    seams_size,
)
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.union_find import UnionFind

Solve = Callable[[cp_model.CpModel], tuple[cp_model.CpSolver, cp_model.CpSolverStatus]]
"""Runs a model."""

Seamed = tuple[DartGraph, Painting]
"""A painting, and the graph with seams that its darts belong to."""


@dataclass(frozen=True, slots=True)
class _Written:
    """A cell's sub-cells in its cyclic list.

    Attributes:
        widths: strands of each of its seams.
        parts: for each sub-cell its pieces, as strands of edges and seams.
    """

    widths: tuple[int, ...]
    parts: tuple[tuple[frozenset[Strand], ...], ...]


@dataclass(frozen=True, slots=True)
class _Alone:
    """A cell alone, a petal of the sub-cell's color across each dart in state 1.

    Attributes:
        instance: the cell, with a color for each sub-cell and for each corner of a seam that lies
            after a dart in state 0; and the petals.
        local: the edge of the small instance for each dart of the cell that it has.
        seams: the cell's seams in the small instance, as wide as they can have to be.
    """

    instance: Instance
    local: dict[int, int]
    seams: list[Seam]


class SeamWriter:
    """Writes paintings of one graph whose cells have their loops apart.

    Args:
        strands: strands of each live edge.
        solve: runs a model.

    Attributes:
        graph: the graph with loops apart, in all colors.
    """

    def __init__(self, instance: Instance, strands: Mapping[int, int], solve: Solve) -> None:
        self._instance = instance
        self._strands = strands
        self._solve = solve
        self._colors = [frozenset(cell.colors) for cell in instance.cells]
        self._seams = seams_of(instance, self._colors, strands, 0)
        self._known: dict[tuple[int, tuple[frozenset[int], ...]], _Written | None] = {}
        self.graph = dart_graph(instance, self._colors, strands, None)

    def write(self, painting: Painting) -> Seamed | None:
        """The painting with seams; None if it cannot be drawn, or if that stayed open."""
        written = []
        for number, blocks in enumerate(painting):
            try:
                found = self._written(number, blocks)
            except (OutOfTime, TooLarge):
                return None
            if found is None:
                return None
            written.append(found)
        seams = []
        for number, cell in enumerate(written):
            own = [seam for seam in self._seams if seam.cell == number]
            seams += [
                replace(seam, strands=width) for seam, width in zip(own, cell.widths, strict=True)
            ]
        graph = dart_graph(self._instance, self._colors, self._strands, seams)
        return graph, [
            [
                Block(block.color, {graph.number_of[name] for name in part})
                for block, parts in zip(blocks, cell.parts, strict=True)
                for part in parts
            ]
            for blocks, cell in zip(painting, written, strict=True)
        ]

    def can_be_drawn(self, painting: Painting) -> bool:
        """Whether the sub-cells, which do not cross on any one loop, do not cross at all.

        Loops and sub-cells that form a forest can always be drawn.

        Raises:
            OutOfTime: there was no time to see.
            TooLarge: the model that is to decide would not fit into memory.
        """
        return all(map(self.cell_can_be_drawn, range(len(painting)), painting))

    def cell_can_be_drawn(self, number: int, blocks: Sequence[Block]) -> bool:
        """The same of one cell's sub-cells."""
        if _forest(self.graph.loops[number], blocks):
            return True
        return self._written(number, blocks) is not None

    def _written(self, number: int, blocks: Sequence[Block]) -> _Written | None:
        names = tuple(
            frozenset(self.graph.darts[dart].name for dart in block.darts) for block in blocks
        )
        seams = [seam for seam in self._seams if seam.cell == number]
        if len(blocks) == 1 or not seams:
            return _Written((0,) * len(seams), tuple((own,) for own in names))
        key = number, tuple(frozenset(block.darts) for block in blocks)
        if key not in self._known:
            self._known[key] = self._draw(number, key[1], seams)
        return self._known[key]

    def _draw(
        self, number: int, blocks: Sequence[frozenset[int]], seams: Sequence[Seam]
    ) -> _Written | None:
        """Paint the cell alone, a color for each sub-cell; None if that cannot be drawn."""
        alone = self._cell_alone(number, blocks, seams)
        instance = alone.instance
        if seams_size(alone.seams) > LARGEST_MODEL:
            return None
        colors = [frozenset(cell.colors) for cell in instance.cells]
        small = dart_graph(instance, colors, dict.fromkeys(alone.local.values(), 1), alone.seams)
        if (size := model_size(small)) > LARGEST_MODEL:
            raise TooLarge(not_built(size))
        built = full_model(small, color_regions(instance))
        segments = len(instance.colors)
        fewest_subcells(built.model, small, built.variables, built.variables.alone, segments)
        solver, status = self._solve(built.model)
        if status == cp_model.INFEASIBLE:
            return None
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            raise OutOfTime("there was no time to draw the sub-cells of a cell")
        pieces = [
            (block.color, [small.darts[dart].name for dart in block.darts])
            for block in read_painting(small, built.variables, solver)[0]
            if block.color < len(blocks)
        ]
        # Names of the small instance become those of the large one, idle strands are left out.
        used = [
            sorted(
                {strand for _, names in pieces for dart, strand in names if abs(dart) == seam.id}
            )
            for seam in alone.seams
        ]
        name = {(n, 1): self.graph.darts[dart].name for dart, n in alone.local.items()}
        for seam, its, strands in zip(seams, alone.seams, used, strict=True):
            for rank, strand in enumerate(strands, start=1):
                name |= {(sign * its.id, strand): (sign * seam.id, rank) for sign in (1, -1)}
        return _Written(
            tuple(map(len, used)),
            tuple(
                tuple(frozenset(name[n] for n in names) for c, names in pieces if c == color)
                for color in range(len(blocks))
            ),
        )

    def _cell_alone(
        self, number: int, blocks: Sequence[frozenset[int]], seams: Sequence[Seam]
    ) -> _Alone:
        """The small instance in which a cell's sub-cells are drawn."""
        graph = self.graph
        loops = graph.loops[number]
        corners = [
            max((d for d in loop if graph.darts[d].name[0] == signed), key=loop.index)
            for loop, signed in zip(
                loops, [seams[0].from_, *(seam.to for seam in seams)], strict=True
            )
        ]
        color_of = {dart: color for color, block in enumerate(blocks) for dart in block}
        spare = len(blocks)
        for corner in corners:  # a corner after a dart in state 0 needs that dart
            if corner not in color_of:
                color_of[corner], spare = spare, spare + 1
        # A seam is put in after the first dart of a loop (``dart_graph``): the corner comes first.
        turned = [
            [*loop[loop.index(corner) :], *loop[: loop.index(corner)]]
            for loop, corner in zip(loops, corners, strict=True)
        ]
        kept = [[dart for dart in loop if dart in color_of] for loop in turned]
        local = {dart: n for n, dart in enumerate((d for loop in kept for d in loop), start=1)}
        many = tuple(range(spare))
        instance = Instance(
            "sub-cells",
            tuple(map(str, many)),
            (
                Cell(0, many, tuple(tuple(local[dart] for dart in loop) for loop in kept)),
                *(Cell(n, (color_of[dart],), ((-n,),)) for dart, n in local.items()),
            ),
            tuple(Edge(n, 0, n) for n in local.values()),
        )
        own = [
            Seam(len(local) + place, 0, local[corners[0]], local[corner], width)
            for place, (corner, width) in enumerate(
                zip(corners[1:], enough_strands([len(loop) for loop in kept]), strict=True), start=1
            )
        ]
        return _Alone(instance, local, own)


def _forest(loops: Sequence[Sequence[int]], blocks: Sequence[Block]) -> bool:
    """Whether loops and the blocks that have darts on them make no circle."""
    holder = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    connected: UnionFind[tuple[str, int]] = UnionFind()
    for number, loop in enumerate(loops):
        for block in {holder[dart] for dart in loop if dart in holder}:
            one, other = ("loop", number), ("block", block)
            if connected[one] == connected[other]:
                return False
            connected.union(one, other)
    return True
