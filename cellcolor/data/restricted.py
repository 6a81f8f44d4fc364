"""What is left out on purpose: a graph without some cells, a surface without some colors."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.data.cells_and_edges import OUTSIDE, Edge
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface


def without_cells(instance: Instance, left_out: Collection[int]) -> tuple[Instance, list[int]]:
    """The graph of a surface that is not to be covered in some cells.

    Args:
        instance: the topological graph.
        left_out: its cells that are not to be covered.

    Returns:
        The graph of the other cells, which are numbered anew in the same order, without a
        reference to the surface; and the number that each of them had.
    """
    kept = [cell for cell in range(len(instance.cells)) if cell not in set(left_out)]
    number = dict(zip(kept, range(len(kept)), strict=True))
    cells = tuple(replace(instance.cells[cell], id=number[cell]) for cell in kept)
    edges = []
    for edge in instance.edges:
        left, right = number.get(edge.left, OUTSIDE), number.get(edge.right, OUTSIDE)
        if left == OUTSIDE and right == OUTSIDE:
            continue
        # A list of joinable colors is one of those that both sides share.
        colors = None if OUTSIDE in (left, right) else edge.colors
        edges.append(Edge(edge.id, left, right, colors, edge.length))
    graph = replace(
        instance, cells=cells, edges=tuple(edges), surface=None, known=None, coverage=None
    )
    return graph, kept


def without_vertices(surface: LabelledSurface, mask: Mask) -> LabelledSurface:
    """The surface without colors at some vertices (n,), which it gives up."""
    out = np.flatnonzero(mask).tolist()
    colors = list(surface.vertex_colors)
    given_up = {*surface.given_up, *(vertex for vertex in out if colors[vertex])}
    for vertex in out:
        colors[vertex] = ()
    cracks = tuple(crack for crack in surface.cracks if not (mask[crack.i] or mask[crack.j]))
    return replace(
        surface, vertex_colors=tuple(colors), given_up=tuple(sorted(given_up)), cracks=cracks
    )
