"""Shortest ways along mesh edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index
from cellcolor.tool_paths.triangles import Triangles


@dataclass(frozen=True, eq=False)
class Ways:
    """The shortest way to each vertex from the nearest of several sources.

    Attributes:
        lengths: (n,) in the weights of the graph; infinite if there is no way.
        before: (n,) the vertex before each on its way; negative at sources and if there is no way.
        source: (n,) where the way begins; negative if there is no way.
    """

    lengths: Array
    before: Index
    source: Index

    def back_from(self, vertex: int) -> list[int]:
        """The way from a vertex back to its source, both included."""
        way = [vertex]
        while self.before[way[-1]] >= 0:
            way.append(int(self.before[way[-1]]))
        return way


def ways_from(graph: csr_matrix, sources: Index) -> Ways:
    """Dijkstra's algorithm from all sources at once."""
    lengths, before, source = dijkstra(
        graph, indices=sources, min_only=True, return_predecessors=True
    )
    return Ways(lengths, before.astype(np.int64), source.astype(np.int64))


def off_border(mesh: Triangles, room: float) -> Array:
    """Weights (e,) of edges, m: their lengths, up to tripled near the border of the mesh.

    With these weights shortest ways stay in the middle of narrow places.

    Args:
        mesh: the mesh.
        room: at this distance from the border and beyond, weights are lengths, m.
    """
    if not mesh.border.any():
        return mesh.lengths
    near = 1.0 - np.minimum(mesh.from_border / room, 1.0)
    return np.asarray(mesh.lengths * (1.0 + 2.0 * near[mesh.edges].mean(axis=1)))
