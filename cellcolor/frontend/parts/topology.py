"""How the faces of a mesh hang together, whatever is wrong with it: edges, neighbors, components.

Nothing here takes a mesh for a manifold. All is done for all faces at once, and takes memory in
proportion to them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.parts.surface import Faces, face_normals

__all__ = ["EdgeTable", "edge_table", "face_areas", "grouped", "parts_of"]


@dataclass(frozen=True)
class EdgeTable:
    """The edges of faces (m, 3), each once.

    Attributes:
        ends: (k, 2) vertices, the smaller first, in lexicographic order.
        of_face: (m, 3) the edge from each corner to the next: ab, bc, ca.
        forward: (m, 3) whether the face goes from the smaller vertex to the greater one.
        count: (k,) how many faces have the edge.
    """

    ends: Index
    of_face: Index
    forward: Mask
    count: Index

    def pairs(self) -> tuple[Index, Index]:
        """The edges (p,) that two faces have, and the sides (p, 2), numbered 3 * face + corner."""
        order = np.argsort(self.of_face, axis=None, kind="stable")
        first = np.cumsum(self.count) - self.count
        two = np.flatnonzero(self.count == 2)
        return two, np.column_stack([order[first[two]], order[first[two] + 1]])


def edge_table(faces: Faces) -> EdgeTable:
    """The edges of faces whose corners are three different vertices."""
    following = np.roll(faces, -1, axis=1)
    low, high = np.minimum(faces, following), np.maximum(faces, following)
    size = int(faces.max(initial=0)) + 1
    key, number, count = np.unique(
        (low * size + high).ravel(), return_inverse=True, return_counts=True
    )
    ends = np.column_stack(np.divmod(key, size))
    return EdgeTable(ends, number.reshape(-1, 3), faces < following, count)


def grouped(count: int, pairs: Index) -> Index:
    """The group (count,) of each of so many things, of which pairs (p, 2) belong together."""
    links = coo_array((np.ones(len(pairs), dtype=bool), tuple(pairs.T)), (count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def parts_of(faces: Faces, table: EdgeTable, closed: Mask | None = None) -> Index:
    """The part (m,) of each face: faces belong together that have an edge in common.

    Args:
        closed: (k,) edges that part faces all the same.
    """
    order = np.argsort(table.of_face, axis=None, kind="stable")
    edge = table.of_face.ravel()[order]
    same = edge[1:] == edge[:-1]
    if closed is not None:
        same &= ~closed[edge[1:]]
    sides = np.column_stack([order[:-1], order[1:]])[same]
    return grouped(len(faces), sides // 3)


def face_areas(vertices: Array, faces: Faces) -> Array:
    """Areas (m,) of faces, in the square of the vertices' unit."""
    return np.asarray(np.linalg.norm(face_normals(vertices, faces), axis=1) / 2)
