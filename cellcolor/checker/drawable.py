"""Can sub-cells hold these darts of several loops without crossing each other?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import product


def can_be_drawn(loops: Sequence[Sequence[int]]) -> bool:
    """Whether a planar cell can be divided into connected sub-cells that meet its loops like this.

    Sub-cells that are met once, or on both sides of nothing else, are drawn at once. If two loops
    are left that one sub-cell meets, the cell is cut open along a path in this sub-cell from the
    one to the other, which makes one loop of them. The sub-cell is then in two parts, and each of
    its other darts belongs to either: both are tried.

    Args:
        loops: for each loop of the cell the sub-cells of its darts in state 1, in cyclic order.
    """
    trail = [iter([[list(loop) for loop in loops]])]
    while trail:
        rest = next(trail[-1], None)
        if rest is None:
            trail.pop()
        elif rest := _reduced(rest):
            trail.append(_cut_open(rest))
        else:
            return True
    return False


def _cut_open(rest: list[list[int]]) -> Iterator[list[list[int]]]:
    """The loops with one less, for each way to part a sub-cell's darts; none if there is none."""
    where = {(label, number) for number, loop in enumerate(rest) for label in loop}
    on_loops = Counter(label for label, _ in where)
    shared = next((label for label, count in on_loops.items() if count > 1), None)
    if shared is None:
        return  # sub-cells that interleave on one loop
    one, other, *more = sorted(rest, key=lambda loop: shared not in loop)
    left, right = max(on_loops) + 1, max(on_loops) + 2
    merged = [left, *_after(one, shared), right, *_after(other, shared)]
    count = sum(loop.count(shared) for loop in [merged, *more])
    for chosen in product((left, right), repeat=count):
        sides = iter(chosen)
        yield [
            [next(sides) if label == shared else label for label in loop]
            for loop in [merged, *more]
        ]


def _after(loop: list[int], label: int) -> list[int]:
    """A loop without one dart of a sub-cell, from there on."""
    place = loop.index(label)
    return loop[place + 1 :] + loop[:place]


def _reduced(loops: list[list[int]]) -> list[list[int]]:
    """Without what can be drawn in any case, until nothing changes.

    Darts of one sub-cell that follow each other on a loop count as one. A sub-cell that has only
    one dart then, and a loop with only one sub-cell, are in nobody's way.
    """
    while True:
        merged = [
            [
                label
                for place, label in enumerate(loop)
                if len(loop) == 1 or label != loop[place - 1]
            ]
            or loop[:1]
            for loop in loops
        ]
        counts = Counter(label for loop in merged for label in loop)
        kept = [[label for label in loop if counts[label] > 1] for loop in merged]
        kept = [loop for loop in kept if len(loop) > 1]
        if kept == loops:
            return kept
        loops = kept
