"""A colored division of a dart graph, and its canonical form, the scheme."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from networkx.utils import UnionFind

from cellcolor.data.solution import DartName, Division, number_segments
from cellcolor.solvers.cpsat.graph import DartGraph

__all__ = ["Block", "Painting", "canonical", "division_of", "moved", "painting_of"]


@dataclass(slots=True)
class Block:
    """A sub-cell: its color, and its darts in state 1."""

    color: int
    darts: set[int]


Painting = list[list[Block]]
"""The sub-cells of each cell; a cell without darts in state 1 has one without darts."""


def division_of(
    graph: DartGraph, painting: Sequence[Iterable[Block]], strands: int = 1
) -> Division:
    """The painting as a solution writes it, with so many strands for every edge."""
    seams = {seam.id for seam in graph.seams}

    def name(dart: int) -> DartName:
        signed, strand = graph.darts[dart].name
        return signed if strands == 1 and abs(signed) not in seams else (signed, strand)

    blocks = [
        [(block.color, tuple(name(dart) for dart in sorted(block.darts))) for block in cell]
        for cell in painting
    ]
    return number_segments(blocks)


def moved(graph: DartGraph, painting: Painting, target: DartGraph) -> Painting:
    """A painting on a graph with the same or more strands; the strands it does not know are cut."""
    index = {dart.name: number for number, dart in enumerate(target.darts)}
    return [
        [Block(b.color, {index[graph.darts[dart].name] for dart in b.darts}) for b in cell]
        for cell in painting
    ]


def painting_of(graph: DartGraph, division: Division) -> Painting:
    """A solution's division on a graph that has the strands it names, or more."""
    index = {dart.name: number for number, dart in enumerate(graph.darts)}
    return [
        [
            Block(s.color, {index[(n, 1) if isinstance(n, int) else n] for n in s.darts})
            for s in cell.subcells
        ]
        for cell in division
    ]


def canonical(graph: DartGraph, painting: Painting) -> Painting:
    """Make a scheme of a legal painting, with no more segments (docs/semantics.md, section 3).

    Throughout, a dart in state 0 shows the color of the sub-cell before it in cyclic order; a loop
    without darts in state 1 lies in the first sub-cell of its cell.

    1. An edge in state 0 that shows one joinable color on both sides becomes joined.
    2. A cutting path between equal colors goes.
    3. A sub-cell with a single dart beside others goes. It ends its segment, so that the segment
       stays in one piece without it. Then again from the start, with one sub-cell fewer.

    On a graph without seams there are no more cutting paths than before either (docs/solver.md).
    """
    cells = [_Cell(loops, blocks) for loops, blocks in zip(graph.loops, painting, strict=True)]
    while True:
        _join(graph, cells)
        for cell in cells:
            cell.merge()
        if not any(_dissolve(graph, cells, cell) for cell in cells):
            return [cell.blocks() for cell in cells]


class _Cell:
    """One cell's border, each dart in state 1 with its block."""

    def __init__(self, loops: Sequence[Sequence[int]], blocks: Sequence[Block]) -> None:
        self._loops = loops
        self._loop_of = {dart: loop for loop in loops for dart in loop}
        self.block_of: dict[int, Block] = {}
        self.own = blocks[0]
        for block in blocks:
            for dart in block.darts:
                self.block_of[dart] = block

    def before(self, dart: int) -> Block:
        """The block that a dart in state 0 shows: the last one met before it."""
        loop = self._loop_of[dart]
        place = loop.index(dart)
        for other in reversed([*loop[place + 1 :], *loop[:place]]):
            if other in self.block_of:
                return self.block_of[other]
        return self.blocks()[0]

    def merge(self) -> None:
        """Undo cutting paths between equal colors: successive darts, and unconnected loops."""
        for loop in self._loops:
            joined = [dart for dart in loop if dart in self.block_of]
            for dart, following in zip(joined, joined[1:] + joined[:1], strict=True):
                self._unite(self.block_of[dart], self.block_of[following])
        if len(self._loops) > 1:
            self._merge_unconnected()

    def _merge_unconnected(self) -> None:
        """Make one of two blocks of one color that no chain of loops and blocks connects."""
        connected: UnionFind[int] = UnionFind()
        for loop in self._loops:
            connected.union(*(id(self.block_of[dart]) for dart in loop if dart in self.block_of))
        first: dict[int, list[Block]] = {}
        for block in self.blocks():
            same = first.setdefault(block.color, [])
            other = next((o for o in same if connected[id(o)] != connected[id(block)]), None)
            if other is None:
                same.append(block)
            else:
                connected.union(id(other), id(block))
                self._unite(other, block)

    def _unite(self, one: Block, other: Block) -> None:
        if one is not other and one.color == other.color:
            one.darts |= other.darts
            for moved in other.darts:
                self.block_of[moved] = one

    def add(self, dart: int, block: Block) -> None:
        block.darts.add(dart)
        self.block_of[dart] = block

    def remove(self, dart: int) -> None:
        block = self.block_of.pop(dart)
        block.darts.discard(dart)
        if not self.block_of:
            self.own = block

    def blocks(self) -> list[Block]:
        found: list[Block] = []
        for dart in self._loop_of:
            block = self.block_of.get(dart)
            if block is not None and not any(block is other for other in found):
                found.append(block)
        return found or [self.own]


def _join(graph: DartGraph, cells: Sequence[_Cell]) -> None:
    for edge in graph.edges:
        dart = graph.darts[edge]
        own, other = cells[dart.cell], cells[graph.darts[dart.twin].cell]
        if edge in own.block_of:
            continue
        one, its = own.before(edge), other.before(dart.twin)
        if one.color == its.color and one.color in dart.colors:
            own.add(edge, one)
            other.add(dart.twin, its)


def _dissolve(graph: DartGraph, cells: Sequence[_Cell], cell: _Cell) -> bool:
    blocks = cell.blocks()
    single = next((block for block in blocks if len(block.darts) < 2), None)
    if len(blocks) < 2 or single is None:
        return False
    (dart,) = single.darts
    twin = graph.darts[dart].twin
    cell.remove(dart)
    cells[graph.darts[twin].cell].remove(twin)
    return True
