"""What can be drawn in a cell with several loops, by trying everything."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import permutations, product


def walks_and_parts(
    loops: Sequence[Sequence[object]], groups: Sequence[Sequence[int]]
) -> tuple[int, int]:
    """Walks round the faces, and connected parts, of a graph of loops and groups.

    Args:
        loops: with one element for each of their darts, which are numbered one after the other.
        groups: the darts of each group in cyclic order; every dart is in one.
    """
    after: dict[int, int] = {}
    loop_of: dict[int, int] = {}
    for number, loop in enumerate(loops):
        darts = range(len(after), len(after) + len(loop))
        after |= {dart: darts[(place + 1) % len(darts)] for place, dart in enumerate(darts)}
        loop_of |= dict.fromkeys(darts, number)
    before = {group[place]: group[place - 1] for group in groups for place in range(len(group))}
    walks, seen = 0, set[int]()
    for dart in after:
        walks += dart not in seen
        while dart not in seen:
            seen.add(dart)
            dart = before[after[dart]]
    parts = {number: {number} for number in range(len(loops))}
    for group in groups:
        whole = set[int]().union(*(parts[loop_of[dart]] for dart in group))
        parts |= dict.fromkeys(whole, whole)
    return walks, len({min(part) for part in parts.values()})


def most_links_drawn(loops: Sequence[Sequence[int]]) -> int:
    """The most links of groups of one color that can be drawn side by side.

    All groupings, with all cyclic orders of each group's darts.

    Args:
        loops: the color of each dart.
    """
    colors = [color for loop in loops for color in loop]
    for groups in sorted(_groupings(colors), key=len):
        for walks, parts in (walks_and_parts(loops, turned) for turned in _orders(groups)):
            if len(loops) + len(groups) - len(colors) + walks == 2 * parts:
                return len(colors) - len(groups)
    raise AssertionError("each dart by itself can always be drawn")


def _groupings(colors: Sequence[int]) -> list[list[list[int]]]:
    found: list[list[list[int]]] = [[]]
    for dart, color in enumerate(colors):
        found = [
            [*groups[:place], [*group, dart], *groups[place + 1 :]]
            for groups in found
            for place, group in enumerate([*groups, []])
            if not group or colors[group[0]] == color
        ]
    return found


def _orders(groups: Sequence[Sequence[int]]) -> Iterator[list[tuple[int, ...]]]:
    each = [[(g[0], *rest) for rest in permutations(g[1:])] for g in groups]
    return (list(chosen) for chosen in product(*each))
