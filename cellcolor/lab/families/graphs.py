"""Abstract planar graphs, no surface behind them."""

from __future__ import annotations

import random

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.errors import InputError


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

    Raises:
        InputError: too few cells, edges or colors.
    """
    if cells < 1 or colors < 1 or edges < cells - 1:
        raise InputError(None, None, f"no graph has {cells} cells, {edges} edges, {colors} colors")
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
    return Instance(
        f"planar_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        tuple(
            Cell(i, sets[i], (tuple(rotation.darts[i]),) if rotation.darts.get(i) else ())
            for i in range(cells)
        ),
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
