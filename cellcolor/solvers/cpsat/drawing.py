"""Divisions drawn on sectors.

A coloring of sectors says everything about a division, and a division can be drawn on sectors in
one way: each sub-cell takes the sectors of its darts, and connects them in the ring of its nesting
height (docs/formulation.md, "Rings").
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from cellcolor.solvers.cpsat.painting import Block, Painting
from cellcolor.solvers.cpsat.sectors import SectorGraph


def sector_colors(sectors: SectorGraph, painting: Painting) -> list[int]:
    """The color of each sector in a canonical painting of the same graph.

    Where a cell has fewer rings than its sub-cells need, those that are nested too deeply come
    apart.
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
