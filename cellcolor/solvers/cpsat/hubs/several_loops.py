"""Groups of darts with many links in a cell with several loops (docs/routes.md, "Hubs").

Let a group have dart a on one loop and dart b on another. A cut from a to b within the group's
area makes one loop of the two, in which a and b stand together in two places: where the walk along
the one loop goes over to the other, and where it comes back. No more is needed to know where a cut
runs, because all cells with so many loops look alike after it. So loops are merged by random pairs
of darts of one color, those with most links after the merger among a few, until there is a single
one, whose best grouping is known.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from contextlib import suppress
from itertools import islice, product
from typing import NamedTuple

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.links import Group, Grouping, best_grouping

CANDIDATES = 12
"""Pairs of darts that are tried for each merger."""

EFFORT = 600
"""Darts in all attempts together. For most hubs the first one is enough."""


class _Merger(NamedTuple):
    """Two darts or places that a cut connects, and the places where they stand together.

    Attributes:
        near: on the one loop.
        far: on the other.
        there: the place where the walk goes from the one loop to the other.
        back: the place where it comes back.
    """

    near: int
    far: int
    there: int
    back: int


def many_links(
    loops: Sequence[Sequence[frozenset[int]]], enough: int, seed: int, deadline: Deadline
) -> Grouping:
    """The grouping with the most links that a few random mergers lead to.

    Args:
        loops: the colors that each dart can be joined in, loop by loop, in cyclic order.
        enough: no more links are looked for.
        seed: of the mergers.
        deadline: when to be content with the best so far.

    Raises:
        OutOfTime: the deadline came before the first attempt ended.
    """
    rng = random.Random(seed)
    best = _Merging(loops, rng, deadline).run()
    with suppress(OutOfTime):
        for _ in range(EFFORT // sum(map(len, loops)) if len(loops) > 1 else 0):
            if best.links >= enough:
                break
            best = max(best, _Merging(loops, rng, deadline).run(), key=lambda found: found.links)
    return best


class _Loop(NamedTuple):
    """A loop of the cell, or what several were merged to.

    Attributes:
        elements: darts, and both places of each merger, in cyclic order.
        mergers: by which it came about, the last one last.
    """

    elements: list[int]
    mergers: list[_Merger]


class _Merging:
    """One attempt."""

    def __init__(
        self, loops: Sequence[Sequence[frozenset[int]]], rng: random.Random, deadline: Deadline
    ) -> None:
        self._rng = rng
        self._deadline = deadline
        self._colors = [own for loop in loops for own in loop]
        darts = iter(range(len(self._colors)))
        self._loops = [_Loop(list(islice(darts, len(loop))), []) for loop in loops]

    def run(self) -> Grouping:
        """Merge loops as long as any two have a color in common; the best grouping after that."""
        self._rng.shuffle(self._loops)
        found: list[Group] = []
        while self._loops:
            loop = self._loops.pop()
            for number in self._rng.sample(range(len(self._loops)), len(self._loops)):
                longer = self._merged(loop, self._loops[number])
                if longer is not None:
                    # It comes last, so that the other loops join it one by one.
                    self._loops[number : number + 1] = []
                    self._loops.append(longer)
                    break
            else:
                found += self._best(loop).groups
        return Grouping(tuple(found))

    def _merged(self, loop: _Loop, other: _Loop) -> _Loop | None:
        """Two loops made one by some pair of darts; None if none have a color in common."""
        pairs = [
            (near, far)
            for near, far in product(range(len(loop.elements)), range(len(other.elements)))
            if not self._colors[loop.elements[near]].isdisjoint(self._colors[other.elements[far]])
        ]
        there, back = len(self._colors), len(self._colors) + 1
        most, best, its_color = -1, None, frozenset[int]()
        for near, far in self._rng.sample(pairs, min(CANDIDATES, len(pairs))):
            merger = _Merger(loop.elements[near], other.elements[far], there, back)
            shared = self._colors[merger.near] & self._colors[merger.far]
            color = frozenset({self._rng.choice(sorted(shared))})
            self._colors[there:] = [color, color]
            tried = _Loop(
                [there, *_after(other.elements, far), back, *_after(loop.elements, near)],
                [*other.mergers, *loop.mergers, merger],
            )
            links = self._best(tried).links
            if links > most:
                most, best, its_color = links, tried, color
        if best is not None:
            self._colors[there:] = [its_color, its_color]
        return best

    def _best(self, loop: _Loop) -> Grouping:
        """A grouping of the darts on a loop in which the last merger's group is no ring."""
        colors = [self._colors[element] for element in loop.elements]
        apart = loop.elements.index(loop.mergers[-1].back) if loop.mergers else None
        groups: dict[int, Group] = {}
        for group in best_grouping(colors, apart, self._deadline).groups:
            own = Group(group.color, tuple(loop.elements[place] for place in group.darts))
            groups |= dict.fromkeys(own.darts, own)
        for merger in reversed(loop.mergers):
            _glue(merger, groups)
        return Grouping(tuple(dict.fromkeys(groups.values())))


def _after(loop: Sequence[int], place: int) -> list[int]:
    """The other elements of a cyclic list, from the next one on."""
    return [*loop[place + 1 :], *loop[:place]]


def _glue(merger: _Merger, groups: dict[int, Group]) -> None:
    """Put two groups together along a cut; ``groups`` has the group of each element.

    In the order of the area's border come the near dart, what the group at the way back has, the
    far dart, and what the group at the way there has. Two groups that are one already are a ring
    round one of the loops. Opened somewhere it is two groups, and there is one link less.
    """
    there, back = groups.pop(merger.there), groups.pop(merger.back)
    at = there.darts.index(merger.there)
    after_there = _after(there.darts, at)
    if there is back:
        at = after_there.index(merger.back)
        after_there, after_back = after_there[:at], after_there[at + 1 :]
    else:
        at = back.darts.index(merger.back)
        after_back = _after(back.darts, at)
    whole = Group(there.color, (merger.near, *after_back, merger.far, *after_there))
    groups |= dict.fromkeys(whole.darts, whole)
