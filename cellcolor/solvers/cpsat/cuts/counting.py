"""Cutting paths of a painting: how many curves divide its cells (docs/encodings.md)."""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.union_find import UnionFind


def count_cuts(instance: Instance, graph: DartGraph, painting: Painting) -> int:
    """The fewest curves that divide the cells into the painting's sub-cells.

    Args:
        instance: the topological graph.
        graph: its dart graph, seams put in.
        painting: a legal painting of it.
    """
    return sum(
        _cuts_of_cell(
            cell,
            [{graph.darts[dart].name[0] for dart in block.darts} for block in unseamed(graph, own)],
        )
        for cell, own in zip(instance.cells, painting, strict=True)
    )


def unseamed(graph: DartGraph, blocks: Sequence[Block]) -> list[Block]:
    """A cell's sub-cells on the surface: seams neither divide them nor have darts."""
    seams = {seam.id for seam in graph.seams}
    holder = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    whole: UnionFind[int] = UnionFind(range(len(blocks)))
    virtual = {dart for dart in holder if abs(graph.darts[dart].name[0]) in seams}
    for dart in virtual:
        if graph.darts[dart].twin in virtual:
            whole.union(holder[dart], holder[graph.darts[dart].twin])
    return [
        Block(
            blocks[min(parts)].color,
            {dart for part in parts for dart in blocks[part].darts if dart not in virtual},
        )
        for parts in whole.sets()
    ]


def _cuts_of_cell(cell: Cell, subcells: Sequence[set[int]]) -> int:
    """Sub-cells less one, and one more for each loop that has to be joined to another.

    As long as the graph of loops and the sub-cells that meet them has a circle, its loops are put
    together, one circle after the other (docs/semantics.md, section 8).
    """
    if len(subcells) == 1:
        return 0
    import networkx as nx  # slow to import, and most instances do without

    loops: UnionFind[int] = UnionFind(range(len(cell.loops)))
    loop_of = {dart: number for number, loop in enumerate(cell.loops) for dart in loop}
    together = 0
    while True:
        meetings: nx.Graph[tuple[str, int]] = nx.Graph()
        for number, darts in enumerate(subcells):
            meetings.add_edges_from(
                (("sub-cell", number), ("loop", loops[loop_of[dart]])) for dart in darts
            )
        try:
            circle = nx.find_cycle(meetings)
        except nx.NetworkXNoCycle:
            return len(subcells) - 1 + together
        met = {number for edge in circle for kind, number in edge if kind == "loop"}
        loops.union(*met)
        together += len(met) - 1
