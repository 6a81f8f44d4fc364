"""The NumPy arrays that pass between modules, by what they hold; and a step that many take."""

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
