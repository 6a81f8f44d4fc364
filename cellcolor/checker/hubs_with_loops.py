"""The most links in a cell with several loops, by counting faces.

Draw a point in each loop and in each group of darts that a sub-cell connects, and a line for each
dart. By Euler's formula, for each part of that plane graph, there are as many links as loops and
walks round its faces together, less two for each part. A walk passes corners between a dart of a
loop and the next. After a corner from color a to color b comes one from b, so that two corners of a
walk are opposite ones, and a walk of three and more is needed wherever loops are to be connected
that have no opposite corners (docs/bounds.md, "Hubs with several loops").
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from cellcolor.checker.groups import Groups

Corner = tuple[int, int]
"""The color of a dart, and that of the next dart of its loop."""


def most_links(loops: Sequence[Sequence[int]], count: Callable[[], None]) -> int:
    """No more links can be drawn side by side, each between two darts of one color.

    Args:
        loops: the color of each dart, in cyclic order.
        count: called once for each choice that is tried.
    """
    # A dart that is left out was the end of one link at most, after others are put together.
    corners: list[list[Corner]] = []
    left_out = 0
    for loop in loops:
        turns = zip(loop, [*loop[1:], loop[0]], strict=True)
        kept = [(one, other) for one, other in turns if one != other]
        left_out += len(loop) - len(kept)
        if kept:
            corners.append(kept)
    colors = {color for loop in loops for color in loop}
    by_color = sum(map(len, loops)) - len(colors)
    return min(by_color, left_out + (_most(corners, count) if corners else 0))


def _most(loops: Sequence[Sequence[Corner]], count: Callable[[], None]) -> int:
    """The same for loops of which only the corners are known, each between two colors."""
    everywhere = [corner for loop in loops for corner in loop]
    number = {corner: everywhere.count(corner) for corner in set(everywhere)}
    alone = {
        (a, b): found - number.get((b, a), 0)
        for (a, b), found in number.items()
        if found > number.get((b, a), 0)
    }
    kinds: Groups[int] = Groups()
    parts: Groups[int] = Groups()
    for one, its in enumerate(loops):
        for other, others in enumerate(loops[:one]):
            if not {(b, a) for a, b in its}.isdisjoint(others):
                kinds.join(one, other)
            if not {a for a, _ in its}.isdisjoint(a for a, _ in others):
                parts.join(one, other)
    every = range(len(loops))
    kind_count = len({kinds.find(loop) for loop in every})
    part_count = len({parts.find(loop) for loop in every})
    odd_kinds = len(
        {kinds.find(n) for n, its in enumerate(loops) if not alone.keys().isdisjoint(its)}
    )
    best = 0
    # Corners in walks of three and more: those without an opposite one, and any pairs of opposites.
    for pairs in range((len(everywhere) - sum(alone.values())) // 2 + 1):
        long = sum(alone.values()) + 2 * pairs
        in_pairs = (len(everywhere) - long) // 2
        if long in (1, 2):
            continue
        for drawn in range(part_count, kind_count + 1):
            count()
            # So many kinds have to be connected by longer walks, each of which makes one of as
            # many as it has corners, at most.
            saved = kind_count - drawn
            walks = min(long // 3, long - saved)
            if saved and (walks < 1 or saved >= pairs + odd_kinds):
                continue
            best = max(best, len(loops) + in_pairs + walks - 2 * drawn)
    return best
