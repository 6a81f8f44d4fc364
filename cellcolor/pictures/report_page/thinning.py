"""Fewer samples that show the same: a page needs no more than can be seen on it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.trajectory import Trajectory


def frames_of(trajectory: Trajectory, most: int) -> Index:
    """Samples, ascending, at about equal travel of the joints, of time where they rest.

    The ends of strokes and of moves that were not planned are always among them.

    Args:
        trajectory: one sample or more.
        most: how many, besides the ends.
    """
    count = len(trajectory.times)
    inside = [end for first, after in trajectory.strokes for end in (first, after - 1)]
    inside += [end for sample in trajectory.unplanned for end in (sample, sample + 1)]
    ends = np.array([0, count - 1, *inside], dtype=np.int64)
    if count <= most:
        return np.arange(count)
    travel = np.abs(np.diff(trajectory.joints, axis=0)).max(axis=1)
    steps = travel / (travel.sum() or 1.0) + 0.2 * np.diff(trajectory.times) / trajectory.seconds
    along = np.concatenate([[0.0], np.cumsum(steps)])
    even = np.searchsorted(along, np.linspace(0, along[-1], most))
    return np.unique(np.concatenate([ends, np.minimum(even, count - 1)]))


def least_until_next(values: Array, frames: Index) -> Array:
    """The least value from each frame until before the next, so that no dip is left out."""
    least: Array = np.minimum.reduceat(values, frames)
    return least


def straightened(points: Array, kept: Index, tolerance: float) -> Index:
    """Points, ascending, whose polyline passes all points (k, 3) within a tolerance, m.

    By halving at the farthest point (Douglas and Peucker, Algorithms for the reduction of the
    number of points required to represent a digitized line, 1973).

    Args:
        points: of a polyline, two or more.
        kept: points that stay in any case.
        tolerance: m.
    """
    chosen = np.zeros(len(points), dtype=bool)
    chosen[[0, len(points) - 1]] = True
    chosen[kept] = True
    stops = np.flatnonzero(chosen).tolist()
    pieces = list(pairwise(stops))
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        between = points[first + 1 : last] - points[first]
        way = points[last] - points[first]
        share = np.clip(between @ way / (way @ way or 1.0), 0, 1)
        far = np.linalg.norm(between - share[:, None] * way, axis=1)
        worst = int(np.argmax(far))
        if far[worst] > tolerance:
            middle = first + 1 + worst
            chosen[middle] = True
            pieces += [(first, middle), (middle, last)]
    return np.flatnonzero(chosen)
