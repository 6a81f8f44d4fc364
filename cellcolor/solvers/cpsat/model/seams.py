"""Whether the sub-cells of a cell with several loops can be drawn without crossing.

Loops and sub-cells that form a forest can always be drawn. Otherwise a small instance decides: the
cell alone, in as many colors as it has sub-cells, with a cell of the sub-cell's color across each
dart in state 1. It has a division with one segment for each color if the sub-cells can be drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import OutOfTime
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model.full import (
    LARGEST_MODEL,
    full_model,
    model_size,
    not_built,
    seams_size,
)
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.union_find import UnionFind

Solve = Callable[[cp_model.CpModel], tuple[cp_model.CpSolver, cp_model.CpSolverStatus]]
"""Runs a model."""


class Drawings:
    """Which sub-cells of a graph with its loops apart can be drawn; remembers what was decided.

    Args:
        solve: runs a model.
    """

    def __init__(self, graph: DartGraph, solve: Solve) -> None:
        self._graph = graph
        self._solve = solve
        self._known: dict[tuple[int, frozenset[frozenset[int]]], bool] = {}

    def possible(self, painting: Painting) -> bool:
        """Whether the sub-cells, which do not cross on any one loop, do not cross at all.

        Raises:
            OutOfTime: there was no time to see.
            TooLarge: the model that is to decide would not fit into memory.
        """
        return all(map(self.possible_in, range(len(painting)), painting))

    def possible_in(self, cell: int, blocks: Sequence[Block]) -> bool:
        """The same of one cell's sub-cells."""
        loops = self._graph.loops[cell]
        if _forest(loops, blocks):
            return True
        key = cell, frozenset(frozenset(block.darts) for block in blocks)
        if key not in self._known:
            self._known[key] = self._decide(_cell_alone(loops, blocks), len(blocks))
        return self._known[key]

    def _decide(self, alone: Instance, segments: int) -> bool:
        colors = [frozenset(cell.colors) for cell in alone.cells]
        once = {edge.id: 1 for edge in alone.edges}
        seams = seams_of(alone, colors, once, None)
        if (size := seams_size(seams)) <= LARGEST_MODEL:
            small = dart_graph(alone, colors, once, seams)
            size = model_size(small)
        if size > LARGEST_MODEL:
            raise TooLarge(not_built(size))
        built = full_model(small, color_regions(alone))
        built.model.add(built.segments <= segments)
        _, status = self._solve(built.model)
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE, cp_model.INFEASIBLE):
            raise OutOfTime("there was no time to draw the sub-cells of a cell")
        return status != cp_model.INFEASIBLE


def _cell_alone(loops: Sequence[Sequence[int]], blocks: Sequence[Block]) -> Instance:
    """A cell with its darts in state 1, and a petal of the sub-cell's color across each of them."""
    color_of = {dart: color for color, block in enumerate(blocks) for dart in block.darts}
    edge = {dart: number for number, dart in enumerate(color_of, start=1)}
    own = [tuple(edge[dart] for dart in loop if dart in edge) for loop in loops]
    many = tuple(range(len(blocks)))
    petals = [Cell(n, (color_of[dart],), ((-n,),)) for dart, n in edge.items()]
    return Instance(
        "sub-cells",
        tuple(map(str, many)),
        (Cell(0, many, tuple(loop for loop in own if loop)), *petals),
        tuple(Edge(n, 0, n) for n in edge.values()),
    )


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
