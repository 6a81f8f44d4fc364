"""Validity on the way: what is linked has to be valid between the vertices as well.

Where a branch is valid all around both ends of a mesh edge, it is taken for valid in between. An
edge with an end at the border of the branch's domain, where limits, contacts and thresholds are
near, is tested at points on it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from cellcolor.frontend.collision import Mask
from cellcolor.frontend.robot import Array
from cellcolor.frontend.surfaces import Surface

__all__ = ["along_edges", "at_domain_border", "remains_valid"]

_AT_ONCE = 20_000  # configurations; a matter of memory: some kilobytes each

Index = NDArray[np.int64]
Test = Callable[[Array, Array, NDArray[np.intp]], Mask]
"""Points (k, 3), unit tool directions (k, 3) and branches (k,): are they valid (k,)?"""


def along_edges(surface: Surface, edges: Index, way: Array) -> tuple[Array, Array]:
    """Points and unit tool directions (k, 3) at the parts ``way`` (k,) of mesh edges (k, 2).

    The point goes straight, on the mesh, and the normal turns with it.
    """
    i, j = edges.T
    at = way[:, None]
    points = (1 - at) * surface.vertices[i] + at * surface.vertices[j]
    normals = (1 - at) * surface.normals[i] + at * surface.normals[j]
    with np.errstate(invalid="ignore"):  # between opposite normals there is none: NaN
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return points, -normals


def at_domain_border(edges: Index, valid: Mask) -> Mask:
    """Which edges have an end with a neighbor that a branch does not reach, (k, branches).

    Args:
        edges: (k, 2) all mesh edges.
        valid: (n, branches).
    """
    i, j = edges.T
    beside = np.zeros_like(valid)
    for here, there in ((i, j), (j, i)):
        rows, branches = np.nonzero(~valid[there])
        beside[here[rows], branches] = True
    border: Mask = beside[i] | beside[j]
    return border


def remains_valid(
    surface: Surface, edges: Index, branches: NDArray[np.intp], spacing: float, test: Test
) -> Mask:
    """Whether each branch is valid at points on its mesh edge, (k,).

    Args:
        edges: (k, 2) vertex indices.
        branches: (k,) one of each edge.
        spacing: greatest distance between the points, m.
        test: see :data:`Test`.
    """
    result = np.ones(len(edges), dtype=bool)
    pieces = np.maximum(np.ceil(surface.lengths(edges) / spacing).astype(int), 2)
    for first, last in _batches(np.cumsum(pieces - 1)):
        count = pieces[first:last] - 1
        rows = np.repeat(np.arange(first, last), count)
        number = np.arange(len(rows)) - np.repeat(np.cumsum(count) - count, count) + 1
        way = number / pieces[rows]
        valid = test(*along_edges(surface, edges[rows], way), branches[rows])
        result[rows[~valid]] = False
    return result


def _batches(total: Index) -> list[tuple[int, int]]:
    """Ranges of about equal numbers of points, from their running total."""
    if not len(total):
        return []
    cuts = np.searchsorted(total, np.arange(_AT_ONCE, total[-1], _AT_ONCE))
    bounds = np.unique([0, *cuts.tolist(), len(total)]).tolist()
    return list(itertools.pairwise(bounds))
