"""The most connections that fit side by side into a cell.

A **grouping** puts the live darts of a cell into groups, each in one color that all of its darts
can be joined in, so that the groups can be drawn in the cell as connected areas that do not cross.
A group of k darts makes k - 1 **connections**: there are as many connections and groups together
as darts.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cellcolor.arrays import Index
from cellcolor.deadline import NEVER, Deadline

MOST_ENTRIES = 50_000_000
"""The most entries in a recursion's tables, eight bytes each."""

Group = tuple[int, tuple[int, ...]]
"""A color, and the places of the darts that one connected area touches, in cyclic order."""


def recursion_size(colors: Sequence[frozenset[int]]) -> int:
    """Entries of the tables that :func:`best_grouping` needs."""
    return (len(colors) + 1 + sum(map(len, colors))) * (len(colors) + 1)


def best_grouping(colors: Sequence[frozenset[int]], deadline: Deadline = NEVER) -> list[Group]:
    """A grouping of a single loop's darts with the fewest groups, so with the most connections.

    ``best[i, j]`` are the most of the darts from i to j, j left out, and ``linked[i, c][j]`` those
    if i is in a group of color c. Dart i is in no group with a later one, or it is connected in
    some color to a next dart k, and the darts between them are separate.

    Args:
        colors: those that each dart can be joined in, one at least, in cyclic order.
    """
    count = len(colors)
    best: Index = np.zeros((count + 1, count + 1), dtype=np.int64)
    linked: dict[tuple[int, int], Index] = {}
    able = {
        color: [dart for dart, own in enumerate(colors) if color in own]
        for color in frozenset[int]().union(*colors)
    }
    for one in reversed(range(count)):
        deadline.check()
        below = best[one + 1]
        best[one] = below
        for color in colors[one]:
            found = below.copy()
            for other in able[color]:
                if one < other:
                    further = below[other] + 1 + linked[other, color][other + 1 :]
                    np.maximum(found[other + 1 :], further, out=found[other + 1 :])
            linked[one, color] = found
            np.maximum(best[one], found, out=best[one])

    def following(last: int, color: int, end: int) -> int | None:
        """The next dart of a group, None after its last one."""
        for other in able[color]:
            if last < other < end:
                further = best[last + 1, other] + 1 + linked[other, color][end]
                if linked[last, color][end] == further:
                    return other
        return None

    groups: list[Group] = []
    waiting = [(0, count)]
    while waiting:
        first, end = waiting.pop()
        if first == end:
            continue
        most = best[first, end]
        color = next(c for c in sorted(colors[first]) if linked[first, c][end] == most)
        darts = [first]
        while (after := following(darts[-1], color, end)) is not None:
            waiting.append((darts[-1] + 1, after))
            darts.append(after)
        waiting.append((darts[-1] + 1, end))
        groups.append((color, tuple(darts)))
    return groups
