"""The same instance written in other ways."""

from __future__ import annotations

import random
from dataclasses import replace

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance


def turned(instance: Instance, rng: random.Random) -> Instance:
    """Other starting darts and another order of loops: seams then lie elsewhere."""
    cells = []
    for cell in instance.cells:
        loops = [loop[k:] + loop[:k] for loop in cell.loops for k in [rng.randrange(len(loop))]]
        rng.shuffle(loops)
        cells.append(replace(cell, loops=tuple(loops)))
    return replace(instance, cells=tuple(cells))


def renamed(instance: Instance, rng: random.Random) -> Instance:
    """Other numbers for cells, edges and colors, and edges seen from their other side."""
    cell_to = [*rng.sample(range(len(instance.cells)), len(instance.cells)), -1]
    color_to = rng.sample(range(len(instance.colors)), len(instance.colors))
    numbers = rng.sample(range(1, 5 * len(instance.edges) + 1), len(instance.edges))
    dart_to: dict[int, int] = {}
    edges = []
    for edge, number in zip(instance.edges, numbers, strict=True):
        signed = number * rng.choice((1, -1))
        dart_to |= {edge.id: signed, -edge.id: -signed}
        left, right = cell_to[edge.left], cell_to[edge.right]
        if signed < 0:
            left, right = right, left
        colors = None if edge.colors is None else tuple(color_to[c] for c in edge.colors)
        edges.append(Edge(number, left, right, colors))
    cells = [
        Cell(
            cell_to[cell.id],
            tuple(color_to[c] for c in cell.colors),
            tuple(tuple(dart_to[d] for d in loop) for loop in cell.loops),
        )
        for cell in instance.cells
    ]
    cells.sort(key=lambda cell: cell.id)
    rng.shuffle(edges)
    return Instance("renamed", instance.colors, tuple(cells), tuple(edges))


def mirrored(instance: Instance) -> Instance:
    """Seen in a mirror: loops run the other way, left and right change places."""
    cells = tuple(
        replace(cell, loops=tuple(tuple(-d for d in reversed(loop)) for loop in cell.loops))
        for cell in instance.cells
    )
    edges = tuple(replace(edge, left=edge.right, right=edge.left) for edge in instance.edges)
    return replace(instance, cells=cells, edges=edges, surface=None)


def turned_loop(loop: tuple[int, ...], rng: random.Random) -> tuple[int, ...]:
    """The same loop, begun at another dart."""
    start = rng.randrange(len(loop))
    return loop[start:] + loop[:start]
