"""The sector graph: every cell cut into rings of sectors around a center.

A division of the cells is a coloring of the sectors, and cutting paths are the borders between
colors. They cannot cross, because the graph is drawn in the plane of each cell. Segments are the
connected sets of sectors of one color. The model (``formulation``) and local search both work on
this graph. Each division can be drawn on it in one way: each sub-cell takes the sectors of its
darts, and connects them in the ring of its nesting height (docs/formulation.md, "Rings").
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block, Painting
from cellcolor.union_find import UnionFind


class Link(NamedTuple):
    """Two neighboring sectors; the link is side 0 of the one, and side 1 of the other.

    Attributes:
        dart: the dart of ``one`` across which the other one lies; -1 if both are of one cell.
    """

    one: int
    other: int
    dart: int


@dataclass(frozen=True)
class SectorGraph:
    """Sectors, and the links between them in their order around each sector.

    A cell with n darts on its cyclic list has rings of n sectors, one for each dart, and a center.
    Without rings it is all center.

    Attributes:
        nodes: the sectors of each cell: ring by ring from the border inwards, and the center.
        rings: how many rings each cell has.
        cell: the cell of each sector.
        at: the sector at each dart.
        links: the links that are drawn.
        around: for each sector its links counterclockwise, each with the side of it.
    """

    graph: DartGraph
    nodes: list[range] = field(default_factory=list)
    rings: list[int] = field(default_factory=list)
    cell: list[int] = field(default_factory=list)
    at: list[int] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    around: list[list[tuple[int, int]]] = field(default_factory=list)

    @cached_property
    def beside(self) -> list[list[int]]:
        """The neighbors of each sector in its cell."""
        found: list[list[int]] = [[] for _ in self.cell]
        for one, other, dart in self.links:
            if dart < 0 and other not in found[one]:
                found[one].append(other)
                found[other].append(one)
        return found

    @cached_property
    def across(self) -> list[list[tuple[int, frozenset[int]]]]:
        """The sectors across the darts at each sector, and the colors joinable there."""
        found: list[list[tuple[int, frozenset[int]]]] = [[] for _ in self.cell]
        for number, dart in enumerate(self.graph.darts):
            found[self.at[number]].append((self.at[dart.twin], dart.colors))
        return found

    @cached_property
    def faces(self) -> tuple[list[tuple[int, int]], int]:
        """The faces on both sides of each link, and how many faces there are.

        A face is a closed walk that leaves each sector by the link after the one it came by.
        """
        following = {
            half: after
            for own in self.around
            for half, after in zip(own, own[1:] + own[:1], strict=True)
        }
        face: dict[tuple[int, int], int] = {}
        count = 0
        for first in following:
            if first in face:
                continue
            half = first
            while half not in face:
                face[half] = count
                half = following[half[0], 1 - half[1]]
            count += 1
        return [(face[number, 0], face[number, 1]) for number in range(len(self.links))], count


def sector_graph(
    graph: DartGraph,
    most_rings: int | None = None,
    deadline: Deadline = NEVER,
    most_colors: int | None = None,
) -> SectorGraph:
    """Cut every cell into sectors, with as many rings as every scheme can be drawn in.

    Args:
        most_rings: of a cell; some schemes may then have no room.
        most_colors: of all sectors together, each in any color of its cell.

    Raises:
        TooLarge: there would be more colors; what is too large is not made.
    """
    made = SectorGraph(graph)
    made.at.extend([0] * len(graph.darts))
    colors = 0
    for cell, darts in enumerate(graph.lists):
        deadline.check()
        first, count = len(made.cell), len(darts)
        most = len(darts) if most_rings is None else most_rings
        rings = _enough_rings([graph.darts[dart].colors for dart in darts], most)
        colors += (count * rings + 1) * len(graph.colors[cell])
        if most_colors is not None and colors > most_colors:
            need = f"more than {most_colors} literals for the colors of sectors"
            raise TooLarge(f"The model was not built: it would need {need}.")
        made.nodes.append(range(first, first + count * rings + 1))
        made.rings.append(rings)
        made.cell.extend([cell] * len(made.nodes[-1]))
        for place, number in enumerate(darts):
            made.at[number] = first + place if rings else first
    number_of = {}
    for number, dart in enumerate(graph.darts):
        one, other = made.at[number], made.at[dart.twin]
        if number < dart.twin and one != other:
            number_of[number], number_of[dart.twin] = (len(made.links), 0), (len(made.links), 1)
            made.links.append(Link(one, other, number))
    for cell, darts in enumerate(graph.lists):
        _add_rings(made, cell, [number_of.get(dart) for dart in darts])
    return made


def _add_rings(made: SectorGraph, cell: int, outward: Sequence[tuple[int, int] | None]) -> None:
    """Link the sectors of a cell in order; ``outward`` has the link across each dart, if any."""
    first, count, rings = made.nodes[cell][0], len(outward), made.rings[cell]

    def link(one: int, other: int) -> int:
        made.links.append(Link(one, other, -1))
        return len(made.links) - 1

    for ring in range(rings):
        row = [first + ring * count + place for place in range(count)]
        along = [link(node, row[(place + 1) % count]) for place, node in enumerate(row)]
        inward = [link(node, min(node + count, made.nodes[cell][-1])) for node in row]
        for place, out in enumerate(outward):
            made.around.append(
                [
                    *([] if out is None else [out]),
                    (along[place], 0),
                    (inward[place], 0),
                    (along[place - 1], 1),
                ]
            )
        outward = [(number, 1) for number in inward]
    made.around.append([half for half in outward if half is not None])


def _enough_rings(colors: Sequence[frozenset[int]], most: int) -> int:
    """How many rings every scheme can be drawn in, or ``most`` if these are more.

    With m nested chords between darts of a common color at most, they are (m - 1) / 2, rounded up
    (docs/formulation.md).

    Args:
        colors: those joinable at each dart of a cyclic list.
    """
    if len(colors) < 2 or len(frozenset[int]().union(*colors)) < 2:
        return 0  # sub-cells that have darts in state 1 would be of one color
    return min(most, _longest_chain(colors, 2 * most) // 2)


def _longest_chain(colors: Sequence[frozenset[int]], enough: int) -> int:
    """The most nested chords between darts of a common color; it ends where these are enough.

    They are nested in some stretch of the cyclic list: ``most[first]`` is the length of the longest
    chain in the stretch of ``size`` darts from the first.
    """
    count = len(colors)
    share = np.array([[not one.isdisjoint(other) for other in colors] for one in colors])
    first = np.arange(count)
    shorter = most = np.zeros(count, dtype=np.int64)
    for size in range(2, count + 1):
        chord = share[first, (first + size - 1) % count]
        within = np.where(chord, 1 + np.roll(shorter, -1), 0)
        shorter, most = most, np.maximum.reduce([most, np.roll(most, -1), within])
        if most.max() >= enough:
            break
    return int(most.max())


def painting_of_sectors(sectors: SectorGraph, colors: Sequence[int]) -> Painting:
    """The division in which each sector has the given color."""
    together = UnionFind(range(len(colors)))
    for one, other, dart in sectors.links:
        if dart < 0 and colors[one] == colors[other]:
            together.union(one, other)
    blocks = [Block(color, set()) for color in colors]
    for number, side in enumerate(sectors.graph.darts):
        node, color = sectors.at[number], colors[sectors.at[number]]
        if color == colors[sectors.at[side.twin]] and color in side.colors:
            blocks[together[node]].darts.add(number)
    painting = []
    for nodes in sectors.nodes:
        own = [blocks[root] for root in dict.fromkeys(together[node] for node in nodes)]
        painting.append([block for block in own if block.darts] or own[:1])
    return painting


def sector_colors(sectors: SectorGraph, painting: Painting) -> list[int]:
    """The color of each sector in a canonical painting of the same graph.

    Where there are too few rings, sub-cells that are nested too deeply come apart.
    """
    colors: list[int] = []
    for cell, blocks in enumerate(painting):
        rings, shown = sectors.rings[cell], _shown(sectors.graph.lists[cell], blocks)
        if not rings or len({id(block) for block in shown}) < 2:
            inner = shown[0] if shown else blocks[0]
            colors += [inner.color] * len(sectors.nodes[cell])
        else:
            rows, center = _rows(shown, rings)
            colors += [block.color for row in rows for block in row]
            colors.append(center.color)
    return colors


def _shown(darts: Sequence[int], blocks: Sequence[Block]) -> list[Block]:
    """The block at each dart of a cyclic list; a dart in state 0 shows the one before it."""
    block_of = {dart: block for block in blocks for dart in block.darts}
    shown = next((block_of[dart] for dart in reversed(darts) if dart in block_of), blocks[0])
    found = []
    for dart in darts:
        shown = block_of.get(dart, shown)
        found.append(shown)
    return found


def _rows(shown: Sequence[Block], rings: int) -> tuple[list[list[Block]], Block]:
    """The block at each place of each ring, and at the center."""
    starts = [own for before, own in pairwise([shown[-1], *shown]) if own is not before]

    def order(root: Block) -> tuple[int, int]:
        heights = _nesting(shown, root)[1].items()
        deepest = max((height for block, height in heights if block != id(root)), default=0)
        return deepest, -sum(own is root for own in starts)

    root = min({id(block): block for block in shown}.values(), key=order)
    above, height = _nesting(shown, root)
    rows, row = [], list(shown)
    for ring in range(rings):
        row = [
            above[id(block)] if block is not root and height[id(block)] < ring else block
            for block in row
        ]
        rows.append(row)
    return rows, root


def _nesting(shown: Sequence[Block], root: Block) -> tuple[dict[int, Block], dict[int, int]]:
    """For each block the one around it, seen from a root, and how deeply others are nested in it.

    Blocks do not cross, so those that are open form a stack.
    """
    start = next(place for place, block in enumerate(shown) if block is root)
    turned = [*shown[start:], *shown[:start]]
    last = {id(block): place for place, block in enumerate(turned)}
    last[id(root)] = len(turned)
    stack: list[Block] = []
    above: dict[int, Block] = {}
    height: dict[int, int] = {}
    for place, block in enumerate([*turned, root]):
        while stack and last[id(stack[-1])] < place:
            done = stack.pop()
            height[id(stack[-1])] = max(height[id(stack[-1])], height[id(done)] + 1)
        if id(block) not in height:
            height[id(block)] = 0
            above[id(block)] = stack[-1] if stack else root
            stack.append(block)
    return above, height
