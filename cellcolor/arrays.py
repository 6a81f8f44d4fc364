"""The NumPy arrays that pass between modules, by what they hold; and steps that many take."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Index = NDArray[np.int64]
Mask = NDArray[np.bool_]


def numbered(counts: Index) -> tuple[Index, Index]:
    """The items of groups of given sizes, one group after the other (a "ragged arange").

    Returns:
        The group of each item, and its number in the group, from 0.
    """
    group = np.repeat(np.arange(len(counts)), counts)
    return group, np.arange(len(group)) - np.repeat(np.cumsum(counts) - counts, counts)


def cuts(sizes: Array) -> tuple[Index, Array]:
    """Where to cut things of given sizes (k,) into the fewest equal parts of size 1 or less.

    Returns:
        The thing that each cut is on, and at what share of it, above 0 and below 1.
    """
    parts = np.maximum(np.ceil(sizes).astype(np.int64), 1)
    which, number = numbered(parts - 1)
    return which, (number + 1) / parts[which]


def unit(vectors: Array) -> Array:
    """Vectors (..., 3) at length 1; those of length 0 stay 0."""
    lengths = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.asarray(vectors / np.where(lengths > 0, lengths, 1.0))


def angles_between(first: Array, second: Array) -> Array:
    """Angles (k,) between unit vectors (k, 3), rad; one of the two may be a single vector (3,)."""
    chord = np.linalg.norm(first - second, axis=1)
    return np.asarray(2 * np.arcsin(np.minimum(chord / 2, 1.0)))


def stretches(of: Mask) -> list[tuple[int, int]]:
    """First row of each stretch of neighbors (k,) that are true, and the one after its last."""
    steps = np.diff(np.concatenate([[0], of.astype(np.int8), [0]]))
    begins, ends = np.flatnonzero(steps > 0).tolist(), np.flatnonzero(steps < 0).tolist()
    return list(zip(begins, ends, strict=True))


def stretch_of(of: Mask) -> Index:
    """The number (k,) of the stretch of neighbors that are true, -1 where they are not."""
    begins = of & ~np.concatenate([[False], of[:-1]])
    return np.where(of, np.cumsum(begins) - 1, -1)


def to_nearest(places: Array, fixed: Array) -> Array:
    """How far places (k,) on a line are from the nearest of others, ascending and at least one."""
    after = np.searchsorted(fixed, places)
    low, high = np.maximum(after - 1, 0), np.minimum(after, len(fixed) - 1)
    return np.minimum(np.abs(fixed[low] - places), np.abs(fixed[high] - places))
