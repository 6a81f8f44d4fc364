"""The same instance written in other ways, and whether two instances are one.

A topological graph is a set of cyclic lists of darts, each dart with its twin and its joinable
colors, each list with a cell and its colors. This is written from the definition of the format
alone: it shares nothing with the decomposition.
"""

from __future__ import annotations

import random
from collections import defaultdict
from dataclasses import replace
from operator import eq

import networkx as nx

from cellcolor.data.cells_and_edges import OUTSIDE, Cell, Edge
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


def isomorphic(one: Instance, other: Instance) -> bool:
    """Whether two instances are the same rotation system with the same colors."""
    graphs = _steps(one), _steps(other)
    return set(one.colors) == set(other.colors) and nx.is_isomorphic(*graphs, eq, eq)


def _steps(instance: Instance) -> nx.DiGraph[object]:
    """From each dart to the next one of its loop, to its twin, and to its cell."""

    def names(colors: tuple[int, ...]) -> frozenset[str]:
        return frozenset(instance.colors[color] for color in colors)

    graph: nx.DiGraph[object] = nx.DiGraph()
    steps: dict[tuple[object, object], set[str]] = defaultdict(set)
    for cell in instance.cells:
        graph.add_node(cell, colors=names(cell.colors))
        for loop in cell.loops:
            for dart, following in zip(loop, loop[1:] + loop[:1], strict=True):
                outside = instance.across(dart) == OUTSIDE
                graph.add_node(dart, colors=names(instance.joinable(dart)), outside=outside)
                steps[dart, following].add("next")
                steps[dart, cell].add("cell")
                if not outside:
                    steps[dart, -dart].add("twin")
    graph.add_edges_from((a, b, {"kinds": kinds}) for (a, b), kinds in steps.items())
    return graph
