"""Divisions drawn on sectors, and lone darts drawn with seams.

A coloring of sectors says everything about a division, and a division can be drawn on sectors in
one way: each sub-cell takes the sectors of its darts, and connects them in the ring of its nesting
height (docs/formulation.md, "Rings"). A solution file writes lone darts with seams.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.cpsat.painting import Block, Painting, canonical
from cellcolor.solvers.cpsat.parts import Loops
from cellcolor.solvers.cpsat.sectors import SectorGraph
from cellcolor.union_find import UnionFind


def sector_colors(sectors: SectorGraph, painting: Painting) -> tuple[list[int], dict[int, int]]:
    """The color of each sector in a canonical painting of the same graph.

    Where a cell has fewer rings than its sub-cells need, those that are nested too deeply come
    apart.

    Returns:
        The colors, and for each lone dart's sector the one that it is attached to, if any.
    """
    colors = [0] * len(sectors.cell)
    attached: dict[int, int] = {}
    for cell, blocks in enumerate(painting):
        own = sectors.nodes[cell]
        loops = sectors.graph.loops[cell]
        darts = loops[0] if loops else ()
        rings, count = sectors.rings[cell], len(darts)
        shown = _shown(darts, blocks)
        if not rings or len({id(block) for block in shown}) < 2:
            inner = shown[0] if shown else blocks[0]
            for node in own[: count * rings + 1]:
                colors[node] = inner.color
        else:
            rows, center = _rows(shown, rings)
            for ring, row in enumerate(rows):
                for place, block in enumerate(row):
                    colors[own[ring * count + place]] = block.color
            colors[own[count * rings]] = center.color
        _attach(sectors, cell, blocks, shown, colors, attached)
    return colors, attached


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
    best: tuple[tuple[int, int], list[list[Block]], Block] | None = None
    starts = [own for before, own in pairwise([shown[-1], *shown]) if own is not before]
    for root in {id(block): block for block in shown}.values():
        above, height = _nesting(shown, root)
        deepest = max((height[id(b)] for b in shown if b is not root), default=0)
        order = deepest, -sum(own is root for own in starts)
        if best is not None and best[0] <= order:
            continue
        rows = []
        row = list(shown)
        for ring in range(rings):
            row = [
                above[id(block)] if block is not root and height[id(block)] < ring else block
                for block in row
            ]
            rows.append(row)
        best = order, rows, root
    assert best is not None
    return best[1], best[2]


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
    for place, block in enumerate(turned):
        while stack and last[id(stack[-1])] < place:
            done = stack.pop()
            height[id(stack[-1])] = max(height[id(stack[-1])], height[id(done)] + 1)
        if id(block) not in height:
            height[id(block)] = 0
            above[id(block)] = stack[-1] if stack else root
            stack.append(block)
    while len(stack) > 1:
        done = stack.pop()
        height[id(stack[-1])] = max(height[id(stack[-1])], height[id(done)] + 1)
    return above, height


def _attach(
    sectors: SectorGraph,
    cell: int,
    blocks: Sequence[Block],
    shown: Sequence[Block],
    colors: list[int],
    attached: dict[int, int],
) -> None:
    """Color the sectors of lone darts, and attach those in state 1 to their sub-cells."""
    graph = sectors.graph
    loops = graph.loops[cell]
    host = {
        id(block): sectors.at[dart]
        for dart, block in zip(loops[0] if loops else (), shown, strict=True)
    }
    block_of = {dart: block for block in blocks for dart in block.darts}
    inner = shown[0] if shown else blocks[0]
    for loop in loops[1:]:
        node, block = sectors.at[loop[0]], block_of.get(loop[0], inner)
        colors[node] = block.color
        if id(block) in host:
            attached[node] = host[id(block)]
        else:
            host[id(block)] = node


def moved(known: DartGraph, painting: Painting, target: DartGraph) -> Painting:
    """A painting on another graph of the same cells.

    Strands that the target does not know are cut; the two sides of a seam's strand are one sub-cell
    then.
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


def seamed(
    instance: Instance,
    strands: Mapping[int, int],
    graph: DartGraph,
    painting: Painting,
    loops: Loops,
    places: Sequence[Seam],
) -> tuple[DartGraph, Painting]:
    """A painting whose lone darts are drawn with seams, so that each cell has one cyclic list.

    Args:
        strands: of each live edge.
        graph: with lone darts apart.
        painting: of it.
        loops: of each cell, between which seams run.
        places: the seams of all cells.
    """
    widths = {seam.id: seam.strands for seam in graph.seams}
    seams_of: dict[int, list[Seam]] = {}
    for seam in places:
        seams_of.setdefault(seam.cell, []).append(seam)
    lists = [
        _SeamedList(graph, blocks, loops[cell], seams_of.get(cell, ()), widths)
        for cell, blocks in enumerate(painting)
    ]
    seams = [replace(seam, strands=widths.get(seam.id, 0)) for seam in places]
    made = dart_graph(instance, strands, seams, loops)
    found = [
        [
            Block(block.color, {made.number_of[name] for name in names})
            for block, names in own.parts()
        ]
        for own in lists
    ]
    return made, canonical(made, found)


class _SeamedList:
    """The cyclic list of a cell, into which one lone dart after the other is put.

    A seam to a lone dart crosses the sub-cells that separate its corner from the dart's sub-cell,
    and cuts each of them into two parts.
    """

    def __init__(
        self,
        graph: DartGraph,
        blocks: Sequence[Block],
        loops: Sequence[Sequence[int]],
        seams: Sequence[Seam],
        widths: dict[int, int],
    ) -> None:
        self._part_of: dict[Strand, int] = {}
        self._block_of: list[Block] = []
        for block in blocks:
            self._part_of |= {graph.darts[d].name: len(self._block_of) for d in block.darts}
            self._block_of.append(block)
        named: dict[int, list[Strand]] = {}
        for name in sorted(graph.number_of, key=graph.number_of.__getitem__):
            named.setdefault(name[0], []).append(name)
        # All seams leave after the first dart of the first loop, the last one first.
        first, *others = loops or ((),)
        head = [name for dart in first[:1] for name in named.get(dart, ())]
        tail = [name for dart in first[1:] for name in named.get(dart, ())]
        sections: list[list[Strand]] = []
        lone = []
        for seam, loop in zip(seams, others, strict=True):
            names = [name for d in (*loop[1:], *loop[:1]) for name in named.get(d, ())]
            if len(names) == 1 and not widths.get(seam.id):
                lone.append((len(sections), seam, names[0]))
                names = []
            through = named.get(seam.id, []), named.get(-seam.id, [])
            sections.append([*through[0], *names, *through[1]])
        for place, seam, name in lone:
            before = [*head, *(n for own in reversed(sections[place + 1 :]) for n in own)]
            after = [*(n for own in reversed(sections[:place]) for n in own), *tail]
            sections[place], widths[seam.id] = self._led(seam, name, before, after)

    def parts(self) -> Iterator[tuple[Block, list[Strand]]]:
        """The parts of sub-cells, each with the block that it belongs to and its darts."""
        names: list[list[Strand]] = [[] for _ in self._block_of]
        for name, part in self._part_of.items():
            names[part].append(name)
        yield from zip(self._block_of, names, strict=True)

    def _led(
        self, seam: Seam, name: Strand, before: list[Strand], after: list[Strand]
    ) -> tuple[list[Strand], int]:
        """Lead a seam from between two halves of the list to a dart; what goes there, its width."""
        crossed = self._crossed(name, before, after)
        out, back = [], []
        for strand, part in enumerate(crossed, start=1):
            # The part on the side of what comes before keeps its number.
            self._block_of.append(self._block_of[part])
            for other in self._passed:
                if self._part_of.get(other) == part:
                    self._part_of[other] = len(self._block_of) - 1
            self._part_of[seam.id, strand] = part
            self._part_of[-seam.id, strand] = len(self._block_of) - 1
            out.append((seam.id, strand))
            back.append((-seam.id, strand))
        return [*out, name, *reversed(back)], len(crossed)

    def _crossed(self, name: Strand, before: list[Strand], after: list[Strand]) -> list[int]:
        """The parts between the corner and the nearest part of a dart's sub-cell, in order."""
        self._passed: Sequence[Strand] = ()
        if name not in self._part_of:
            return []
        block = self._block_of[self._part_of[name]]
        whole = [*after, *before]
        goal = [
            place
            for place, other in enumerate(whole, start=1)
            if other != name
            and other in self._part_of
            and self._block_of[self._part_of[other]] is block
        ]
        if not goal:
            return []  # its sub-cell has no other dart here yet
        best: list[int] | None = None
        for end in goal:
            near = {self._part_of[n] for n in reversed(whole[:end]) if n in self._part_of}
            far = {self._part_of[n] for n in whole[end:] if n in self._part_of}
            target = self._part_of[whole[end - 1]]
            crossed = [p for p in self._in_order(whole[:end]) if p in near & far and p != target]
            if best is None or len(crossed) < len(best):
                best, self._passed, self._part_of[name] = crossed, whole[:end], target
        return best or []

    def _in_order(self, names: Sequence[Strand]) -> list[int]:
        return list(dict.fromkeys(self._part_of[n] for n in names if n in self._part_of))
