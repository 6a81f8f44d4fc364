"""A division improved window by window: some cells are solved anew, all others stay as they are.

What lies outside a window is contracted: a connected piece of a segment becomes one cell of one
color, with all the darts by which it meets the window. The full model of such a graph is small, and
its routes are short, so that large neighborhood search (Shaw, CP 1998) gets on where the whole is
hopeless. All that is done for a window takes time by what it meets, not by the size of the whole.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.dart_graph import Dart, DartGraph
from cellcolor.solvers.cpsat.model.full import full_model, model_size, read_painting
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, segments_of
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed
from cellcolor.solvers.cpsat.routes.dropping import drop_segments
from cellcolor.union_find import UnionFind

WINDOW_SIZES = (1_000, 2_000, 4_000, 8_000)
"""Terms of a window's model, about: it is solved in some tenths of a second."""

LARGEST_WINDOW = 30_000
"""Terms of a window's model, with what lies around it."""

ROUTED = 0.95
"""The share of windows that are improved by routes."""

ROUTED_SIZES = (3_000, 6_000, 12_000, 25_000, 50_000)
"""Terms that their models would have. Larger ones come as smaller ones are of no more use."""

SHARE = 0.1
"""Of the time that is left, for the routes of one window."""

TRIES = 1
"""Segments left out for each segment of a window that is improved by routes."""

STALE = 50
"""Segments for each gain that is not looked for among them, before they are listed anew."""

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
        painting: what the division is on the window's graph.
    """

    graph: DartGraph
    cells: list[int]
    darts: list[int]
    blocks: dict[int, Block]
    painting: Painting


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
    fruitless = gained = 0
    block_of = {dart: block for blocks in painting for block in blocks for dart in block.darts}
    segments = segments_of(graph, painting)
    while fruitless < FRUITLESS * len(segments) and not deadline.over:
        # Small segments are the likeliest that others can do without.
        weights = [1 / len(segment) for segment in segments]
        (segment,) = chance.choices(segments, weights)
        fruitless += 1
        routed = chance.random() < ROUTED
        largest = 2 + 2 * fruitless // len(segments)
        room = chance.choice(ROUTED_SIZES[:largest] if routed else WINDOW_SIZES)
        cells = _cells_around(graph, segment, room, chance)
        if not cells:
            continue
        window = _contracted(graph, painting, block_of, cells)
        if routed:
            found = _routed(window, chance.randrange(2**20), deadline.share(SHARE))
        else:
            found = _solved(window, solve, chance.randrange(2**20))
        if found is None:
            continue
        fewer = len(segments_of(window.graph, window.painting)) - len(
            segments_of(window.graph, found)
        )
        if fewer < 0:
            continue
        painting = _with_window(graph, painting, window, found, block_of)
        if fewer:
            fruitless = 0
            gained += fewer
            if gained * STALE >= len(segments):
                segments, gained = segments_of(graph, painting), 0
            yield painting


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


def _contracted(
    graph: DartGraph, painting: Painting, block_of: Mapping[int, Block], cells: list[int]
) -> _Window:
    inside = set(cells)
    facing: dict[int, Block] = {}
    for cell in cells:
        for dart in graph.lists[cell]:
            twin = graph.darts[dart].twin
            beyond = graph.darts[twin].cell
            if beyond not in inside:
                facing[twin] = _shown(graph.lists[beyond], painting[beyond], twin)
    pieces = _pieces(graph, block_of, facing.values(), inside)
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
    before = _restricted(reduced, painting, block_of, cells, darts)
    return _Window(reduced, cells, darts, facing, before)


def _pieces(
    graph: DartGraph, block_of: Mapping[int, Block], facing: Iterable[Block], inside: set[int]
) -> dict[int, int]:
    """By the id of each block outside a window the piece of its segment that it is in.

    Only blocks that hang together with those that face the window are looked at.
    """
    piece: dict[int, int] = {}
    for number, first in enumerate(facing):
        if id(first) in piece:
            continue
        piece[id(first)] = number
        reached = [first]
        for block in reached:
            for dart in block.darts:
                twin = graph.darts[dart].twin
                if graph.darts[twin].cell in inside:
                    continue
                other = block_of[twin]
                if id(other) not in piece:
                    piece[id(other)] = number
                    reached.append(other)
    return piece


def _restricted(
    reduced: DartGraph,
    painting: Painting,
    block_of: Mapping[int, Block],
    cells: Sequence[int],
    darts: Sequence[int],
) -> Painting:
    """What a division is on a window's graph."""
    joined = {
        number
        for number, dart in enumerate(darts)
        if dart in block_of and darts[reduced.darts[number].twin] in block_of
    }
    index = {darts[number]: number for number in joined}
    own = [
        [Block(b.color, {index[dart] for dart in b.darts if dart in index}) for b in painting[cell]]
        for cell in cells
    ]
    beyond = [
        [Block(min(colors), joined.intersection(numbers))]
        for numbers, colors in zip(
            reduced.lists[len(cells) :], reduced.colors[len(cells) :], strict=True
        )
    ]
    return [[b for b in blocks if b.darts] or blocks[:1] for blocks in [*own, *beyond]]


def _can_join(graph: DartGraph, dart: int, beyond: Block | None) -> bool:
    return beyond is None or beyond.color in graph.darts[dart].colors


def _shown(darts: Sequence[int], blocks: Sequence[Block], dart: int) -> Block:
    """The block that a dart belongs to or, in state 0, shows: the last one met before it."""
    block_of = {its: block for block in blocks for its in block.darts}
    place = darts.index(dart)
    walk = [*reversed(darts[: place + 1]), *reversed(darts[place + 1 :])]
    return next((block_of[d] for d in walk if d in block_of), blocks[0])


def _routed(window: _Window, seed: int, deadline: Deadline) -> Painting | None:
    """The best of the window that leaving segments out leads to; None if that is nothing better."""
    best = None
    for better in drop_segments(
        window.graph, window.painting, _regions(window.graph), seed, deadline, TRIES
    ):
        best = better
    return best


def _solved(window: _Window, solve: SolveWithSeed, seed: int) -> Painting | None:
    """The window solved anew; None if it is too large, or nothing was found."""
    # A piece outside may face the window with many darts.
    if model_size(window.graph) > LARGEST_WINDOW:
        return None
    built = full_model(window.graph, _regions(window.graph))
    solver, status = solve(built.model, seed)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return read_painting(window.graph, built.variables, solver)


def _with_window(
    graph: DartGraph,
    painting: Painting,
    window: _Window,
    found: Painting,
    block_of: dict[int, Block],
) -> Painting:
    """The whole painting with the window as it was found; the blocks of darts change with it."""
    joined = {window.darts[dart] for blocks in found for block in blocks for dart in block.darts}
    around = {graph.darts[dart].cell for dart in window.blocks}
    changed = list(painting)
    for cell, blocks in zip(window.cells, found, strict=False):
        changed[cell] = [Block(b.color, {window.darts[d] for d in b.darts}) for b in blocks]
    copies: dict[int, Block] = {}
    for cell in around:
        for block in painting[cell]:
            copies[id(block)] = Block(block.color, set(block.darts))
        changed[cell] = [copies[id(block)] for block in painting[cell]]
    for dart, block in window.blocks.items():
        if dart in joined:
            copies[id(block)].darts.add(dart)
        else:
            copies[id(block)].darts.discard(dart)
    for cell in around:
        # A block that was joined with the window only may have no darts left.
        changed[cell] = [b for b in changed[cell] if b.darts] or changed[cell][:1]
    changed = canonical(graph, changed, around.union(window.cells))
    for cell, (old, new) in enumerate(zip(painting, changed, strict=True)):
        if old is not new:
            for dart in graph.lists[cell]:
                block_of.pop(dart, None)
            block_of.update({dart: block for block in new for dart in block.darts})
    return changed


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
