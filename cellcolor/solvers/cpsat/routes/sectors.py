"""The dart graph refined: every cell cut into rings of sectors around a center."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting


@dataclass(frozen=True, slots=True)
class RefinedGraph:
    """Cells cut into nodes, which are painted whole: a planar graph in which paths cannot cross.

    A cell with n darts has a ring of n sectors along its border, one a dart, perhaps more rings
    within that one, and a center; without rings it is all center. Sub-cells made of sectors and
    center never cross, and every edge is crossed once at most.

    Attributes:
        graph: the dart graph.
        nodes: the nodes of each cell, the center last.
        cell: the cell of each node.
        beside: the nodes of the same cell next to each node.
        across: the nodes across the darts at each node, and the colors joinable there.
        at: the node at each dart.
    """

    graph: DartGraph
    nodes: list[range]
    cell: list[int]
    beside: list[list[int]]
    across: list[list[tuple[int, frozenset[int]]]]
    at: list[int]
    _near: dict[int, dict[int, list[int]]] = field(default_factory=dict)

    def near(self, color: int) -> dict[int, list[int]]:
        """The neighbors that can have a color, of each node that can.

        Those of the same cell come first. They never lead out of a color region.
        """
        if color not in self._near:
            self._near[color] = {
                node: [
                    *self.beside[node],
                    *(other for other, joinable in self.across[node] if color in joinable),
                ]
                for cell, nodes in enumerate(self.nodes)
                if color in self.graph.colors[cell]
                for node in nodes
            }
        return self._near[color]


def refined(graph: DartGraph, rings: int) -> RefinedGraph:
    """Cut every cell into a number of rings of sectors."""
    nodes: list[range] = []
    cell_of: list[int] = []
    beside: list[list[int]] = []
    at = [0] * len(graph.darts)

    def link(one: int, other: int) -> None:
        beside[one].append(other)
        beside[other].append(one)

    for cell, darts in enumerate(graph.lists):
        first, count = len(beside), len(darts)
        nodes.append(range(first, first + count * rings + 1))
        cell_of += [cell] * len(nodes[-1])
        beside += [[] for _ in nodes[-1]]
        center = nodes[-1][-1]
        for ring in range(rings):
            for place in range(count):
                node = first + ring * count + place
                if count > 2 or (count, place) == (2, 0):
                    link(node, first + ring * count + (place + 1) % count)
                link(node, node + count if ring + 1 < rings else center)
        for place, dart in enumerate(darts):
            at[dart] = first + place if rings else center
    across: list[list[tuple[int, frozenset[int]]]] = [[] for _ in cell_of]
    for node, side in zip(at, graph.darts, strict=True):
        across[node].append((at[side.twin], side.colors))
    return RefinedGraph(graph, nodes, cell_of, beside, across, at)


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
        node, beyond = refined.at[number], refined.at[dart.twin]
        color = colors[node]
        if color == colors[beyond] and color in dart.colors:
            block_of[node].darts.add(number)
    return [[block for block in cell if block.darts] or cell[:1] for cell in painting]


def node_colors(refined: RefinedGraph, painting: Painting) -> list[int]:
    """The color of each node by a division.

    A sector has the color of the sub-cell that its dart is in or, in state 0, shows. The center
    goes to the sub-cell with the most separate stretches of the ring, which it connects. Of other
    sub-cells with several stretches the nodes are not connected.
    """
    colors = [0] * len(refined.cell)
    for nodes, darts, blocks in zip(refined.nodes, refined.graph.lists, painting, strict=True):
        block_of = {dart: block for block in blocks for dart in block.darts}
        shown = next((block_of[dart] for dart in reversed(darts) if dart in block_of), blocks[0])
        ring: list[Block] = []
        for dart in darts:
            shown = block_of.get(dart, shown)
            ring.append(shown)
        starts = [own for before, own in pairwise(ring[-1:] + ring) if own is not before]
        center = max(blocks, key=lambda block: sum(own is block for own in starts))
        for node in nodes:
            colors[node] = center.color
        if ring:
            for place, node in enumerate(nodes[:-1]):
                colors[node] = ring[place % len(ring)].color
    return colors
