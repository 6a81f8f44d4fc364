"""Minima and optimal schemes straight from their definitions, sharing nothing with any solver.

Everything here is a sweep: cells (or mesh vertices) are painted one after the other, and of all
paintings of the swept part that look the same from the rest only the cheapest are kept. That is
exact without bounds, without a search order that matters and without canonical forms.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache

from cellcolor.data.instance import Cell, Instance
from cellcolor.data.solution import SchemeKey
from cellcolor.data.surface import LabelledSurface

Blocks = tuple[tuple[int, tuple[int, ...]], ...]
"""Sub-cells of one cell: color and the places of the darts in state 1."""


@cache
def noncrossing(size: int) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """All non-crossing partitions of points on a circle: set partitions, crossing ones left out."""
    partitions: list[list[list[int]]] = [[]]
    for point in range(size):
        grown = []
        for blocks in partitions:
            grown.append([*blocks, [point]])
            for i, block in enumerate(blocks):
                if not any(
                    block[-1] < other[-1] and any(p < block[-1] for p in other)
                    for other in blocks
                    if other is not block
                ):
                    grown.append([*blocks[:i], [*block, point], *blocks[i + 1 :]])
        partitions = grown
    return tuple(tuple(map(tuple, blocks)) for blocks in partitions)


def live_darts(instance: Instance, cell: Cell) -> list[int]:
    """The live darts of a cell whose live darts all lie on one loop."""
    loops = [[d for d in loop if instance.joinable(d)] for loop in cell.loops]
    loops = [loop for loop in loops if loop]
    assert len(loops) < 2, "brute force is for cells with one loop"
    return loops[0] if loops else []


# --- every division, literally ------------------------------------------------------------------


def literal_minimum(instance: Instance) -> int:
    """The minimum over the product of all partitions and all colorings: for tiny graphs only."""
    options = []
    for cell in instance.cells:
        darts = live_darts(instance, cell)
        found: list[tuple[int, dict[int, tuple[int, int, int]]]] = []
        for blocks in noncrossing(len(darts)):
            blocks = blocks or ((),)
            for colors in itertools.product(cell.colors, repeat=len(blocks)):
                holder = {
                    darts[i]: (cell.id, number, colors[number])
                    for number, block in enumerate(blocks)
                    for i in block
                }
                found.append((len(blocks), holder))
        options.append(found)
    best = len(instance.cells) * 1000
    for chosen in itertools.product(*options):
        holder = {dart: where for _, painted in chosen for dart, where in painted.items()}
        joins = [
            (one[:2], holder[-dart][:2])
            for dart, one in holder.items()
            if dart > 0 and one[2] == holder[-dart][2] and one[2] in instance.joinable(dart)
        ]
        best = min(best, sum(count for count, _ in chosen) - _forest(joins))
    return best


def _forest(pairs: list[tuple[tuple[int, int], tuple[int, int]]]) -> int:
    """The edges of a maximal forest."""
    group: dict[tuple[int, int], set[tuple[int, int]]] = {}
    size = 0
    for a, b in pairs:
        ga, gb = group.setdefault(a, {a}), group.setdefault(b, {b})
        if ga is not gb:
            size += 1
            ga |= gb
            for member in gb:
                group[member] = ga
    return size


# --- a sweep over cells -------------------------------------------------------------------------


@dataclass(frozen=True)
class Local:
    """One way to paint one cell, as the sweep needs it.

    ``shown`` gives, for each dart in state 0, the colors it may show; empty where that does not
    matter.
    """

    blocks: Blocks
    shown: tuple[frozenset[int], ...]


def any_division(cell: Cell, painted: tuple[int | None, ...]) -> Iterator[Local]:
    """All divisions that join exactly the given darts in the given colors, or more cheaply.

    Darts in state 0 may lie in any sub-cell, so only the non-crossing partition of the others
    matters; an edge that would be joined by the way is only counted for less.
    """
    ones = [i for i, color in enumerate(painted) if color is not None]
    nothing = (frozenset[int](),) * len(painted)
    if not ones:
        yield Local(((cell.colors[0], ()),), nothing)
        return
    for blocks in noncrossing(len(ones)):
        colors = [{painted[ones[i]] for i in block} for block in blocks]
        if all(len(c) == 1 for c in colors):
            yield Local(
                tuple(
                    (painted[ones[block[0]]] or 0, tuple(ones[i] for i in block))
                    for block in blocks
                ),
                nothing,
            )


def any_scheme(cell: Cell, painted: tuple[int | None, ...]) -> Iterator[Local]:
    """All that rules 2, 3 and 4 of a scheme allow for the given darts in state 1."""
    ones = [i for i, color in enumerate(painted) if color is not None]
    if not ones:
        for color in cell.colors:
            yield Local(((color, ()),), (frozenset({color}),) * len(painted))
        return
    for local in any_division(cell, painted):
        if len(local.blocks) > 1 and any(len(darts) < 2 for _, darts in local.blocks):
            continue
        block_of = {i: number for number, (_, darts) in enumerate(local.blocks) for i in darts}
        if any(
            block_of[a] != block_of[b] and painted[a] == painted[b]
            for a, b in zip(ones, ones[1:] + ones[:1], strict=True)
        ):
            continue
        yield Local(local.blocks, tuple(_may_show(painted, i) for i in range(len(painted))))


def _may_show(painted: tuple[int | None, ...], i: int) -> frozenset[int]:
    """The colors of the nearest darts in state 1 before and after a dart in state 0."""
    if painted[i] is not None:
        return frozenset()
    size = len(painted)
    before = next(c for step in range(1, size) if (c := painted[i - step]) is not None)
    after = next(c for step in range(1, size) if (c := painted[(i + step) % size]) is not None)
    return frozenset({before, after})


Entry = tuple[str, object, object]
"""What the rest sees of a dart: ``("joined", color, segment)`` or ``("zero", colors, None)``."""
State = tuple[Entry, ...]
Painting = tuple[Local, ...]


class CellSweep:
    """Paint the cells one by one; keep the cheapest paintings of each frontier."""

    def __init__(
        self,
        instance: Instance,
        options: Callable[[Cell, tuple[int | None, ...]], Iterator[Local]],
    ) -> None:
        self._instance = instance
        self._options = cache(lambda cell, painted: tuple(options(cell, painted)))
        self._darts = [live_darts(instance, cell) for cell in instance.cells]
        self.order: list[int] = []
        self._sweep()

    def _sweep(self) -> None:
        self._layers: list[dict[State, tuple[int, list[tuple[State, Local]]]]] = [{(): (0, [])}]
        frontier: list[int] = []
        remaining = {cell.id for cell in self._instance.cells}
        while remaining:
            here = min(
                remaining,
                key=lambda c: (
                    len([d for d in self._darts[c] if -d not in frontier])
                    - len([d for d in self._darts[c] if -d in frontier]),
                    c,
                ),
            )
            remaining.remove(here)
            self.order.append(here)
            after = [d for d in frontier if -d not in self._darts[here]]
            after += [d for d in self._darts[here] if self._instance.across(d) in remaining]
            layer: dict[State, tuple[int, list[tuple[State, Local]]]] = {}
            for state, (cost, _) in self._layers[-1].items():
                seen = dict(zip(frontier, state, strict=True))
                for local in self._agreeing(here, seen):
                    found, closed = self._paint(here, local, seen, after)
                    previous = layer.get(found)
                    if previous is None or previous[0] > cost + closed:
                        layer[found] = (cost + closed, [(state, local)])
                    elif previous[0] == cost + closed:
                        previous[1].append((state, local))
            self._layers.append(layer)
            frontier = after
        ((self.minimum, _),) = self._layers[-1].values()

    def _agreeing(self, here: int, seen: dict[int, Entry]) -> Iterator[Local]:
        """The local paintings that agree with what the painted neighbors show."""
        darts = self._darts[here]
        choices: list[list[int | None]] = []
        for dart in darts:
            entry = seen.get(-dart)
            if entry is None:
                choices.append([None, *self._instance.joinable(dart)])
            else:
                choices.append([entry[1] if entry[0] == "joined" else None])  # type: ignore[list-item]
        place = {dart: i for i, dart in enumerate(darts)}
        for painted in itertools.product(*choices):
            if any(painted[i] != painted[place[-d]] for i, d in enumerate(darts) if -d in place):
                continue
            for local in self._options(self._instance.cells[here], painted):
                if not any(
                    self._surely_joined(dart, local.shown[i], seen[-dart])
                    for i, dart in enumerate(darts)
                    if -dart in seen and painted[i] is None
                ):
                    yield local

    def _surely_joined(self, dart: int, shown: frozenset[int], other: Entry) -> bool:
        return (
            len(shown) == 1
            and shown == other[1]
            and next(iter(shown)) in self._instance.joinable(dart)
        )

    def _paint(
        self, here: int, local: Local, seen: dict[int, Entry], after: list[int]
    ) -> tuple[State, int]:
        """The frontier after painting a cell, and how many segments that completes."""
        darts = self._darts[here]
        group: dict[object, object] = {e[2]: e[2] for e in seen.values() if e[0] == "joined"}
        entry = dict(seen)
        for number, (color, block) in enumerate(local.blocks):
            group["new", number] = ("new", number)
            for i in block:
                entry[darts[i]] = ("joined", color, ("new", number))
        for i, dart in enumerate(darts):
            if dart not in entry:
                entry[dart] = ("zero", local.shown[i], None)
            elif -dart in entry:
                one, other = group[entry[dart][2]], group[entry[-dart][2]]
                group = {k: one if g == other else g for k, g in group.items()}
        names: dict[object, int] = {}
        state: list[Entry] = []
        for dart in after:
            kind, color, segment = entry[dart]
            if kind == "joined":
                segment = names.setdefault(group[segment], len(names))
            state.append((kind, color, segment))
        return tuple(state), len(set(group.values())) - len(names)

    def optimal(self) -> Iterator[dict[int, Local]]:
        """Every painting with the fewest segments: its cells' local paintings."""

        def back(depth: int, state: State) -> Iterator[dict[int, Local]]:
            if depth == 0:
                yield {}
                return
            for before, local in self._layers[depth][state][1]:
                for rest in back(depth - 1, before):
                    yield rest | {self.order[depth - 1]: local}

        yield from back(len(self.order), ())


def minimum(instance: Instance) -> int:
    """The fewest segments over all non-crossing partitions of all cells and all their colorings."""
    return CellSweep(instance, any_division).minimum


def optimal_schemes(instance: Instance) -> tuple[int, set[SchemeKey]]:
    """The fewest segments of a scheme, and the set of all schemes that have so many."""
    sweep = CellSweep(instance, any_scheme)
    darts = [live_darts(instance, cell) for cell in instance.cells]
    keys = set()
    for painting in sweep.optimal():
        if _zeros_fit(instance, darts, painting):
            keys.add(
                tuple(
                    frozenset(
                        (color, frozenset(darts[cell][i] for i in block))
                        for color, block in painting[cell].blocks
                    )
                    for cell in range(len(darts))
                )
            )
    return sweep.minimum, keys


def _zeros_fit(instance: Instance, darts: list[list[int]], painting: dict[int, Local]) -> bool:
    """Rule 5 by trying: split the run of zeros of every gap in every possible place."""
    gaps: list[tuple[list[int], int, int]] = []
    for cell, local in painting.items():
        color_of = {i: color for color, block in local.blocks for i in block}
        ones = sorted(color_of)
        size = len(darts[cell])
        if not ones:
            color = local.blocks[0][0]
            gaps.append((darts[cell], color, color))
        for a, b in zip(ones, ones[1:] + ones[:1], strict=True):
            run = [darts[cell][(a + s) % size] for s in range(1, (b - a - 1) % size + 1)]
            gaps.append((run, color_of[a], color_of[b]))
    gaps.sort(key=lambda gap: gap[1] != gap[2])  # those without a choice first

    def split(number: int, shows: dict[int, int]) -> bool:
        if number == len(gaps):
            return True
        run, before, after = gaps[number]
        for cut in range(len(run) + 1) if before != after else (0,):
            more = shows | {d: before if i < cut else after for i, d in enumerate(run)}
            if not any(
                more.get(-d) == more[d] and more[d] in instance.joinable(d) for d in run
            ) and split(number + 1, more):
                return True
        return False

    return split(0, {})


# --- a sweep over mesh vertices -----------------------------------------------------------------


def vertex_minimum(surface: LabelledSurface) -> int:
    """The fewest connected components of equal color over all colorings of a mesh's vertices.

    Without the topological graph: vertices one by one in their order, which should be one with a
    short frontier.
    """
    cracks = {(c.i, c.j): c.colors for c in surface.cracks}
    neighbors: dict[int, set[int]] = defaultdict(set)
    for i, j in surface.left_of:
        if surface.vertex_colors[i] and surface.vertex_colors[j]:
            neighbors[i].add(j)
            neighbors[j].add(i)
    reached = [v for v, colors in enumerate(surface.vertex_colors) if colors]
    frontier: list[int] = []
    layer: dict[tuple[tuple[int, int], ...], int] = {(): 0}
    for vertex in reached:
        after = [v for v in [*frontier, vertex] if any(n > vertex for n in neighbors[v])]
        grown: dict[tuple[tuple[int, int], ...], int] = {}
        for state, cost in layer.items():
            seen = dict(zip(frontier, state, strict=True))
            for color in surface.vertex_colors[vertex]:
                same = {
                    seen[v][1]
                    for v in neighbors[vertex]
                    if v in seen
                    and seen[v][0] == color
                    and color not in cracks.get((min(v, vertex), max(v, vertex)), ())
                }
                painted = {v: (c, -1 if s in same else s) for v, (c, s) in seen.items()}
                painted[vertex] = (color, -1)
                names: dict[int, int] = {}
                found = tuple(
                    (painted[v][0], names.setdefault(painted[v][1], len(names))) for v in after
                )
                closed = len({s for _, s in painted.values()}) - len(names)
                grown[found] = min(grown.get(found, cost + closed), cost + closed)
        layer, frontier = grown, after
    return min(layer.values())
