"""The dart graph refined: every cell cut into rings of sectors around a center."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cellcolor.solvers.cpsat.graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block, Painting

__all__ = ["RefinedGraph", "painting_of_nodes", "refined"]


@dataclass(frozen=True, slots=True)
class RefinedGraph:
    """Small areas that are painted whole: a planar graph in which paths cannot cross.

    A cell with n darts has a ring of n sectors along its border, one a dart, perhaps more rings
    within that one, and a center. Sub-cells made of sectors and center never cross, and every edge
    is crossed once at most.

    Attributes:
        graph: the dart graph.
        nodes: the nodes of each cell, the center last.
        cell: the cell of each node.
        beside: the nodes of the same cell next to each node.
        across: for the sector of a dart the sector of its twin.
        sector: the sector at each dart.
        joinable: for the sector of a dart the colors joinable across it.
    """

    graph: DartGraph
    nodes: list[range]
    cell: list[int]
    beside: list[list[int]]
    across: dict[int, int]
    sector: list[int]
    joinable: dict[int, frozenset[int]]


def refined(graph: DartGraph, rings: int) -> RefinedGraph:
    """Cut every cell into so many rings of sectors, one or more."""
    nodes: list[range] = []
    cell_of: list[int] = []
    beside: list[list[int]] = []
    sector = [0] * len(graph.darts)

    def link(one: int, other: int) -> None:
        beside[one].append(other)
        beside[other].append(one)

    for cell, darts in enumerate(graph.lists):
        first, count = len(beside), len(darts)
        nodes.append(range(first, first + count * rings + 1))
        cell_of += [cell] * len(nodes[-1])
        beside += [[] for _ in nodes[-1]]
        for ring in range(rings):
            for place, dart in enumerate(darts):
                node = first + ring * count + place
                if count > 2 or (count, place) == (2, 0):
                    link(node, first + ring * count + (place + 1) % count)
                link(node, node + count if ring + 1 < rings else nodes[-1][-1])
                if ring == 0:
                    sector[dart] = node
    across = {sector[number]: sector[dart.twin] for number, dart in enumerate(graph.darts)}
    joinable = {sector[number]: dart.colors for number, dart in enumerate(graph.darts)}
    return RefinedGraph(graph, nodes, cell_of, beside, across, sector, joinable)


def painting_of_nodes(refined: RefinedGraph, colors: Sequence[int]) -> Painting:
    """The division in which each node has the given color."""
    graph = refined.graph
    block_of: dict[int, Block] = {}
    painting: Painting = []
    for nodes in refined.nodes:
        blocks: list[Block] = []
        for node in nodes:
            if node in block_of:
                continue
            block_of[node] = Block(colors[node], set())
            blocks.append(block_of[node])
            reached = [node]
            for place in reached:
                for other in refined.beside[place]:
                    if other not in block_of and colors[other] == colors[node]:
                        block_of[other] = block_of[node]
                        reached.append(other)
        painting.append(blocks)
    for number, dart in enumerate(graph.darts):
        node = refined.sector[number]
        color = colors[node]
        if color == colors[refined.across[node]] and color in dart.colors:
            block_of[node].darts.add(number)
    return [[block for block in cell if block.darts] or cell[:1] for cell in painting]
