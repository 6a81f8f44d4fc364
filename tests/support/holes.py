"""Divisions of cells with several loops straight from their definition, without seams.

A division of a cell is drawn on a sphere as a graph: its loops and its sub-cells are points, each
dart in state 1 a line between the two. Round a loop the lines leave in the order of its darts,
round a sub-cell in any order. It can be drawn if some choice of these orders has genus 0.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Sequence
from functools import cache

import networkx as nx
from rooms import graph

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, SchemeKey, number_segments, scheme_key

Loops = tuple[tuple[int, ...], ...]
Blocks = frozenset[frozenset[int]]
Painted = frozenset[tuple[int, frozenset[int]]]
"""Sub-cells of one cell: color and darts in state 1."""


def set_partitions(items: Sequence[int]) -> Iterator[list[list[int]]]:
    """All of them."""
    if not items:
        yield []
        return
    for smaller in set_partitions(items[1:]):
        yield [[items[0]], *smaller]
        for number, block in enumerate(smaller):
            yield [*smaller[:number], [items[0], *block], *smaller[number + 1 :]]


@cache
def can_be_drawn(loops: Loops, blocks: Blocks) -> bool:
    """Whether connected sub-cells without crossings can hold these darts of a planar cell."""
    ones = {dart for block in blocks for dart in block}
    kept = [[dart for dart in loop if dart in ones] for loop in loops]
    kept = [loop for loop in kept if loop]
    graph: nx.Graph[object] = nx.Graph()
    for number, loop in enumerate(kept):
        graph.add_edges_from((number, block) for block in blocks for d in loop if d in block)
    points = len(kept) + len(blocks)
    corners = points - len(ones) - 2 * nx.number_connected_components(graph)
    following = {
        dart: loop[place - len(loop) + 1] for loop in kept for place, dart in enumerate(loop)
    }
    for orders in itertools.product(
        *([[first, *rest] for rest in itertools.permutations(others)] for first, *others in blocks)
    ):
        after = {
            d: order[place - len(order) + 1] for order in orders for place, d in enumerate(order)
        }
        # Along a face: out at a loop, at the sub-cell to the next line there, in at another loop.
        step = {dart: following[after[dart]] for dart in ones}
        faces = 0
        while step:
            faces += 1
            dart = next(iter(step))
            while dart in step:
                dart = step.pop(dart)
        if corners + faces == 0:
            return True
    return False


def live_loops(instance: Instance, cell: Cell) -> Loops:
    loops = (tuple(d for d in loop if instance.joinable(d)) for loop in cell.loops)
    return tuple(loop for loop in loops if loop)


def divisions_of(instance: Instance, cell: Cell, crossing: bool) -> Iterator[Painted]:
    """Every choice of darts in state 1, colors for them, and sub-cells, crossing ones or not."""
    loops = live_loops(instance, cell)
    darts = [dart for loop in loops for dart in loop]
    for colors in itertools.product(*([None, *instance.joinable(dart)] for dart in darts)):
        color = {d: c for d, c in zip(darts, colors, strict=True) if c is not None}
        if any(-d in darts and color.get(-d) != c for d, c in color.items()):
            continue
        if not color:
            yield from (frozenset([(own, frozenset[int]())]) for own in cell.colors)
            continue
        classes = [[d for d in color if color[d] == own] for own in sorted(set(color.values()))]
        for chosen in itertools.product(*map(set_partitions, classes)):
            blocks = [frozenset(block) for partition in chosen for block in partition]
            if crossing or can_be_drawn(loops, frozenset(blocks)):
                yield frozenset((color[min(block)], block) for block in blocks)


def divisions(instance: Instance, crossing: bool = False) -> Iterator[tuple[Painted, ...]]:
    """Every division of every cell, edges in one state and color on both sides."""
    options = [list(divisions_of(instance, cell, crossing)) for cell in instance.cells]

    def extend(
        chosen: list[Painted], color: dict[int, int | None]
    ) -> Iterator[tuple[Painted, ...]]:
        if len(chosen) == len(options):
            yield tuple(chosen)
            return
        cell = instance.cells[len(chosen)]
        darts = [dart for loop in live_loops(instance, cell) for dart in loop]
        for painted in options[len(chosen)]:
            own = dict.fromkeys(darts) | {d: c for c, block in painted for d in block}
            if all(color.get(-d, own[d]) == own[d] for d in darts):
                yield from extend([*chosen, painted], color | own)

    return extend([], {})


def as_division(division: Sequence[Painted]) -> Division:
    return number_segments(
        [[(c, tuple(sorted(d))) for c, d in sorted(cell, key=str)] for cell in division]
    )


def segments(division: Sequence[Painted]) -> int:
    return len({sub.segment for cell in as_division(division) for sub in cell.subcells})


@cache
def optimal_schemes(instance: Instance) -> tuple[int, set[SchemeKey]]:
    """The fewest segments of any division, and the schemes among those that have so many."""
    best = len(instance.cells) * 100
    found: set[SchemeKey] = set()
    for division in divisions(instance):
        count = segments(division)
        if count < best:
            best, found = count, set()
        if count == best and is_scheme(instance, division):
            found.add(scheme_key(as_division(division)))
    return best, found


def is_scheme(instance: Instance, division: Sequence[Painted]) -> bool:
    """Rules 2, 4 and 5, the others being those of a division."""
    gaps: list[list[dict[int, int]]] = []
    for cell, painted in zip(instance.cells, division, strict=True):
        loops = live_loops(instance, cell)
        if len(painted) > 1 and any(len(block) < 2 for _, block in painted):
            return False
        holder = {dart: (color, block) for color, block in painted for dart in block}
        reach: nx.Graph[object] = nx.Graph()
        reach.add_nodes_from(painted)
        for loop in loops:
            ones = [dart for dart in loop if dart in holder]
            for dart, after in zip(ones, ones[1:] + ones[:1], strict=True):
                (color, block), (other, its) = holder[dart], holder[after]
                if color == other and block != its:
                    return False
                reach.add_edge(holder[dart], holder[after])
                start = loop.index(dart) + 1
                following = (*loop[start:], *loop[: start - 1])
                end = next((n for n, d in enumerate(following) if d in holder), len(following))
                run = following[:end]
                gaps.append(
                    [
                        {d: color if place < cut else other for place, d in enumerate(run)}
                        for cut in range(len(run) + 1)
                    ]
                )
            if not ones:
                gaps.append([dict.fromkeys(loop, color) for color, _ in painted])
        for part, apart in itertools.combinations(nx.connected_components(reach), 2):
            if {color for color, _ in part} & {color for color, _ in apart}:
                return False

    def can_differ(number: int, shown: dict[int, int]) -> bool:
        if number == len(gaps):
            return True
        return any(
            not any(
                (shown | more).get(-d) == c and c in instance.joinable(d) for d, c in more.items()
            )
            and can_differ(number + 1, shown | more)
            for more in gaps[number]
        )

    return can_differ(0, {})


def holed(seed: int, darts: int, loops: int, colors: int) -> Instance:
    """A cell with several loops, and around each of its darts, or of two, another cell."""
    rng = random.Random(f"holed {seed} {darts} {loops} {colors}")
    borders: list[list[int]] = [[dart] for dart in range(1, loops + 1)]
    for dart in range(loops + 1, darts + 1):
        rng.choice(borders).append(dart)
    petals: list[list[int]] = []
    for dart in rng.sample(range(1, darts + 1), darts):
        if petals and len(petals[-1]) == 1 and rng.random() < 0.2:
            petals[-1].append(dart)
        else:
            petals.append([dart])
    many = tuple(range(colors))
    sets = [tuple(sorted(rng.sample(many, 1 + (rng.random() < 0.2)))) for _ in petals]
    around = [(own, [-dart for dart in petal]) for own, petal in zip(sets, petals, strict=True)]
    return graph((many, *borders), *around)
