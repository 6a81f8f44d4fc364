"""The most connections that fit side by side into a cell.

A **grouping** puts the live darts of a cell into groups, each in one color that all of its darts
can be joined in, so that the groups can be drawn in the cell as connected areas that do not cross.
A group of k darts makes k - 1 **connections**: there are as many connections and groups together
as darts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Index
from cellcolor.deadline import NEVER, Deadline

MOST_ENTRIES = 50_000_000
"""The most entries in a recursion's tables, eight bytes each."""


@dataclass(frozen=True, slots=True)
class Group:
    """Darts that one connected area touches.

    Attributes:
        color: that of the area.
        darts: places in the list of all darts, in the cyclic order in which the area has them.
    """

    color: int
    darts: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Grouping:
    """Groups that do not cross; every dart is in one of them."""

    groups: tuple[Group, ...]

    @property
    def connections(self) -> int:
        """How many there are in all groups together."""
        return sum(len(group.darts) - 1 for group in self.groups)


def recursion_size(colors: Sequence[frozenset[int]]) -> int:
    """Entries of the tables that :func:`best_grouping` needs."""
    return (len(colors) + 1 + sum(map(len, colors))) * (len(colors) + 1)


def best_grouping(colors: Sequence[frozenset[int]], deadline: Deadline = NEVER) -> Grouping:
    """A grouping of a single loop's darts with the most connections.

    ``best[i, j]`` is that of the darts from i to j, j left out. Dart i is in no group with a later
    one, or it is connected in some color to a next dart k, and the darts between them are separate.

    Args:
        colors: those that each dart can be joined in, one at least, in cyclic order.
    """
    tables = _Tables(colors)
    for one in reversed(range(len(colors))):
        deadline.check()
        tables.add(one)
    return Grouping(tuple(tables.groups()))


class _Tables:
    """What the recursion has found.

    Attributes:
        best: the most connections of the darts from one to another.
        linked: the same for each end if the first dart is in a group of some color.
    """

    def __init__(self, colors: Sequence[frozenset[int]]) -> None:
        size = len(colors) + 1
        self.best: Index = np.zeros((size, size), dtype=np.int64)
        self.linked: dict[tuple[int, int], Index] = {}
        self._colors = colors
        self._darts = {
            color: [dart for dart, own in enumerate(colors) if color in own]
            for color in frozenset[int]().union(*colors)
        }

    def add(self, one: int) -> None:
        """Fill in the rows of a dart; those of later darts are filled in."""
        below = self.best[one + 1]
        self.best[one] = below
        for color in self._colors[one]:
            found = below.copy()
            for other in self._darts[color]:
                if one < other:
                    further = below[other] + 1 + self.linked[other, color][other + 1 :]
                    np.maximum(found[other + 1 :], further, out=found[other + 1 :])
            self.linked[one, color] = found
            np.maximum(self.best[one], found, out=self.best[one])

    def groups(self) -> list[Group]:
        """Read the groups off the tables."""
        groups = []
        waiting = [(0, len(self._colors))]
        while waiting:
            first, end = waiting.pop()
            if first >= end:
                continue
            color = next(
                color
                for color in sorted(self._colors[first])
                if self.linked[first, color][end] == self.best[first, end]
            )
            darts = [first]
            while (following := self._following(darts[-1], color, end)) is not None:
                waiting.append((darts[-1] + 1, following))
                darts.append(following)
            waiting.append((darts[-1] + 1, end))
            groups.append(Group(color, tuple(darts)))
        return groups

    def _following(self, last: int, color: int, end: int) -> int | None:
        """The next dart of a group, None after its last one."""
        most = self.linked[last, color][end]
        for other in self._darts[color]:
            if last < other < end:
                further = self.linked[other, color][end]
                if most == self.best[last + 1, other] + 1 + further:
                    return other
        return None
