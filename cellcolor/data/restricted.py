"""A topological graph without some of its cells: what is left out on purpose is outside."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from cellcolor.data.instance import OUTSIDE, Edge, Instance

__all__ = ["without_cells"]


def without_cells(instance: Instance, left_out: Collection[int]) -> tuple[Instance, list[int]]:
    """The graph of a surface that is not to be covered in some cells.

    Args:
        instance: the topological graph.
        left_out: its cells that nobody covers.

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
