"""A division improved window by window: some cells are solved anew, all others stay as they are.

What lies outside a window is contracted: a connected piece of a segment becomes one cell of one
color, with all the darts by which it meets the window. The full model of such a graph is small, so
that large neighborhood search (Shaw, CP 1998) gets on where the model of the whole is hopeless.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.dart_graph import Dart, DartGraph
from cellcolor.solvers.cpsat.model.full import full_model, model_size, read_painting
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, segments_of
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed
from cellcolor.union_find import UnionFind

__all__ = ["improve"]

WINDOW_SIZES = (1_000, 2_000, 4_000, 8_000)
"""Terms of a window's model, about: it is solved in some tenths of a second."""

LARGEST_WINDOW = 30_000
"""Terms of a window's model, with what lies around it."""

FRUITLESS = 3
"""Tries for each segment of a division before nothing better is expected."""


@dataclass(frozen=True, slots=True)
class _Window:
    """Some cells, and all that touches them contracted.

    Attributes:
        graph: the window's cells first, then a cell for each piece outside.
        cells: the cell of the whole graph that each of the first cells is.
        darts: the dart of the whole graph that each dart is.
        blocks: for each dart of the whole graph that faces the window from outside, the block that
            it belongs to or, in state 0, shows.
    """

    graph: DartGraph
    cells: list[int]
    darts: list[int]
    blocks: dict[int, Block]


def improve(
    graph: DartGraph, painting: Painting, solve: SolveWithSeed, seed: int, deadline: Deadline
) -> Iterator[Painting]:
    """Better and better divisions of a graph, each with a segment less at least.

    Args:
        graph: the dart graph.
        painting: a canonical painting of it.
        solve: runs a model with a seed, within limits.
        seed: of the choice of windows.
        deadline: when to stop.
    """
    chance = random.Random(seed)
    fruitless = 0
    segments = segments_of(graph, painting)
    while fruitless < FRUITLESS * len(segments) and not deadline.over:
        # Small segments are the likeliest that others can do without.
        weights = [1 / len(segment) for segment in segments]
        (segment,) = chance.choices(segments, weights)
        fruitless += 1
        cells = _cells_around(graph, segment, chance.choice(WINDOW_SIZES), chance)
        window = _contracted(graph, painting, cells)
        # A piece outside may face the window with many darts.
        if not cells or model_size(window.graph) > LARGEST_WINDOW:
            continue
        changed = _solved(window, graph, painting, solve, chance.randrange(2**20))
        if changed is None:
            continue
        found = segments_of(graph, changed)
        if len(found) <= len(segments):
            if len(found) < len(segments):
                fruitless = 0
                yield changed
            painting, segments = changed, found


def _cells_around(
    graph: DartGraph, segment: set[int], room: float, chance: random.Random
) -> list[int]:
    """A segment's cells, as many as a window has room for, and those around them.

    None at all if the search begins at a cell that is too large itself, or among such cells.
    """
    start = chance.choice(sorted(segment))
    found = [start]
    size = 0.0
    seen = {start}
    kept: list[int] = []
    for cell in found:
        terms = 2 / 3 * len(graph.lists[cell]) ** 3
        if size + terms > room:
            continue
        size += terms
        kept.append(cell)
        beyond = sorted({graph.darts[graph.darts[dart].twin].cell for dart in graph.lists[cell]})
        chance.shuffle(beyond)
        # The segment's own cells come first.
        for other in sorted(beyond, key=lambda cell: cell not in segment):
            if other not in seen:
                seen.add(other)
                found.append(other)
    return kept


def _contracted(graph: DartGraph, painting: Painting, cells: list[int]) -> _Window:
    inside = set(cells)
    piece_of: dict[int, Block] = {}
    pieces: UnionFind[int] = UnionFind()
    for cell, blocks in enumerate(painting):
        if cell not in inside:
            for block in blocks:
                piece_of |= dict.fromkeys(block.darts, block)
    for dart, block in piece_of.items():
        other = piece_of.get(graph.darts[dart].twin)
        if other is not None:
            pieces.union(id(block), id(other))
    facing: dict[int, Block] = {}
    for cell in cells:
        for dart in graph.lists[cell]:
            twin = graph.darts[dart].twin
            beyond = graph.darts[twin].cell
            if beyond not in inside:
                facing[twin] = _shown(graph.lists[beyond], painting[beyond], twin)
    lists = [
        [d for d in graph.lists[cell] if _can_join(graph, d, facing.get(graph.darts[d].twin))]
        for cell in cells
    ]
    kept = {dart for own in lists for dart in own}
    outside: dict[int, list[int]] = {}
    for dart, block in facing.items():
        if graph.darts[dart].twin in kept:
            outside.setdefault(pieces[id(block)], []).append(dart)
    colors = [graph.colors[cell] for cell in cells]
    colors += [frozenset((facing[darts[0]].color,)) for darts in outside.values()]
    order = [*lists, *outside.values()]
    darts = [dart for own in order for dart in own]
    index = {dart: number for number, dart in enumerate(darts)}
    numbered = [(tuple(index[dart] for dart in own),) for own in order]
    whole = [
        Dart(
            graph.darts[dart].name,
            cell,
            index[graph.darts[dart].twin],
            # What faces the window from outside has one color, and its other side no more.
            graph.darts[dart].colors
            & colors[cell]
            & (
                frozenset((facing[graph.darts[dart].twin].color,))
                if graph.darts[dart].twin in facing
                else colors[cell]
            ),
        )
        for cell, own in enumerate(order)
        for dart in own
    ]
    reduced = DartGraph(tuple(whole), tuple(numbered), tuple(colors), graph.seams)
    return _Window(reduced, cells, darts, facing)


def _can_join(graph: DartGraph, dart: int, beyond: Block | None) -> bool:
    return beyond is None or beyond.color in graph.darts[dart].colors


def _shown(darts: Sequence[int], blocks: Sequence[Block], dart: int) -> Block:
    """The block that a dart belongs to or, in state 0, shows: the last one met before it."""
    block_of = {its: block for block in blocks for its in block.darts}
    place = darts.index(dart)
    walk = [*reversed(darts[: place + 1]), *reversed(darts[place + 1 :])]
    return next((block_of[d] for d in walk if d in block_of), blocks[0])


def _solved(
    window: _Window, graph: DartGraph, painting: Painting, solve: SolveWithSeed, seed: int
) -> Painting | None:
    """The whole painting with the window's cells solved anew; None if nothing was found."""
    built = full_model(window.graph, _regions(window.graph))
    solver, status = solve(built.model, seed)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    found = read_painting(window.graph, built.variables, solver)
    changed = [[Block(block.color, set(block.darts)) for block in blocks] for blocks in painting]
    for cell, blocks in zip(window.cells, found, strict=False):
        changed[cell] = [Block(b.color, {window.darts[d] for d in b.darts}) for b in blocks]
    joined = {window.darts[dart] for blocks in found for block in blocks for dart in block.darts}
    for dart, block in window.blocks.items():
        cell = graph.darts[dart].cell
        own = changed[cell][next(n for n, b in enumerate(painting[cell]) if b is block)]
        if dart in joined:
            own.darts.add(dart)
        else:
            own.darts.discard(dart)
    return canonical(graph, changed)


def _regions(graph: DartGraph) -> list[Region]:
    """The color regions of a dart graph."""
    reached: UnionFind[tuple[int, int]] = UnionFind(
        (color, cell) for cell, colors in enumerate(graph.colors) for color in colors
    )
    for dart in graph.darts:
        for color in dart.colors:
            reached.union((color, dart.cell), (color, graph.darts[dart.twin].cell))
    return [
        (next(iter(places))[0], frozenset(cell for _, cell in places)) for places in reached.sets()
    ]
