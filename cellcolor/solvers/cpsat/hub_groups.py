"""Groupings of a hub's darts with many links (``bounds/hubs`` has the terms).

For a hub with one loop dynamic programming finds the best grouping. A hub with several loops is
first cut open until it has one. A cut begins at a dart of one loop, ends at a dart of another, and
stays in the area of one group, which gets both darts. It makes one loop of the two, which runs
along the cut twice, once on each side, and each side has a part of the group. Only the two
darts matter, not the way between them: the loop that results is the same. So pairs of darts are
chosen at random, and the best of several attempts is kept.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from contextlib import suppress
from itertools import islice, product
from typing import NamedTuple

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.hubs import Group, Grouping, best_grouping

CANDIDATES = 12
"""Pairs of darts that are tried for each cut."""

EFFORT = 600
"""Darts in all attempts together. For most hubs the first attempt is enough."""


def many_links(
    loops: Sequence[Sequence[frozenset[int]]], enough: int, seed: int, deadline: Deadline
) -> Grouping:
    """The grouping with the most links that a few random attempts find.

    Args:
        loops: the colors that each dart can be joined in, loop by loop, in cyclic order.
        enough: no more links are looked for.
        seed: of the attempts.
        deadline: when to return the best so far.

    Raises:
        OutOfTime: the deadline came before the first attempt ended.
    """
    rng = random.Random(seed)
    best = _Attempt(loops, rng, deadline).run()
    with suppress(OutOfTime):
        for _ in range(EFFORT // sum(map(len, loops)) if len(loops) > 1 else 0):
            if best.links >= enough:
                break
            best = max(best, _Attempt(loops, rng, deadline).run(), key=lambda found: found.links)
    return best


class _Cut(NamedTuple):
    """A cut that makes one loop of two.

    It begins and ends at a dart, and both leave the loop. In their place the new loop has two
    elements that stand for the two sides of the cut.

    Attributes:
        near: the element on the one loop where it begins.
        far: the element on the other loop where it ends.
        there: stands for the side along which the new loop goes over to the other loop.
        back: stands for the side along which it comes back.
    """

    near: int
    far: int
    there: int
    back: int


class _Loop(NamedTuple):
    """A loop of the hub, or what several of them became by cuts.

    Attributes:
        elements: darts, and both sides of each cut, in cyclic order.
        cuts: that made it, the last one last.
    """

    elements: list[int]
    cuts: list[_Cut]


class _Attempt:
    """One way to cut a hub open. Elements have numbers: darts first, then the sides of cuts."""

    def __init__(
        self, loops: Sequence[Sequence[frozenset[int]]], rng: random.Random, deadline: Deadline
    ) -> None:
        self._rng = rng
        self._deadline = deadline
        self._colors = [own for loop in loops for own in loop]
        darts = iter(range(len(self._colors)))
        self._loops = [_Loop(list(islice(darts, len(loop))), []) for loop in loops]

    def run(self) -> Grouping:
        """Cut until no two loops have a color in common; the best grouping after that."""
        self._rng.shuffle(self._loops)
        found: list[Group] = []
        while self._loops:
            loop = self._loops.pop()
            for number in self._rng.sample(range(len(self._loops)), len(self._loops)):
                longer = self._cut(loop, self._loops[number])
                if longer is not None:
                    # It comes last, so that the other loops join it one by one.
                    self._loops[number : number + 1] = []
                    self._loops.append(longer)
                    break
            else:
                found += self._best(loop).groups
        return Grouping(tuple(found))

    def _cut(self, loop: _Loop, other: _Loop) -> _Loop | None:
        """One loop of two, by the best of some random cuts; None if they share no color."""
        pairs = [
            (near, far)
            for near, far in product(range(len(loop.elements)), range(len(other.elements)))
            if not self._colors[loop.elements[near]].isdisjoint(self._colors[other.elements[far]])
        ]
        there, back = len(self._colors), len(self._colors) + 1
        most, best, its_color = -1, None, frozenset[int]()
        for near, far in self._rng.sample(pairs, min(CANDIDATES, len(pairs))):
            cut = _Cut(loop.elements[near], other.elements[far], there, back)
            shared = self._colors[cut.near] & self._colors[cut.far]
            color = frozenset({self._rng.choice(sorted(shared))})
            self._colors[there:] = [color, color]
            tried = _Loop(
                [there, *_after(other.elements, far), back, *_after(loop.elements, near)],
                [*other.cuts, *loop.cuts, cut],
            )
            links = self._best(tried).links
            if links > most:
                most, best, its_color = links, tried, color
        if best is not None:
            self._colors[there:] = [its_color, its_color]
        return best

    def _best(self, loop: _Loop) -> Grouping:
        """The best grouping with the last cut's sides in two groups; the cuts are undone."""
        colors = [self._colors[element] for element in loop.elements]
        apart = loop.elements.index(loop.cuts[-1].back) if loop.cuts else None
        groups: dict[int, Group] = {}
        for group in best_grouping(colors, apart, self._deadline).groups:
            own = Group(group.color, tuple(loop.elements[place] for place in group.darts))
            groups |= dict.fromkeys(own.darts, own)
        for cut in reversed(loop.cuts):
            _close(cut, groups)
        return Grouping(tuple(dict.fromkeys(groups.values())))


def _after(loop: Sequence[int], place: int) -> list[int]:
    """The other elements of a cyclic list, from the next one on."""
    return [*loop[place + 1 :], *loop[:place]]


def _close(cut: _Cut, groups: dict[int, Group]) -> None:
    """Undo a cut: its two sides become one group again.

    The border of the group's area meets, in this order, the near end, what the half at the way back
    has, the far end, and what the half at the way there has. If one group is on both sides, it is a
    ring round one of the loops. It is opened at some place, which costs one link.

    Args:
        cut: the last one that is not undone yet.
        groups: the group of each element; changed.
    """
    there, back = groups.pop(cut.there), groups.pop(cut.back)
    after_there = _after(there.darts, there.darts.index(cut.there))
    if there is back:
        at = after_there.index(cut.back)
        after_there, after_back = after_there[:at], after_there[at + 1 :]
    else:
        after_back = _after(back.darts, back.darts.index(cut.back))
    whole = Group(there.color, (cut.near, *after_back, cut.far, *after_there))
    groups |= dict.fromkeys(whole.darts, whole)
