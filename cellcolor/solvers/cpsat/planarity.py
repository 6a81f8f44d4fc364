"""Whether the sub-cells of a cell with several loops can be drawn without crossing."""

from __future__ import annotations

from collections.abc import Sequence

from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.cpsat.complete_model import CompleteModel
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block
from cellcolor.solvers.interruptible import make_cp_solver
from cellcolor.union_find import UnionFind


class Planarity:
    """Decides for cells of one graph, loops apart, and remembers what it has decided."""

    def __init__(self, graph: DartGraph, deadline: Deadline) -> None:
        self._graph, self._deadline = graph, deadline
        self._known: dict[tuple[tuple[int, ...], ...], bool] = {}

    def can_be_drawn(self, cell: int, blocks: Sequence[Block]) -> bool:
        """Whether sub-cells, which do not cross on any one loop, do not cross at all.

        Loops and sub-cells that form a forest can always be drawn.

        Raises:
            OutOfTime: the deadline came first.
            TooLarge: the model that is to decide would be too large.
        """
        block_of = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
        loops = tuple(
            met
            for loop in self._graph.loops[cell]
            if (met := tuple(block_of[dart] for dart in loop if dart in block_of))
        )
        if _forest(loops):
            return True
        if loops not in self._known:
            self._known[loops] = _drawn_alone(loops, len(blocks), self._deadline)
        return self._known[loops]


def _drawn_alone(loops: Sequence[Sequence[int]], count: int, deadline: Deadline) -> bool:
    """Color a cell alone, with a color for each sub-cell, and a cell of it across each dart.

    The sub-cells can be drawn if each color gets by with one segment.
    """
    colors = tuple(range(count))
    places = [block for loop in loops for block in loop]
    dart = iter(range(1, len(places) + 1))
    cell = Cell(0, colors, tuple(tuple(next(dart) for _ in loop) for loop in loops))
    leaves = [Cell(n, (block,), ((-n,),)) for n, block in enumerate(places, start=1)]
    edges = tuple(Edge(n, 0, n) for n in range(1, len(places) + 1))
    alone = Instance("sub-cells", tuple(map(str, colors)), (cell, *leaves), edges)
    built = CompleteModel(alone, deadline=deadline)
    built.model.add(built.segments <= count)
    status = make_cp_solver(deadline, 1, 0).solve(built.model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE, cp_model.INFEASIBLE):
        raise OutOfTime("there was no time to draw the sub-cells of a cell")
    return status != cp_model.INFEASIBLE


def _forest(loops: Sequence[Sequence[int]]) -> bool:
    """Whether loops and the sub-cells that have darts on them make no circle."""
    connected: UnionFind[tuple[str, int]] = UnionFind()
    for number, loop in enumerate(loops):
        for block in set(loop):
            if connected["loop", number] == connected["block", block]:
                return False
            connected.union(("loop", number), ("block", block))
    return True
