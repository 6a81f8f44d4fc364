"""Planar graphs without a surface: random ones, and hubs, cells with all colors ringed by petals.

A petal is a cell at the border of a hub with one color or a few. Two petals of one color are joined
by a corridor through the hub, and corridors may not cross: that makes hubs hard.
"""

from __future__ import annotations

import random
from collections.abc import Sequence

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
from cellcolor.data.instance import Instance, KnownResult, KnownResults


def planar_graph(
    seed: int, cells: int, edges: int, colors: int, *, self_edges: bool = False
) -> Instance:
    """A random connected planar graph with random color sets, no surface behind it.

    Grown edge by edge between two corners around one point where areas meet, which keeps it
    planar and every cell's border one loop. Some edges are joinable in fewer colors than their
    cells share, some are dead.

    Args:
        edges: between cells, at least ``cells - 1``.
        self_edges: whether a cell may lie on both sides of an edge.
    """
    rng = random.Random(f"planar {seed} {cells} {edges} {colors} {self_edges}")
    sets = [tuple(sorted(rng.sample(range(colors), rng.randint(1, colors)))) for _ in range(cells)]
    rotation = _Rotation()
    made: list[Edge] = []
    for number in range(1, edges + 1):
        if number < cells:
            left, right = rng.randrange(number), number
            before = rotation.darts.get(left)
            rotation.insert(number, left, rng.choice(before) if before else None)
            rotation.insert(-number, right, None)
        else:
            ends = rotation.corners_to_join(rng, self_edges)
            if ends is None:
                break
            (left, after_left), (right, after_right) = ends
            rotation.insert(number, left, after_left)
            rotation.insert(-number, right, number if after_right == after_left else after_right)
        shared = sorted(set(sets[left]) & set(sets[right]))
        kept = None
        if shared and rng.random() < 0.25:
            kept = tuple(sorted(rng.sample(shared, rng.randrange(len(shared)))))
        made.append(Edge(number, left, right, kept))
    loops = [(tuple(darts),) if (darts := rotation.darts.get(i)) else () for i in range(cells)]
    return Instance(
        f"planar_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        tuple(Cell(i, sets[i], loops[i]) for i in range(cells)),
        tuple(made),
    )


class _Rotation:
    """The cyclic list of darts of each cell while a planar graph grows."""

    def __init__(self) -> None:
        self.darts: dict[int, list[int]] = {}
        self._cell: dict[int, int] = {}

    def insert(self, dart: int, cell: int, after: int | None) -> None:
        """Put a dart into a cell's list after another, or first of all."""
        darts = self.darts.setdefault(cell, [])
        darts.insert(0 if after is None else darts.index(after) + 1, dart)
        self._cell[dart] = cell

    def corners_to_join(
        self, rng: random.Random, self_edges: bool
    ) -> tuple[tuple[int, int | None], tuple[int, int | None]] | None:
        """Two corners around one point, each as its cell and the dart before it."""
        pairs: list[tuple[int, int]] = []
        for first in self._cell:
            here = first
            while True:
                if self_edges or self._cell[here] != self._cell[first]:
                    pairs.append((first, here))
                # The end of a dart is the start of its twin: the corner before the twin is next.
                darts = self.darts[self._cell[-here]]
                here = darts[darts.index(-here) - 1]
                if here == first:
                    break
        if not pairs:
            if self._cell or not self_edges:
                return None
            return (0, None), (0, None)
        one, other = rng.choice(sorted(pairs))
        return (self._cell[one], one), (self._cell[other], other)


def hub(seed: int, petals: int, colors: int) -> Instance:
    """One cell with all colors, ringed by single-colored cells, no two equal neighbors.

    Its minimum is known (:func:`hub_minimum`) and bounds that count colors say nothing about it.
    """
    rng = random.Random(f"hub {seed} {petals} {colors}")
    ring = _ring(rng, petals, colors)
    known = KnownResults(paper=KnownResult(hub_minimum(ring)))
    return _hub(f"hub_{seed}_{petals}", [[(color,) for color in ring]], colors, known)


def hub_with_loops(seed: int, loops: int, petals: int, colors: int) -> Instance:
    """A hub with a ring of so many petals round each of its several loops."""
    rng = random.Random(f"hub with loops {seed} {loops} {petals} {colors}")
    rings = [[(color,) for color in _ring(rng, petals, colors)] for _ in range(loops)]
    return _hub(f"hub_{seed}_{loops}x{petals}", rings, colors)


def _ring(rng: random.Random, petals: int, colors: int) -> list[int]:
    """Random colors of a ring of petals, no two successive ones equal."""
    assert petals > 1 and colors > (2 if petals % 2 else 1)  # there is no other ring
    while True:
        ring = [rng.randrange(colors)]
        while len(ring) < petals:
            ring.append(rng.choice([color for color in range(colors) if color != ring[-1]]))
        if ring[0] != ring[-1]:
            return ring


def _hub(
    name: str,
    rings: Sequence[Sequence[tuple[int, ...]]],
    colors: int,
    known: KnownResults | None = None,
) -> Instance:
    """A cell with all colors and a ring of petals, given by their colors, round each loop."""
    loops: list[tuple[int, ...]] = []
    petals: list[Cell] = []
    edges: list[Edge] = []
    for ring in rings:
        n, first = len(ring), len(petals) + 1
        start = len(edges)
        loops.append(tuple(range(start + 1, start + n + 1)))
        edges += [Edge(start + i + 1, 0, first + i) for i in range(n)]
        edges += [Edge(start + n + i + 1, first + i, first + (i + 1) % n) for i in range(n)]
        edges += [Edge(start + 2 * n + i + 1, first + i, OUTSIDE) for i in range(n)]
        for i, own in enumerate(ring):
            before, after = start + n + (i - 1) % n + 1, start + n + i + 1
            loop = (-(start + i + 1), -before, start + 2 * n + i + 1, after)
            petals.append(Cell(first + i, own, (loop,)))
    return Instance(
        name,
        tuple(f"c{color}" for color in range(colors)),
        (Cell(0, tuple(range(colors)), tuple(loops)), *petals),
        tuple(edges),
        known=known,
    )


def hub_minimum(petal_colors: Sequence[int]) -> int:
    """The minimum of a hub: its petals less the most that corridors through the hub can join.

    The corridors join petals of one color without crossing. A petal is the first of its interval
    and stays alone, or is joined to a later one, which leaves what lies between and beyond.
    """
    size = len(petal_colors)
    joined = [[0] * (size + 1) for _ in range(size + 1)]  # of the petals before the second index
    for first in reversed(range(size)):
        own = joined[first] = joined[first + 1][:]
        for k in range(first + 1, size):
            if petal_colors[k] == petal_colors[first]:
                between = joined[first + 1][k] + 1
                for end in range(k + 1, size + 1):
                    own[end] = max(own[end], between + joined[k][end])
    return size - joined[0][size]


def hub_grid(seed: int, rows: int, columns: int, colors: int, side: int = 2) -> Instance:
    """Hubs in a grid that share the petals between them.

    A hub is a square cell with all colors and ``side`` single-colored petals on each of its four
    sides. A petal between two hubs has a live edge to both, one at the rim of the grid to one; no
    two successive petals of a side are equal. What lies between four hubs is unreachable.
    """
    rng = random.Random(f"hub grid {seed} {rows} {columns} {colors} {side}")
    sets: list[tuple[int, ...]] = [tuple(range(colors))] * (rows * columns)
    loops: list[tuple[int, ...]] = [()] * (rows * columns)
    edges: list[Edge] = []

    def border(left: int, right: int) -> int:
        edges.append(Edge(len(edges) + 1, left, right))
        return len(edges)

    def strip(near: int, far: int) -> tuple[list[int], list[int]]:
        """Petals between two hubs, or a hub and the rim, as walks round each of the two meet them.

        Looking from the near one to the far one they follow each other from right to left.
        """
        nears: list[int] = []
        fars: list[int] = []
        behind = None
        for number in range(side):
            petal = len(sets)
            last = sets[-1] if number else ()
            sets.append((rng.choice([color for color in range(colors) if color not in last]),))
            right = border(petal, OUTSIDE) if behind is None else -behind
            nears.append(border(near, petal))
            fars.insert(0, -border(petal, far))
            behind = border(petal, petal + 1 if number < side - 1 else OUTSIDE)
            loops.append((right, -fars[0], behind, -nears[-1]))
        return nears, fars

    # Row by row from the bottom, so that the strips below and to the left of a hub are known.
    above: dict[tuple[int, int], list[int]] = {}
    beside: dict[tuple[int, int], list[int]] = {}
    for row in range(rows):
        for column in range(columns):
            hub_id = row * columns + column
            bottom = above[row - 1, column] if row else strip(OUTSIDE, hub_id)[1]
            left = beside[row, column - 1] if column else strip(OUTSIDE, hub_id)[1]
            right_hub = hub_id + 1 if column < columns - 1 else OUTSIDE
            right, beside[row, column] = strip(hub_id, right_hub)
            top, above[row, column] = strip(hub_id, hub_id + columns if row < rows - 1 else OUTSIDE)
            loop: list[int] = []
            for darts in (bottom, right, top, left):
                loop += [*darts, border(hub_id, OUTSIDE)]
            loops[hub_id] = tuple(loop)
    return Instance(
        f"hub_grid_{seed}_{rows}x{columns}x{side}",
        tuple(f"c{color}" for color in range(colors)),
        tuple(Cell(i, own, (loop,)) for i, (own, loop) in enumerate(zip(sets, loops, strict=True))),
        tuple(edges),
    )
