"""A colored division of a dart graph, and its canonical form, the scheme."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from cellcolor.data.cells_and_edges import DartName, strand_of
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam, number_segments
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.interface import Start
from cellcolor.union_find import UnionFind


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
    """The painting as a solution writes it, with a given number of strands for every edge."""
    seams = {seam.id for seam in graph.seams}

    def name(dart: int) -> DartName:
        signed, strand = graph.darts[dart].name
        return signed if strands == 1 and abs(signed) not in seams else (signed, strand)

    blocks = [
        [(block.color, tuple(name(dart) for dart in sorted(block.darts))) for block in cell]
        for cell in painting
    ]
    return number_segments(blocks)


def painting_of(graph: DartGraph, division: Division) -> Painting:
    """A solution's division on a graph that has the strands it names, or more."""
    return [
        [
            Block(s.color, {graph.number_of[strand_of(dart)] for dart in s.darts})
            for s in cell.subcells
        ]
        for cell in division
    ]


def moved(known: DartGraph, painting: Painting, target: DartGraph) -> Painting:
    """A painting on another graph of the same cells.

    Strands that the target lacks are cut; the two sides of a seam's strand are one sub-cell then.
    """
    seams = {seam.id for seam in known.seams}
    found: Painting = []
    for blocks in painting:
        block_of = {dart: number for number, b in enumerate(blocks) for dart in b.darts}
        together = UnionFind(range(len(blocks)))
        for dart, number in block_of.items():
            name, twin = known.darts[dart].name, known.darts[dart].twin
            if abs(name[0]) in seams and name not in target.number_of:
                together.union(number, block_of[twin])
        made: dict[int, Block] = {}
        for number, block in enumerate(blocks):
            one = made.setdefault(together[number], Block(block.color, set()))
            names = (known.darts[dart].name for dart in block.darts)
            one.darts |= {target.number_of[name] for name in names if name in target.number_of}
        found.append(list(made.values()))
    return found


def begun(
    instance: Instance, strands: Mapping[int, int], start: Start, target: DartGraph
) -> Painting:
    """The scheme of a division with so many strands of each live edge, on another graph."""
    graph = dart_graph(instance, strands, start.seams)
    return canonical(target, moved(graph, painting_of(graph, start.division), target))


def segments_of(graph: DartGraph, painting: Painting) -> list[set[int]]:
    """The cells that each segment touches."""
    blocks = [(cell, block) for cell, own in enumerate(painting) for block in own]
    holder = {dart: number for number, (_, block) in enumerate(blocks) for dart in block.darts}
    together = UnionFind(range(len(blocks)))
    for dart, number in holder.items():
        together.union(number, holder[graph.darts[dart].twin])
    return [{blocks[number][0] for number in own} for own in together.sets()]


def canonical(graph: DartGraph, painting: Painting) -> Painting:
    """Make a scheme of a legal painting, with no more segments (docs/semantics.md, section 3).

    Throughout, a dart in state 0 shows the color of the sub-cell before it in cyclic order; a loop
    without darts in state 1 lies in the first sub-cell of its cell. These are repeated, cell by
    cell, until none changes anything:

    1. An edge in state 0 that shows one joinable color on both sides becomes joined.
    2. A cutting path between equal colors goes.
    3. A sub-cell with a single dart beside others goes. It ends its segment, so that the segment
       stays in one piece without it.

    None of them adds segments. The first two only add joins or remove sub-cells; the third removes
    a join and a sub-cell, so the process ends. On a graph without seams there are no more cutting
    paths than before either (docs/semantics.md, section 8).

    The blocks of the painting are changed.
    """
    cells = [_Cell(*own) for own in zip(graph.loops, painting, strict=True)]
    waiting = dict.fromkeys(reversed(range(len(cells))))
    while waiting:
        number, _ = waiting.popitem()
        cell = cells[number]
        for dart in graph.lists[number]:
            if dart in cell.block_of:
                continue
            twin = graph.darts[dart].twin
            beyond = graph.darts[twin].cell
            one, its = cell.shown(dart), cells[beyond].shown(twin)
            if one.color == its.color and one.color in graph.darts[dart].colors:
                cell.add(dart, one)
                cells[beyond].add(twin, its)
                if len(graph.loops[beyond]) > 1:
                    waiting[beyond] = None  # another sub-cell may be its first one now
        cell.merge()
        single = cell.superfluous()
        if single is not None:
            twin = graph.darts[single].twin
            beyond = graph.darts[twin].cell
            cell.remove(single)
            cells[beyond].remove(twin)
            waiting[number] = waiting[beyond] = None
    return [cell.blocks() for cell in cells]


class _Cell:
    """One cell's border, each dart in state 1 with its block."""

    def __init__(self, loops: Sequence[Sequence[int]], blocks: Sequence[Block]) -> None:
        self._loops = loops
        self.block_of = {dart: block for block in blocks for dart in block.darts}
        self.own = blocks[0]
        self._shown: dict[int, Block] | None = None

    def shown(self, dart: int) -> Block:
        """The block that a dart in state 0 shows: the last one met before it."""
        if self._shown is None:
            self._shown = {}
            first = self.blocks()[0]
            for loop in self._loops:
                joined = (self.block_of[dart] for dart in reversed(loop) if dart in self.block_of)
                last = next(joined, first)
                for place in loop:
                    last = self.block_of.get(place, last)
                    self._shown[place] = last
        return self._shown[dart]

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
            self._shown = None

    def superfluous(self) -> int | None:
        """The only dart of a block beside others, if there is such a block."""
        single = next((dart for dart, b in self.block_of.items() if len(b.darts) < 2), None)
        if single is None or all(b is self.block_of[single] for b in self.block_of.values()):
            return None
        return single

    def add(self, dart: int, block: Block) -> None:
        """Put a dart in state 1 into the block that it showed; its loop shows what it did."""
        block.darts.add(dart)
        self.block_of[dart] = block
        if len(self._loops) > 1:
            self._shown = None

    def remove(self, dart: int) -> None:
        """Put a dart in state 0."""
        block = self.block_of.pop(dart)
        block.darts.discard(dart)
        if not self.block_of:
            self.own = block
        self._shown = None

    def blocks(self) -> list[Block]:
        """The blocks with darts, in the order of their first dart; one without if there is none."""
        darts = (dart for loop in self._loops for dart in loop)
        found = {id(b): b for dart in darts if (b := self.block_of.get(dart)) is not None}
        return list(found.values()) or [self.own]


def joined(
    instance: Instance, division: Division, seams: Sequence[Seam] = (), strands: int = 1
) -> Division:
    """The scheme of a division: edges between equal joinable colors are joined.

    A division that leaves such an edge unjoined can be illegal (docs/semantics.md, section 3, rule
    5). Sub-cells of equal color without anything between them become one, and what is superfluous
    goes; there are no more segments than before (section 8).

    Args:
        division: legal otherwise; cells may be painted whole, without any joined edge.
        strands: for each live edge.
    """
    graph = dart_graph(instance, dict.fromkeys(instance.live_edges, strands), seams)
    return division_of(graph, canonical(graph, painting_of(graph, division)), strands)
