"""Minima and optimal schemes straight from their definitions, sharing nothing with any solver.

Everything here is a sweep: cells are painted one after the other, and of all paintings of the
swept part that look the same from the rest only the cheapest are kept. That is exact without
bounds, without a search order that matters and without canonical forms. What so many segments
cover at most is found by leaving out every set of cells.
"""

from __future__ import annotations

import itertools
from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import chain, combinations

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SchemeKey

Partitions = Callable[[tuple[object, ...]], tuple[tuple[tuple[int, ...], ...], ...]]
"""Those of points on a circle, whose colors are given."""


@cache
def noncrossing_in(colors: tuple[object, ...]) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """All non-crossing partitions of points on a circle, each block of points of one color."""
    partitions: list[list[list[int]]] = [[]]
    for point, color in enumerate(colors):
        grown = []
        for blocks in partitions:
            grown.append([*blocks, [point]])
            for i, block in enumerate(blocks):
                if colors[block[-1]] == color and not any(
                    block[-1] < other[-1] and any(p < block[-1] for p in other)
                    for other in blocks
                    if other is not block
                ):
                    grown.append([*blocks[:i], [*block, point], *blocks[i + 1 :]])
        partitions = grown
    return tuple(tuple(map(tuple, blocks)) for blocks in partitions)


@cache
def coarsest_in(colors: tuple[object, ...]) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """Those of them in which no two blocks of a color can be united without crossing another.

    United sub-cells of one color are one piece instead of two and join all that both joined, so
    some division with the fewest segments has such partitions only.
    """

    def crosses(one: tuple[int, ...], other: tuple[int, ...]) -> bool:
        gaps = {sum(point < own for own in one) % len(one) for point in other}
        return len(gaps) > 1

    def can_be_united(blocks: tuple[tuple[int, ...], ...]) -> bool:
        return any(
            colors[a[0]] == colors[b[0]]
            and not any(crosses((*a, *b), other) for other in blocks if other not in (a, b))
            for a, b in itertools.combinations(blocks, 2)
        )

    return tuple(blocks for blocks in noncrossing_in(colors) if not can_be_united(blocks))


def noncrossing(size: int) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """All non-crossing partitions of points on a circle: set partitions, crossing ones left out."""
    return noncrossing_in((None,) * size)


Blocks = tuple[tuple[int, tuple[int, ...]], ...]
"""Sub-cells of one cell: color and the places of the darts in state 1."""


def live_darts(instance: Instance, cell: Cell) -> list[int]:
    """The live darts of a cell whose live darts all lie on one loop."""
    loops = [[d for d in loop if instance.joinable(d)] for loop in cell.loops]
    loops = [loop for loop in loops if loop]
    assert len(loops) < 2, "brute force is for cells with one loop"
    return loops[0] if loops else []


@dataclass(frozen=True)
class Local:
    """One way to paint one cell, as the sweep needs it.

    ``shown`` gives, for each dart in state 0, the colors it may show; empty where that does not
    matter.
    """

    blocks: Blocks
    shown: tuple[frozenset[int], ...]


def any_division(
    cell: Cell, painted: tuple[int | None, ...], partitions: Partitions = coarsest_in
) -> Iterator[Local]:
    """All divisions that join exactly the given darts in the given colors, or more cheaply.

    Darts in state 0 may lie in any sub-cell, so only the non-crossing partition of the others
    matters; an edge that would be joined by the way is only counted for less.
    """
    ones = [i for i, color in enumerate(painted) if color is not None]
    nothing = (frozenset[int](),) * len(painted)
    if not ones:
        yield Local(((cell.colors[0], ()),), nothing)
        return
    for blocks in partitions(tuple(painted[i] for i in ones)):
        yield Local(
            tuple(
                (painted[ones[block[0]]] or 0, tuple(ones[i] for i in block)) for block in blocks
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
    for local in any_division(cell, painted, noncrossing_in):
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


ZERO = -1
"""Stands for the color of a dart in state 0."""
Entry = tuple[int, object]
"""What the rest sees of a dart: ``(color, segment)``, or ``(ZERO, the colors it may show)``."""
State = tuple[Entry, ...]


Layer = dict[State, tuple[int, list[tuple[State, Local]]]]
"""The cheapest paintings of the swept part for each frontier, by the last cell's."""


class CellSweep:
    """Paint the cells one by one; keep the cheapest paintings of each frontier."""

    def __init__(
        self,
        instance: Instance,
        options: Callable[[Cell, tuple[int | None, ...]], Iterator[Local]],
    ) -> None:
        self._instance = instance
        self._options = options
        self._darts = [live_darts(instance, cell) for cell in instance.cells]
        self.order: list[int] = []
        self._layers: list[Layer] = [{(): (0, [])}]
        frontier: list[int] = []
        remaining = {cell.id for cell in instance.cells}
        while remaining:
            here = min(
                remaining,
                key=lambda c: (sum(-1 if -d in frontier else 1 for d in self._darts[c]), c),
            )
            remaining.remove(here)
            self.order.append(here)
            darts = self._darts[here]
            after = [d for d in (*frontier, *darts) if instance.across(d) in remaining]
            ways = cache(partial(self._ways, here))
            layer: Layer = {}
            for state, (cost, _) in self._layers[-1].items():
                seen = dict(zip(frontier, state, strict=True))
                for local, own in ways(tuple(seen[-d][0] if -d in seen else None for d in darts)):
                    found, closed = self._painted(seen | own, len(local.blocks), darts, after)
                    least = layer.get(found, (closed + cost + 1, []))[0]
                    if closed < 0 or least < cost + closed:
                        continue
                    if least > cost + closed:
                        layer[found] = (cost + closed, [])
                    layer[found][1].append((state, local))
            self._layers.append(layer)
            frontier = after
        ((self.minimum, _),) = self._layers[-1].values()

    def _ways(
        self, here: int, known: tuple[int | None, ...]
    ) -> list[tuple[Local, dict[int, Entry]]]:
        """The local paintings that agree with the colors of the painted neighbors' darts.

        With each what the rest sees of the cell's darts; its sub-cells are segments -1, -2, ….
        """
        darts = self._darts[here]
        twins = [(place, darts.index(-d)) for place, d in enumerate(darts) if -d in darts]
        choices: list[list[int | None]] = [
            [None, *self._instance.joinable(d)]
            if color is None
            else [None if color == ZERO else color]
            for d, color in zip(darts, known, strict=True)
        ]
        found = []
        for painted in itertools.product(*choices):
            if any(painted[one] != painted[other] for one, other in twins):
                continue
            for local in self._options(self._instance.cells[here], painted):
                own: dict[int, Entry] = {
                    dart: (ZERO, shown) for dart, shown in zip(darts, local.shown, strict=True)
                }
                for number, (color, block) in enumerate(local.blocks):
                    own |= {darts[place]: (color, -1 - number) for place in block}
                found.append((local, own))
        return found

    def _painted(
        self, entries: dict[int, Entry], blocks: int, darts: list[int], after: list[int]
    ) -> tuple[State, int]:
        """The frontier after painting a cell, and how many segments that completes.

        Fewer than none if an edge in state 0 is joined for sure: both its darts show just one
        color, the same, that can be joined.
        """
        group = {segment: segment for color, segment in entries.values() if color != ZERO}
        group |= {segment: segment for segment in range(-blocks, 0)}
        for dart in darts:
            color, own = entries[dart]
            if -dart not in entries:
                continue
            other = entries[-dart][1]
            if color != ZERO:
                one, gone = group[own], group[other]
                if one != gone:
                    group = {segment: one if g == gone else g for segment, g in group.items()}
            elif own == other and len(own) == 1 and own <= {*self._instance.joinable(dart)}:
                return (), -1
        names: dict[object, int] = {}
        found = []
        for color, own in (entries[dart] for dart in after):
            found.append(
                (color, own if color == ZERO else names.setdefault(group[own], len(names)))
            )
        return tuple(found), len(set(group.values())) - len(names)

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


def front_by_subsets(
    instance: Instance, weights: Sequence[float], required: Collection[int] = ()
) -> dict[int, float]:
    """For each number of segments the greatest weight of cells that have a division with so many.

    Every set of cells is left out once, and the minimum of the others found by a sweep. Numbers
    with which the required cells cannot be covered are missing.
    """
    cells = range(len(instance.cells))
    best: dict[int, float] = defaultdict(float)
    for left_out in chain.from_iterable(combinations(cells, size) for size in cells):
        if set(left_out) & set(required):
            continue
        rest, kept = instance.without_cells(left_out)
        segments = minimum(rest)
        best[segments] = max(best[segments], sum(weights[cell] for cell in kept))
    return with_fewer(best)


def with_fewer(best: dict[int, float]) -> dict[int, float]:
    """The greatest weight of at most so many segments, of that of exactly so many."""
    counts = range(max(1, min(best)), max(best) + 1)
    return {k: max(best[fewer] for fewer in best if fewer <= k) for k in counts}
