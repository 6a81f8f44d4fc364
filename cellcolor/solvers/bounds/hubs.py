"""A lower bound by counting what fits side by side in cells with many edges (docs/bounds/hubs.md).

Remove some hubs. The rest needs at least a number of color regions, and each hub saves at most as
many segments as it has links: connections between its edges in one color that do not cross.

A **grouping** puts the live darts of a cell into groups, each in one color that all of its darts
can be joined in, so that the groups can be drawn in the cell as connected areas that do not cross.
A group of k darts has k - 1 **links**: there are as many links and groups together as darts.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Index
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import greedy_strangers
from cellcolor.union_find import UnionFind

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
    def links(self) -> int:
        """How many there are in all groups together."""
        return sum(len(group.darts) - 1 for group in self.groups)


def recursion_size(colors: Sequence[frozenset[int]]) -> int:
    """Entries of the tables that :func:`best_grouping` needs."""
    return (len(colors) + 1 + sum(map(len, colors))) * (len(colors) + 1)


def best_grouping(
    colors: Sequence[frozenset[int]], apart: int | None = None, deadline: Deadline = NEVER
) -> Grouping:
    """A grouping of a single loop's darts with the most links.

    ``best[i, j]`` is that of the darts from i to j, j left out. Dart i is in no group with a later
    one, or it is linked in some color to a next dart k, and the darts between them are separate.

    Args:
        colors: those that each dart can be joined in, one at least, in cyclic order.
        apart: a dart that must not be in one group with the first one.
    """
    count = len(colors)
    tables = _Tables(colors)
    for one in reversed(range(count)):
        deadline.check()
        tables.best[one] = tables.best[one + 1]
        for color in colors[one]:
            if apart is not None and color in colors[0]:
                tables.add_links(one, color, apart)
            if one or apart is None:
                tables.add_links(one, color, None)
            found = tables.linked[one, color, None if one else apart]
            np.maximum(tables.best[one], found, out=tables.best[one])
    return Grouping(tuple(tables.groups(apart)))


class _Tables:
    """What the recursion has found.

    Attributes:
        best: the most links of the darts from one to another.
        linked: the same for each end if the first dart is in a group of some color; the third key
            is a dart that is not to be in that group, or None.
    """

    def __init__(self, colors: Sequence[frozenset[int]]) -> None:
        size = len(colors) + 1
        self.best: Index = np.zeros((size, size), dtype=np.int64)
        self.linked: dict[tuple[int, int, int | None], Index] = {}
        self._colors = colors
        self._darts = {
            color: [dart for dart, own in enumerate(colors) if color in own]
            for color in frozenset[int]().union(*colors)
        }

    def add_links(self, one: int, color: int, apart: int | None) -> None:
        """Fill in a row of ``linked``."""
        below = self.best[one + 1]
        found = below.copy()
        for other in self._darts[color]:
            if one < other != apart:
                further = below[other] + 1 + self.linked[other, color, apart][other + 1 :]
                np.maximum(found[other + 1 :], further, out=found[other + 1 :])
        self.linked[one, color, apart] = found

    def groups(self, apart: int | None) -> list[Group]:
        """Read the groups off the tables."""
        groups = []
        waiting = [(0, len(self._colors))]
        while waiting:
            first, end = waiting.pop()
            if first >= end:
                continue
            without = None if first else apart
            color = next(
                color
                for color in sorted(self._colors[first])
                if self.linked[first, color, without][end] == self.best[first, end]
            )
            darts = [first]
            while (following := self._following(darts[-1], color, without, end)) is not None:
                waiting.append((darts[-1] + 1, following))
                darts.append(following)
            waiting.append((darts[-1] + 1, end))
            groups.append(Group(color, tuple(darts)))
        return groups

    def _following(self, last: int, color: int, apart: int | None, end: int) -> int | None:
        """The next dart of a group, None after its last one."""
        links = self.linked[last, color, apart][end]
        for other in self._darts[color]:
            if last < other < end and other != apart:
                further = self.linked[other, color, apart][end]
                if links == self.best[last + 1, other] + 1 + further:
                    return other
        return None


def links_bound(
    loops: Sequence[Sequence[frozenset[int]]], deadline: Deadline = NEVER
) -> int | None:
    """No grouping of a cell's darts has more links than this; None if nothing is known.

    A single loop reaches it. For several loops it counts the faces that groups and loops can make
    when they are drawn, which requires darts with one color each.

    Args:
        loops: the colors that each dart can be joined in, loop by loop, in cyclic order.
    """
    if len(loops) == 1:
        if recursion_size(loops[0]) > MOST_ENTRIES:
            return None
        return best_grouping(loops[0], deadline=deadline).links
    if any(len(own) > 1 for loop in loops for own in loop):
        return None
    single = [[color for own in loop for color in own] for loop in loops]
    shorter = [_contracted(loop) for loop in single]
    left = [loop for loop in shorter if len(loop) > 1]
    dropped = sum(map(len, single)) - sum(map(len, left))
    links = dropped + (_links_by_faces(left) if left else 0)
    in_color = Counter(color for loop in single for color in loop)
    return min(links, sum(count - 1 for count in in_color.values()))


def _contracted(loop: Sequence[int]) -> list[int]:
    """A cyclic list with one element for each run of equal ones."""
    kept = [color for place, color in enumerate(loop) if color != loop[place - 1]]
    return kept or [loop[0]]


def _links_by_faces(loops: Sequence[Sequence[int]]) -> int:
    """The most links of some loops in which no dart has the color of the next one.

    Drawn as points, with lines for darts, loops and groups make a plane graph, of so many parts. By
    Euler's formula it has links = loops + walks round faces - 2 * parts. How many walks there can
    be is told by the corners that they pass (docs/bounds/hubs.md, "Hubs with several loops").
    """
    corners = Counter(
        (loop[place - 1], color) for loop in loops for place, color in enumerate(loop)
    )
    surplus = {
        (one, other): count - corners[other, one]
        for (one, other), count in corners.items()
        if count > corners[other, one]
    }
    # Loops that a walk of two corners may have in common, and loops with a color in common.
    near: UnionFind[object] = UnionFind()
    sharing: UnionFind[object] = UnionFind()
    for number, loop in enumerate(loops):
        for place, color in enumerate(loop):
            one, other = sorted((loop[place - 1], color))
            if corners[one, other] and corners[other, one]:
                near.union(("loop", number), ("corner", one, other))
            sharing.union(("loop", number), ("color", color))
    classes = {near["loop", number] for number in range(len(loops))}
    parts = {sharing["loop", number] for number in range(len(loops))}
    with_surplus = {
        near["loop", number]
        for number, loop in enumerate(loops)
        if any((loop[place - 1], color) in surplus for place, color in enumerate(loop))
    }
    least, count = sum(surplus.values()), corners.total()
    most = 0
    for in_longer in range(least, count + 1, 2):
        touched = min(len(classes), (in_longer - least) // 2 + len(with_surplus))
        for joined in range(min(max(1, touched), 1 + len(classes) - len(parts))):
            longer = min(in_longer // 3, in_longer - joined)
            if (longer > 0) == (in_longer > 0):
                walks = (count - in_longer) // 2 + longer
                most = max(most, len(loops) + walks - 2 * (len(classes) - joined))
    return most


FEWEST_DARTS = 4
"""Live darts of a hub; around a cell with fewer no two connections can cross."""

MOST_HUBS = 200
"""Cells that are tried, those with the most live darts first."""


@dataclass(frozen=True, slots=True)
class HubBound:
    """No division of the surface has fewer segments than ``len(cells)`` less the hubs' links.

    Attributes:
        hubs: the removed cells; no two of them share a live edge.
        cells: no two of them lie in one color region of the rest.
    """

    value: int
    hubs: tuple[int, ...] = ()
    cells: tuple[int, ...] = ()


def hub_bound(instance: Instance, deadline: Deadline = NEVER) -> HubBound:
    """The best bound from hubs chosen one after the other, those found before the deadline."""
    found = HubBound(0, cells=tuple(greedy_strangers(instance)))
    links, fewest = 0, len(found.cells)
    darts = [sum(map(len, loops)) for loops in instance.live_loops]
    hardest = sorted(range(len(darts)), key=lambda cell: -darts[cell])[:MOST_HUBS]
    for cell in hardest:
        if deadline.over or darts[cell] < FEWEST_DARTS:
            break
        if not _is_hub(instance, cell, found.hubs):
            continue
        try:
            most = links_bound(joinable_colors(instance, cell), deadline)
        except OutOfTime:
            break
        if most is None:
            continue
        saved = links + most
        hubs = (*found.hubs, cell)
        cells = greedy_strangers(instance, hubs)
        # One hub of several that share their petals may be of use only together with the others.
        if len(cells) - saved >= fewest:
            links, fewest = saved, len(cells) - saved
            found = HubBound(fewest, hubs, tuple(sorted(cells)))
    return found


def joinable_colors(instance: Instance, cell: int) -> list[list[frozenset[int]]]:
    """The colors in which each live dart of a cell can be joined, loop by loop."""
    return [
        [frozenset(instance.joinable(dart)) for dart in loop] for loop in instance.live_loops[cell]
    ]


def _is_hub(instance: Instance, cell: int, hubs: Collection[int]) -> bool:
    """Whether every live edge of a cell is crossed once at most, and leads to none of the hubs."""
    for dart in (dart for loop in instance.live_loops[cell] for dart in loop):
        beyond = instance.across(dart)
        if beyond == cell or beyond in hubs:
            return False
        petal = sum(map(len, instance.live_loops[beyond])) == 1
        if not petal and len(instance.joinable(dart)) > 1:
            return False
    return True
