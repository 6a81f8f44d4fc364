"""Where a stroke goes the same way again: into a narrow place and back, or over a bridge twice."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask

__all__ = ["retraced", "stretches"]

_SAME = 1e-5  # m; a point nearer than this to an earlier step is on it


def retraced(points: Array) -> Mask:
    """Which points of a stroke (k, 3), in m, lie on another of its steps as well.

    Both passes are marked, so that it does not matter which of them is called the first: a stroke
    may be turned round.
    """
    count = len(points)
    found = np.zeros(count, dtype=bool)
    if count < 3:
        return found
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    tree = cKDTree(points)
    near = tree.query_pairs(float(lengths.max()) + _SAME, output_type="ndarray")
    one, other = np.concatenate([near, near[:, ::-1]]).T
    for step in (other, other - 1):  # the two steps that end at the other point
        # A step that the point itself is an end of, or its neighbor, is the same pass.
        usable = (step >= 0) & (step < count - 1) & (np.abs(one - other) > 2)
        at, along = one[usable], step[usable]
        square = np.maximum(lengths[along] ** 2, _SAME**2)
        way = np.einsum("ij,ij->i", points[at] - points[along], steps[along]) / square
        foot = points[along] + np.clip(way, 0.0, 1.0)[:, None] * steps[along]
        found[at[np.linalg.norm(points[at] - foot, axis=1) < _SAME]] = True
    return found


def stretches(marked: Mask) -> list[tuple[int, int]]:
    """First and last point of each run of two marked points or more."""
    ends = np.diff(np.concatenate([[0], marked.astype(np.int8), [0]]))
    first, after = np.flatnonzero(ends > 0), np.flatnonzero(ends < 0)
    return [(a, b - 1) for a, b in zip(first.tolist(), after.tolist(), strict=True) if b - a > 1]
