"""Where strokes run along a pass of their own segment: into a narrow place and back, or beside."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask

_BESIDE = 0.25  # spacings; passes nearer to each other than that leave the same trace
_APART = 1.0  # spacings along the path, between places of different passes
_FINE = 0.05  # spacings, about, between two of the points that are compared
_ALONG = 0.9  # cosine of the angle up to which two passes run along each other


def retraced(strokes: Sequence[Array], spacing: float) -> list[Mask]:
    """Which points of a segment's strokes have another pass of these strokes beside them.

    Both passes are marked, so it does not matter which of them comes first: a stroke may be
    reversed. A path that is cut at the end of a narrow place goes in on one stroke and comes back
    on the next.

    Args:
        strokes: (k, 3) points on the way of each, in their order, m.
        spacing: desired between passes, m.
    """
    lengths = [np.linalg.norm(np.diff(points, axis=0), axis=1) for points in strokes]
    # With a wide spacing there would be millions of pairs of points a millimeter apart.
    count, length = sum(map(len, strokes)), sum(float(steps.sum()) for steps in lengths)
    every = max(1, int(_FINE * spacing * count / max(length, spacing)))
    ways, thin, begin = [], [], 0.0
    for points, steps in zip(strokes, lengths, strict=True):
        ways.append((begin + np.concatenate([[0.0], np.cumsum(steps)]))[::every])
        thin.append(points[::every])
        begin += float(steps.sum()) + 2 * _APART * spacing  # another stroke is another pass
    way, points = np.concatenate(ways), np.concatenate(thin)
    steps = np.concatenate([_steps(own) for own in thin])
    sizes = np.linalg.norm(steps, axis=1, keepdims=True)
    directions = steps / np.where(sizes > 0, sizes, 1.0)
    near = cKDTree(points).query_pairs(_BESIDE * spacing, output_type="ndarray")
    one, other = near.T
    parallel = np.abs(np.einsum("ij,ij->i", directions[one], directions[other])) >= _ALONG
    passes = near[parallel & (np.abs(way[one] - way[other]) > _APART * spacing)]
    marked = np.zeros(len(points), dtype=bool)
    marked[passes.ravel()] = True
    parts = np.split(marked, np.cumsum([len(own) for own in thin])[:-1])
    return [np.repeat(part, every)[: len(own)] for part, own in zip(parts, strokes, strict=True)]


def _steps(points: Array) -> Array:
    """From the point before to the one after, (k, 3); zero if there is only one."""
    return np.gradient(points, axis=0) if len(points) > 1 else np.zeros_like(points)


def stretches(marked: Mask) -> list[tuple[int, int]]:
    """First and last point of each run of at least two marked points."""
    ends = np.diff(np.concatenate([[0], marked.astype(np.int8), [0]]))
    first, after = np.flatnonzero(ends > 0), np.flatnonzero(ends < 0)
    return [(a, b - 1) for a, b in zip(first.tolist(), after.tolist(), strict=True) if b - a > 1]
