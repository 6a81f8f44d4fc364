"""Validity on the way: what is linked has to be valid between the vertices as well.

Every link is tested at points so close that no body moves far from one to the next. An edge with an
end at the border of the branch's domain, where limits, contacts and thresholds are near, is tested
at points that are close on the surface as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask, numbered
from cellcolor.frontend.parts.surface import Surface, along_edges
from cellcolor.memory import batches

_ROUNDS = 20  # each at least halves a step that is too long; what is left then is a jump

Test = Callable[[Array, Array, NDArray[np.intp]], tuple[Mask, Array]]
"""Points (k, 3), unit tool directions (k, 3) and the rows (k,) of edges that they are on: are the
configurations there valid (k,), and where are the ends of the bodies (ends, k, 3)?"""


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


def strides(first: Iterable[Array], second: Iterable[Array], longest: Array) -> Array:
    """The largest movement (k,) of a body from ends (ends, k, 3) to others, 1 if just allowed.

    No other point of a body's axis moves farther between the two: its displacement is a mean of
    those of the ends.
    """
    squares: Array = np.zeros(1)
    for here, there, allowed in zip(first, second, longest, strict=True):
        moved = there - here
        squares = np.maximum(squares, np.einsum("ij,ij->i", moved, moved) / allowed**2)
    return np.sqrt(squares)


def remains_valid(
    surface: Surface,
    edges: Index,
    branches: NDArray[np.intp],
    pieces: Index,
    ends: Array,
    longest: Array,
    test: Test,
) -> Mask:
    """Whether each branch is valid at points on its mesh edge, (k,).

    Args:
        edges: (k, 2) vertex indices.
        branches: (k,) one of each edge.
        pieces: (k,) the least number of equal parts that each edge is divided into. A part on which
            a body moves farther than it may is cut again.
        ends: (ends, n, branches, 3) of the bodies at the vertices, m.
        longest: (ends,) how far each may move between two points, m.
        test: see :data:`Test`.
    """
    result = np.ones(len(edges), dtype=bool)
    i, j = edges.T
    at_i, at_j = (end[i, branches] for end in ends), (end[j, branches] for end in ends)
    pieces = np.maximum(pieces, np.ceil(strides(at_i, at_j, longest)).astype(int))
    cut = np.flatnonzero(pieces > 1)
    for batch in batches(pieces[cut] + 1):
        # Parts of edges: row, from where to where, what they are cut into, the bodies there.
        rows = cut[batch]
        near, far = (ends[:, vertex[rows], branches[rows]] for vertex in (i, j))
        open_ = [(0, rows, np.zeros(len(rows)), np.ones(len(rows)), pieces[rows], near, far)]
        while open_:
            rounds, rows, low, high, count, near, far = open_.pop()
            if rounds == _ROUNDS:
                result[rows] = False
                continue
            part, number = numbered(count + 1)
            inner = (number > 0) & (number < count[part])
            row, way = rows[part], low[part] + (high - low)[part] * number / count[part]
            places = np.empty((len(near), len(row), 3))
            places[:, number == 0], places[:, number == count[part]] = near, far
            at = row[inner]
            points = along_edges(surface, edges[at], way[inner])
            valid, places[:, inner] = test(*points, at)
            result[at[~valid]] = False
            stride = strides(places[:, :-1], places[:, 1:], longest)
            here = np.flatnonzero((number[1:] > 0) & (stride > 1) & result[row[1:]])
            rows, low, high = row[here], way[here], way[here + 1]
            near, far = places[:, here], places[:, here + 1]
            count = np.ceil(stride[here]).astype(int)
            open_ += [
                (rounds + 1, rows[p], low[p], high[p], count[p], near[:, p], far[:, p])
                for p in batches(count + 1)
            ]
    return result
