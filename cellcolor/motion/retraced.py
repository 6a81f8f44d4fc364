"""Where a stroke runs along one of its own passes: into a narrow place and back, or beside it."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask

_BESIDE = 0.25  # spacings; passes nearer to each other than that leave the same trace
_APART = 1.0  # spacings along the path, between places of different passes
_FINE = 0.05  # spacings, about, between two of the points that are compared
_ALONG = 0.9  # cosine of the angle up to which two passes run along each other


def beside_itself(points: Array, spacing: float) -> Mask:
    """Which points (k, 3) of a stroke have another of its passes beside them.

    Both passes are marked, so it does not matter which of them comes first: a stroke may be
    reversed.

    Args:
        points: on the way, in their order, m.
        spacing: desired between passes, m.
    """
    found = np.zeros(len(points), dtype=bool)
    if len(points) < 3:
        return found
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    # With a wide spacing there would be millions of pairs of points a millimeter apart.
    every = max(1, int(_FINE * spacing * len(points) / max(way[-1], spacing)))
    thin = np.arange(0, len(points), every)
    marked = _marked(points[thin], way[thin], spacing) if len(thin) > 2 else found[thin]
    return np.asarray(np.repeat(marked, every)[: len(points)])


def _marked(points: Array, way: Array, spacing: float) -> Mask:
    """The same for a few of the points, each with its way from the beginning, m."""
    found = np.zeros(len(points), dtype=bool)
    steps = np.gradient(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1, keepdims=True)
    directions = steps / np.where(lengths > 0, lengths, 1.0)
    near = cKDTree(points).query_pairs(_BESIDE * spacing, output_type="ndarray")
    one, other = near.T
    parallel = np.abs(np.einsum("ij,ij->i", directions[one], directions[other])) >= _ALONG
    passes = near[parallel & (np.abs(way[one] - way[other]) > _APART * spacing)]
    found[passes.ravel()] = True
    return found


def stretches(marked: Mask) -> list[tuple[int, int]]:
    """First and last point of each run of at least two marked points."""
    ends = np.diff(np.concatenate([[0], marked.astype(np.int8), [0]]))
    first, after = np.flatnonzero(ends > 0), np.flatnonzero(ends < 0)
    return [(a, b - 1) for a, b in zip(first.tolist(), after.tolist(), strict=True) if b - a > 1]
