"""Partitions of the points on a circle whose blocks can be drawn without crossing."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import cache

Partitions = Callable[[tuple[object, ...]], tuple[tuple[tuple[int, ...], ...], ...]]
"""Those of points on a circle, whose colors are given."""


@cache
def noncrossing_in(colors: tuple[object, ...]) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """All non-crossing partitions of points on a circle, each block of points of one color."""
    partitions: list[list[list[int]]] = [[]]
    for point, color in enumerate(colors):
        grown = []
        for blocks in partitions:
            grown.append([*blocks, [point]])
            for i, block in enumerate(blocks):
                if colors[block[-1]] == color and not any(
                    block[-1] < other[-1] and any(p < block[-1] for p in other)
                    for other in blocks
                    if other is not block
                ):
                    grown.append([*blocks[:i], [*block, point], *blocks[i + 1 :]])
        partitions = grown
    return tuple(tuple(map(tuple, blocks)) for blocks in partitions)


@cache
def coarsest_in(colors: tuple[object, ...]) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """Those of them in which no two blocks of a color can be united without crossing another.

    United sub-cells of one color are one piece instead of two and join all that both joined, so
    some division with the fewest segments has such partitions only.
    """

    def crosses(one: tuple[int, ...], other: tuple[int, ...]) -> bool:
        gaps = {sum(point < own for own in one) % len(one) for point in other}
        return len(gaps) > 1

    def can_be_united(blocks: tuple[tuple[int, ...], ...]) -> bool:
        return any(
            colors[a[0]] == colors[b[0]]
            and not any(crosses((*a, *b), other) for other in blocks if other not in (a, b))
            for a, b in itertools.combinations(blocks, 2)
        )

    return tuple(blocks for blocks in noncrossing_in(colors) if not can_be_united(blocks))


def noncrossing(size: int) -> tuple[tuple[tuple[int, ...], ...], ...]:
    """All non-crossing partitions of points on a circle: set partitions, crossing ones left out."""
    return noncrossing_in((None,) * size)
