"""A division improved window by window: large neighborhood search (Shaw, CP 1998).

Some cells, the **window**, are divided again; all others stay as they are. What lies outside is
contracted: each **piece** of a segment outside (blocks of it that are connected without the window)
becomes one cell of one color, with all the darts by which it **faces** the window. So it counts as
a segment less when the window joins two pieces of a color. Three steps make a turn:

1. ``_Window`` contracts what is outside;
2. the small graph is divided, by ``drop_segments`` or by the full model;
3. ``_Window.put_back`` writes what was found into the whole division.

A dart outside that faces the window belongs to a block or, in state 0, shows the block before it
along the border of its cell: the one that a join across the dart would enlarge.

Small windows have small models and short routes, so this gets on where the whole is hopeless. The
time for a window depends on what it meets, not on the size of the whole.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.dart_graph import Dart, DartGraph
from cellcolor.solvers.cpsat.model.full import full_model, model_size, read_painting
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, counted, segments_of
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed
from cellcolor.solvers.cpsat.routes.dropping import drop_segments
from cellcolor.union_find import UnionFind

WINDOW_SIZES = (1_000, 2_000, 4_000, 8_000)
"""About how many terms the model of a window has; it is solved in some tenths of a second."""

LARGEST_WINDOW = 30_000
"""Terms of a window's model with all pieces around it; a larger one is not solved."""

ROUTED = 0.95
"""The share of windows that are improved by routes."""

ROUTED_SIZES = (3_000, 6_000, 12_000, 25_000, 50_000)
"""Terms that models of routed windows would have; the longer in vain, the larger the windows."""

SHARE = 0.1
"""Share of the time left that the routes of one window may take."""

TRIES = 1
"""Segments left out for each segment of a window that is improved by routes."""

STALE = 50
"""Segments are listed again, since the list is out of date, once one in so many has gone."""

FRUITLESS = 3
"""Tries for each segment of a division before nothing better is expected."""


def improve(
    graph: DartGraph,
    painting: Painting,
    solve: SolveWithSeed,
    seed: int,
    deadline: Deadline,
    costs: Sequence[int] | None = None,
) -> Iterator[Painting]:
    """Better and better divisions of a graph, each with a segment less, or one that costs less.

    Args:
        painting: a canonical painting of it.
        solve: runs a model with a seed, within limits.
        seed: of the choice of windows.
        costs: what a segment of each color costs; None for 1 each.
    """
    chance = random.Random(seed)
    fruitless = gained = 0
    block_of = {dart: block for blocks in painting for block in blocks for dart in block.darts}
    segments = segments_of(graph, painting)
    while fruitless < FRUITLESS * len(segments) and not deadline.over:
        # Small segments are the likeliest to be dispensable.
        weights = [1 / len(segment) for segment in segments]
        (segment,) = chance.choices(segments, weights)
        fruitless += 1
        routed = chance.random() < ROUTED
        largest = 2 + 2 * fruitless // len(segments)
        room = chance.choice(ROUTED_SIZES[:largest] if routed else WINDOW_SIZES)
        cells = _cells_around(graph, segment, room, chance)
        if not cells:
            continue
        window = _Window(graph, painting, block_of, cells)
        if routed:
            found = _routed(window, chance.randrange(2**20), deadline.share(SHARE))
        else:
            found = _solved(window, solve, chance.randrange(2**20), costs)
        if found is None:
            continue
        fewer = counted(window.graph, window.painting, costs) - counted(window.graph, found, costs)
        if fewer < 0:
            continue
        painting = window.put_back(painting, found, block_of)
        if fewer:
            fruitless = 0
            gained += fewer
            if gained * STALE >= len(segments):
                segments, gained = segments_of(graph, painting), 0
            yield painting


def _cells_around(
    graph: DartGraph, segment: set[int], room: float, chance: random.Random
) -> list[int]:
    """The cells of a window, breadth first from a random cell of a segment, its own cells first.

    Cells that are too large for what is left of the room are left out; there may be no others.

    Args:
        room: terms of the model, about.
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


class _Window:
    """Some cells of a division, and all that touches them contracted.

    Args:
        whole: the dart graph of the division.
        painting: the division.
        block_of: its block of each dart in state 1.
        cells: the window.

    Attributes:
        graph: the window's cells first, then a cell for each piece outside.
        painting: what the division is on this graph.
    """

    def __init__(
        self,
        whole: DartGraph,
        painting: Painting,
        block_of: Mapping[int, Block],
        cells: Sequence[int],
    ) -> None:
        self._whole = whole
        self._cells = cells
        # By each dart outside that faces the window, the block that it belongs to or shows.
        self._facing: dict[int, Block] = {}
        inside = set(cells)
        for cell in cells:
            for dart in whole.lists[cell]:
                twin = whole.darts[dart].twin
                beyond = whole.darts[twin].cell
                if beyond not in inside:
                    self._facing[twin] = _shown(whole.lists[beyond], painting[beyond], twin)
        order, colors = self._contracted(block_of)
        # The dart of the whole graph that each dart here is.
        self._darts = [dart for own in order for dart in own]
        self.graph = self._small_graph(order, colors)
        self.painting = self._restricted(painting, block_of)

    def _contracted(
        self, block_of: Mapping[int, Block]
    ) -> tuple[list[list[int]], list[frozenset[int]]]:
        """The darts of each cell of the small graph, by their numbers in the whole; its colors."""
        whole, facing = self._whole, self._facing
        piece = self._pieces(block_of)
        inside: list[list[int]] = []
        outside: dict[int, list[int]] = {}
        for cell in self._cells:
            inside.append([])
            for dart in whole.lists[cell]:
                beyond = facing.get(whole.darts[dart].twin)
                if beyond is None or beyond.color in whole.darts[dart].colors:
                    inside[-1].append(dart)
        kept = {dart for own in inside for dart in own}
        for dart, block in facing.items():
            if whole.darts[dart].twin in kept:
                outside.setdefault(piece[id(block)], []).append(dart)
        colors = [whole.colors[cell] for cell in self._cells]
        colors += [frozenset((facing[darts[0]].color,)) for darts in outside.values()]
        return [*inside, *outside.values()], colors

    def _pieces(self, block_of: Mapping[int, Block]) -> dict[int, int]:
        """The piece of each block outside, by its ``id``: facing ones, and what they connect to."""
        darts, inside = self._whole.darts, set(self._cells)
        piece: dict[int, int] = {}
        for number, first in enumerate(self._facing.values()):
            if id(first) in piece:
                continue
            piece[id(first)] = number
            reached = [first]
            for block in reached:
                for twin in (darts[dart].twin for dart in block.darts):
                    if darts[twin].cell in inside:
                        continue
                    other = block_of[twin]
                    if id(other) not in piece:
                        piece[id(other)] = number
                        reached.append(other)
        return piece

    def _small_graph(
        self, order: Sequence[Sequence[int]], colors: Sequence[frozenset[int]]
    ) -> DartGraph:
        whole, facing = self._whole, self._facing
        index = {dart: number for number, dart in enumerate(self._darts)}
        found = []
        for cell, own in enumerate(order):
            for dart in own:
                twin = whole.darts[dart].twin
                joinable = whole.darts[dart].colors & colors[cell]
                if twin in facing:
                    joinable &= {facing[twin].color}  # what is outside keeps its color
                found.append(Dart(whole.darts[dart].name, cell, index[twin], joinable))
        loops = tuple((tuple(index[dart] for dart in own),) for own in order)
        return DartGraph(tuple(found), loops, tuple(colors), whole.seams)

    def _restricted(self, painting: Painting, block_of: Mapping[int, Block]) -> Painting:
        """What the division is on the small graph."""
        joined = {
            number
            for number, dart in enumerate(self._darts)
            if dart in block_of and self._darts[self.graph.darts[number].twin] in block_of
        }
        index = {self._darts[number]: number for number in joined}
        own = [
            [Block(b.color, {index[d] for d in b.darts if d in index}) for b in painting[cell]]
            for cell in self._cells
        ]
        count = len(self._cells)
        beyond = [
            [Block(min(colors), joined.intersection(numbers))]
            for numbers, colors in zip(
                self.graph.lists[count:], self.graph.colors[count:], strict=True
            )
        ]
        return [[b for b in blocks if b.darts] or blocks[:1] for blocks in [*own, *beyond]]

    def put_back(self, painting: Painting, found: Painting, block_of: dict[int, Block]) -> Painting:
        """The whole division with the window divided as found; ``block_of`` is updated."""
        whole = self._whole
        joined = {self._darts[dart] for blocks in found for block in blocks for dart in block.darts}
        around = {whole.darts[dart].cell for dart in self._facing}
        changed = list(painting)
        for cell, blocks in zip(self._cells, found, strict=False):
            changed[cell] = [Block(b.color, {self._darts[d] for d in b.darts}) for b in blocks]
        # Facing blocks gain and lose darts. They are copied, since the old division stays as it is.
        copies: dict[int, Block] = {}
        for cell in around:
            copies |= {id(b): Block(b.color, set(b.darts)) for b in painting[cell]}
        for dart, block in self._facing.items():
            copies[id(block)].darts.discard(dart)
            if dart in joined:
                copies[id(block)].darts.add(dart)
        for cell in around:
            own = [copies[id(block)] for block in painting[cell]]
            changed[cell] = [block for block in own if block.darts] or own[:1]
        changed = canonical(whole, changed, around.union(self._cells))
        for cell, (old, new) in enumerate(zip(painting, changed, strict=True)):
            if old is not new:
                for dart in whole.lists[cell]:
                    block_of.pop(dart, None)
                block_of.update({dart: block for block in new for dart in block.darts})
        return changed


def _shown(darts: Sequence[int], blocks: Sequence[Block], dart: int) -> Block:
    """The block that a dart belongs to or, in state 0, shows: the last one met before it."""
    block_of = {its: block for block in blocks for its in block.darts}
    place = darts.index(dart)
    walk = [*reversed(darts[: place + 1]), *reversed(darts[place + 1 :])]
    return next((block_of[d] for d in walk if d in block_of), blocks[0])


def _routed(window: _Window, seed: int, deadline: Deadline) -> Painting | None:
    """The best division of the window by leaving segments out; None if none is better."""
    best = None
    for better in drop_segments(
        window.graph, window.painting, _regions(window.graph), seed, deadline, TRIES
    ):
        best = better
    return best


def _solved(
    window: _Window, solve: SolveWithSeed, seed: int, costs: Sequence[int] | None
) -> Painting | None:
    """The window solved again; None if it is too large, or nothing was found."""
    # A piece outside may face the window with many darts.
    if model_size(window.graph) > LARGEST_WINDOW:
        return None
    built = full_model(window.graph, _regions(window.graph), costs=costs)
    solver, status = solve(built.model, seed)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
        return None
    return read_painting(window.graph, built.variables, solver, costs)


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
