"""A topological graph so small that only its shape is seen: an SVG for a table of many."""

from __future__ import annotations

import networkx as nx
import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.pictures.picture import INK, LINES

_SIZE = 160.0
_MARGIN = 8.0
_ITERATIONS, _MOVES = 50, 20_000
"""Iterations of the layout, and about how often cells are moved altogether, which takes seconds."""


def thumbnail(instance: Instance) -> str:
    """The text of an SVG file, the same for the same graph.

    A dot is a cell, larger with more live darts, painted if it has a single color. A line joins
    cells with an edge between them, dashed where all these are dead. Positions mean nothing.
    """
    joined: dict[tuple[int, int], bool] = {}
    for edge in instance.edges:
        if OUTSIDE not in (edge.left, edge.right) and edge.left != edge.right:
            pair = min(edge.left, edge.right), max(edge.left, edge.right)
            joined[pair] = joined.get(pair, False) or bool(instance.joinable(edge.id))
    places = _places(len(instance.cells), list(joined))
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_SIZE:.0f} {_SIZE:.0f}" '
        f'width="{_SIZE:.0f}" height="{_SIZE:.0f}">'
    ]
    for (one, other), live in sorted(joined.items()):
        (x, y), (u, v) = places[one], places[other]
        dashes = "" if live else ' stroke-dasharray="1 2"'
        lines.append(
            f'<path d="M{x:.1f} {y:.1f}L{u:.1f} {v:.1f}" stroke="#999" stroke-width=".6"{dashes}/>'
        )
    scale = 3.0 / max(1.0, len(instance.cells) / 40) ** 0.4
    for cell, loops in zip(instance.cells, instance.live_loops, strict=True):
        x, y = places[cell.id]
        radius = scale * (0.5 + 0.25 * sum(map(len, loops)) ** 0.5)
        fill = LINES[cell.colors[0] % len(LINES)] if len(cell.colors) == 1 else "#fff"
        lines.append(
            f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{radius:.2f}" fill="{fill}" '
            f'stroke="{INK}" stroke-width=".4"/>'
        )
    return "\n".join([*lines, "</svg>\n"])


def _places(cells: int, joined: list[tuple[int, int]]) -> Array:
    """Where the cells are drawn, (cells, 2), all within the picture."""
    if cells < 2:
        return np.full((cells, 2), _SIZE / 2)
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(range(cells))
    graph.add_edges_from(joined)
    try:
        start = nx.planar_layout(graph)
    except nx.NetworkXException:  # a handle
        start = None
    iterations = min(_ITERATIONS, 1 + _MOVES // cells)
    found: dict[int, Array] = nx.spring_layout(graph, pos=start, seed=0, iterations=iterations)
    places = np.array([found[cell] for cell in range(cells)])
    extent = float(np.ptp(places, axis=0).max())
    middle = (places.max(axis=0) + places.min(axis=0)) / 2
    return np.asarray(_SIZE / 2 + (places - middle) * (_SIZE - 2 * _MARGIN) / extent)
