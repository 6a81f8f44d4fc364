"""The ways to divide a hub all of whose darts have one color (docs/bounds.md, "Hubs").

A **leaf set** is a neighbor of a hub, or several that are connected in any case. Some are
**shared** with other hubs, or met twice by this one. To all others it only matters which shared
leaf sets a way connects, so of ways that connect the same ones only the best is kept.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.deadline import Deadline

MOST_WAYS = 2_000
"""Ways to divide a range of darts; a hub with more of them is left to other methods."""

Groups = frozenset[frozenset[int]]
"""Groups of shared leaf sets that are connected, each of two and more."""

Areas = tuple[tuple[int, tuple[int, ...]], ...]
"""Areas of a hub, each with its color and its darts."""

Ways = dict[Groups, tuple[int, Areas]]
"""By the groups that a way connects: the most links that it can have besides, and its areas. These
links are the ones to leaf sets of the hub's own, and between those where an area has no others."""


def hub_ways(
    darts: Sequence[int],
    colors: Sequence[int],
    leaf_sets: Sequence[int],
    shared: set[int],
    deadline: Deadline,
) -> Ways | None:
    """All undominated ways to divide a hub, by a recursion over ranges of its darts.

    Args:
        darts: of the hub, in cyclic order.
        colors: of each dart.
        leaf_sets: across each dart.
        shared: leaf sets whose connections matter outside.

    Returns:
        The ways; None if there are too many.
    """
    count = len(darts)
    own_shared = [frozenset((leaf_set,)) & shared for leaf_set in leaf_sets]
    # Of the darts from the one number to before the other.
    ways: dict[tuple[int, int], Ways] = {}
    for first in reversed(range(count + 1)):
        ways[first, first] = {frozenset(): (0, ())}
        for end in range(first + 1, count + 1):
            deadline.check()
            found = _of_range(darts, colors, own_shared, ways, first, end)
            if found is None:
                return None
            ways[first, end] = found
    return ways[0, count]


def _of_range(
    darts: Sequence[int],
    colors: Sequence[int],
    shared: Sequence[frozenset[int]],
    ways: dict[tuple[int, int], Ways],
    first: int,
    end: int,
) -> Ways | None:
    """The ways of a range from those of shorter ones.

    The area of the range's first dart takes in further darts of its color. That leaves a shorter
    range between each two of them, and one behind the last.
    """
    found: Ways = {}
    # Open areas by their last dart, the groups between their darts, and their own shared leaf sets:
    # links, the areas between their darts, their darts.
    open_: dict[tuple[int, Groups, frozenset[int]], tuple[int, Areas, tuple[int, ...]]]
    open_ = {(first, frozenset(), shared[first]): (0, (), (first,))}
    for last in range(first, end):
        behind = ways[last + 1, end]
        further = [dart for dart in range(last + 1, end) if colors[dart] == colors[first]]
        for (at, groups, own), (links, areas, members) in list(open_.items()):
            if at != last:
                continue
            area = (colors[first], tuple(darts[member] for member in members))
            closed = groups | {own} if len(own) > 1 else groups
            for others, (more, beyond) in behind.items():
                if links + more > found.get(closed | others, (-1,))[0]:
                    found[closed | others] = links + more, (*areas, area, *beyond)
            for dart in further:
                # A leaf set of its own is a link; a shared one is counted as it connects.
                link = int(not shared[dart] or not own)
                for others, (more, between) in ways[last + 1, dart].items():
                    key = dart, groups | others, own | shared[dart]
                    if links + more + link > open_.get(key, (-1,))[0]:
                        total = links + more + link
                        open_[key] = total, (*areas, *between), (*members, dart)
        if len(open_) > 10 * MOST_WAYS:
            return None
    best = _undominated(found)
    return best if len(best) <= MOST_WAYS else None


def _undominated(found: Ways) -> Ways:
    """Without dominated ways: another one connects the same leaf sets with no fewer links."""
    kept: Ways = {}
    order = sorted(found, key=lambda groups: (-found[groups][0], -sum(map(len, groups))))
    for groups in order:
        if not any(
            all(any(group <= its for its in other) for group in groups)
            for other, (links, _) in kept.items()
            if links >= found[groups][0]
        ):
            kept[groups] = found[groups]
    return kept
