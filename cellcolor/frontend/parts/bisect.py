"""Mesh edges bisected, and with them the longest edges of their triangles.

Where the middle of a triangle's longest side is connected with the corner opposite, again and
again, no angle gets smaller than half the smallest one that was there (Rosenberg and Stenger
1975). So with any side of a triangle its longest one is bisected too (Rivara 1984).
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.parts.surface import Faces, Surface, along_edges
from cellcolor.frontend.sizes import check_vertices

__all__ = ["bisected"]


def bisected(surface: Surface, marked: Mask, field: str) -> Surface:
    """A surface with some mesh edges parted in the middle, and others where that is needed.

    New vertices come after the given ones. Their normals are halfway between those of the ends.

    Args:
        surface: the surface.
        marked: (k,) which of its edges, in the order of
            :meth:`~cellcolor.frontend.parts.surface.Surface.edges`.
        field: the key that asks for it.

    Raises:
        InputError: there would be too many vertices; names the key.
    """
    edges = surface.edges()
    count = len(surface.vertices)
    sides = np.sort(np.stack([surface.faces, np.roll(surface.faces, -1, axis=1)], axis=2), axis=2)
    # The edge on each side of each face (m, 3): ab, bc, ca. Edges are in lexicographic order.
    number = np.searchsorted(edges @ [count, 1], sides @ [count, 1])
    longest = np.take_along_axis(number, _longest(surface.lengths(edges), number), axis=1)[:, 0]
    marked = marked.copy()
    while True:
        missing = longest[marked[number].any(axis=1) & ~marked[longest]]
        if not len(missing):
            break
        marked[missing] = True
    parted = edges[marked]
    check_vertices(count + len(parted), field)
    middle = np.full(len(edges), -1, dtype=np.int64)
    middle[marked] = count + np.arange(len(parted))
    points, directions = along_edges(surface, parted, np.full(len(parted), 0.5))
    return Surface(
        np.concatenate([surface.vertices, points]),
        _parted(surface.faces, middle[number], _longest(surface.lengths(edges), number)),
        np.concatenate([surface.normals, -directions]),
        surface.faceted,
    )


def _longest(lengths: Array, number: Index) -> Index:
    """Which side of each face (m, 1) is its longest; of equal ones the edge that comes first."""
    rank = np.empty(len(lengths), dtype=np.int64)
    rank[np.lexsort((-np.arange(len(lengths)), lengths))] = np.arange(len(lengths))
    return np.asarray(rank[number].argmax(axis=1)[:, None])


def _parted(faces: Faces, middle: Index, longest: Index) -> Faces:
    """Faces parted at the middles (m, 3) of their sides, -1 where there is none."""
    order = (longest + np.arange(3)) % 3
    (a, b, c), (ab, bc, ca) = (np.take_along_axis(x, order, axis=1).T for x in (faces, middle))
    patterns = {
        (False, False, False): [(a, b, c)],
        (True, False, False): [(a, ab, c), (ab, b, c)],
        (True, True, False): [(a, ab, c), (ab, b, bc), (ab, bc, c)],
        (True, False, True): [(ab, b, c), (a, ab, ca), (ab, c, ca)],
        (True, True, True): [(a, ab, ca), (ab, b, bc), (ab, bc, c), (ab, c, ca)],
    }
    return np.concatenate(
        [
            np.column_stack(triangle)[((ab >= 0) == p) & ((bc >= 0) == q) & ((ca >= 0) == r)]
            for (p, q, r), triangles in patterns.items()
            for triangle in triangles
        ]
    )
