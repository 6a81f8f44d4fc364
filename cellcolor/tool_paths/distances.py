"""Shortest ways along the edges of a mesh."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import dijkstra

from cellcolor.arrays import Array, Index
from cellcolor.tool_paths.triangles import Triangles


@dataclass(frozen=True, eq=False)
class Ways:
    """Shortest ways along edges from the nearest of several sources.

    Attributes:
        lengths: (n,) by the weights that were given; infinite where no way leads.
        before: (n,) the vertex before each on its way; negative at sources and out of reach.
        source: (n,) where the way begins; negative out of reach.
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
    """(e,) lengths of edges, up to three times as much where they are near the border.

    Shortest ways by these lengths keep to the middle where it is narrow.

    Args:
        mesh: the mesh.
        room: from which distance on a border does not matter, m.
    """
    if not mesh.border.any():
        return mesh.lengths
    near = 1.0 - np.minimum(mesh.from_border / room, 1.0)
    return np.asarray(mesh.lengths * (1.0 + 2.0 * near[mesh.edges].mean(axis=1)))
