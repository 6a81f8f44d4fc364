"""Whether some number of segments is enough to touch some cells: tries everything.

A segment lies in one color region, and touches some of its cells. Two segments that are in
conflict cannot both touch all that the conflict names. Those of a tangle cannot all touch what it
names without touching what it says they avoid, so one of them touches some of that as well. Each
cell has to be touched by some segment, so a cell that is not touched yet is given to each segment
that can still touch it, and to a new one in each of its color regions. With no conflicts that is a
search for a set cover.

Cells that neither color regions nor conflicts connect, not even by way of other cells, are touched
by different segments that do not mind each other. So each such group is searched by itself, and the
numbers add up.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from itertools import product
from operator import or_

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.checker.groups import Groups
from cellcolor.deadline import NEVER, Deadline


@dataclass(frozen=True, slots=True)
class Conflict:
    """What two segments cannot touch side by side.

    Attributes:
        regions: the color regions of the two segments.
        cells: the first segment touches one of ``cells[0]`` and one of ``cells[1]``, the second one
            of ``cells[2]`` and one of ``cells[3]``.
    """

    regions: tuple[ColorRegion, ColorRegion]
    cells: tuple[frozenset[int], frozenset[int], frozenset[int], frozenset[int]]


@dataclass(frozen=True, slots=True)
class TangledSegment:
    """What a tangle says of one of its segments: it touches a cell of each of the groups, and none
    of those to be avoided."""

    region: ColorRegion
    groups: tuple[frozenset[int], ...]
    avoided: frozenset[int]


Tangle = tuple[TangledSegment, ...]
"""Segments that cannot all exist side by side."""


class BudgetExceeded(Exception):
    """More choices than were allowed, or the deadline came first."""


_Ends = tuple[int, int, int, int]
"""Which conflicts have their cells 0, 1, 2 and 3 touched, as the bits of four numbers."""


@dataclass(frozen=True, slots=True)
class _Segment:
    region: ColorRegion
    ends: _Ends = (0, 0, 0, 0)
    places: int = 0

    @property
    def connects(self) -> tuple[int, int]:
        """The conflicts whose first segment it is by now, and those whose second it is, as bits."""
        return self.ends[0] & self.ends[1], self.ends[2] & self.ends[3]

    def grown(self, more: _Ends, places: int) -> _Segment:
        """It with more ends of conflicts touched, and more places of tangles, as bits."""
        a, b, c, d = self.ends
        ends = (a | more[0], b | more[1], c | more[2], d | more[3])
        return _Segment(self.region, ends, self.places | places)


@dataclass(frozen=True, slots=True)
class _Needed:
    """A segment of a tangle: the bits of its groups, the bit of what it avoids, and these cells."""

    region: ColorRegion
    groups: int
    avoided: int
    cells: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class _State:
    """Some segments, the cells left to be touched, and how many further segments there may be."""

    found: tuple[_Segment, ...]
    left: tuple[int, ...]
    more: int


class PlanSearch:
    """Every way to touch some cells with a number of segments; ``tried`` counts choices so far."""

    def __init__(
        self,
        regions: Mapping[int, frozenset[ColorRegion]],
        conflicts: Sequence[Conflict],
        budget: int,
        deadline: Deadline = NEVER,
        tangles: Sequence[Tangle] = (),
    ) -> None:
        """
        Args:
            regions: the color regions that each cell lies in; these cells have to be touched.
            budget: how many choices may be tried.
        """
        self.tried = 0
        self._regions = regions
        self._budget = budget
        self._deadline = deadline
        self._in_conflict = {conflict.regions for conflict in conflicts}
        ends: dict[tuple[ColorRegion, int], list[int]] = {}
        for number, conflict in enumerate(conflicts):
            for end, cells in enumerate(conflict.cells):
                for cell in cells:
                    key = conflict.regions[end // 2], cell
                    ends.setdefault(key, [0, 0, 0, 0])[end] |= 1 << number
        self._ends: dict[tuple[ColorRegion, int], _Ends] = {
            key: (a, b, c, d) for key, (a, b, c, d) in ends.items()
        }
        self._places: dict[tuple[ColorRegion, int], int] = defaultdict(int)
        bits = 0
        self._tangles: list[list[_Needed]] = []
        for tangle in tangles:
            needed = []
            for segment in tangle:
                first = bits
                for cells in (*segment.groups, segment.avoided):
                    for cell in cells:
                        self._places[segment.region, cell] |= 1 << bits
                    bits += 1
                groups = (1 << bits - 1) - (1 << first)
                avoided = tuple(sorted(segment.avoided))
                needed.append(_Needed(segment.region, groups, 1 << bits - 1, avoided))
            self._tangles.append(needed)

    def is_possible(self, segments: int) -> bool:
        """Whether this many segments can touch all cells.

        Raises:
            BudgetExceeded: too many choices have been tried.
        """
        groups = sorted(self._groups(), key=len)
        fewest = [self._need_segments_of_their_own(cells) for cells in groups]
        spare = segments - sum(fewest)
        for cells, number in zip(groups, fewest, strict=True):
            while spare >= 0 and not self._can_touch(cells, number):
                number += 1
                spare -= 1
        return spare >= 0

    def _groups(self) -> list[tuple[int, ...]]:
        """The cells, apart where neither color regions nor conflicts connect them."""
        together: Groups[ColorRegion] = Groups()
        for regions in self._regions.values():
            first, *others = regions
            together.find(first)
            for other in others:
                together.join(first, other)
        for one, other in self._in_conflict:
            together.join(one, other)
        for tangle in self._tangles:
            for needed in tangle:
                together.join(tangle[0].region, needed.region)
        groups: dict[ColorRegion, list[int]] = defaultdict(list)
        for cell in sorted(self._regions):
            groups[together.find(min(self._regions[cell]))].append(cell)
        return [tuple(cells) for cells in groups.values()]

    def _can_touch(self, cells: tuple[int, ...], segments: int) -> bool:
        """Whether this many segments can touch some cells, by depth-first search."""
        trail = [iter([_State((), cells, segments)])]
        while trail:
            state = next(trail[-1], None)
            if state is None:
                trail.pop()
                continue
            if not state.left and self._tangled(state.found) is None:
                return True
            trail.append(self._choices(state))
        return False

    def _choices(self, state: _State) -> Iterator[_State]:
        """Each way to touch one more cell; a state without cells if nothing is left to choose."""
        found, more = state.found, state.more
        tangled = self._tangled(found)
        if tangled is not None:
            return self._untangling(tangled, state)
        able = self._able_to_touch(state)
        # What a segment can touch without being any nearer to a conflict costs nothing.
        left = [c for c in state.left if not any(grown == found[n] for n, grown in able[c])]
        if self._need_segments_of_their_own([c for c in left if not able[c]]) > more:
            return iter(())
        if not left:
            return iter([_State(found, (), more)])
        regions_of = self._regions if more > 0 else dict.fromkeys(left, frozenset[ColorRegion]())
        cell = min(left, key=lambda c: (len(able[c]) + len(regions_of[c]), c))
        rest = tuple([c for c in left if c != cell])
        return self._touching(cell, able[cell], sorted(regions_of[cell]), _State(found, rest, more))

    def _tangled(self, found: Sequence[_Segment]) -> list[tuple[int, _Needed]] | None:
        """Segments that a tangle forbids, each by its number and with what the tangle says."""
        if len(self._tangles) * len(found) > 50:
            self._count(len(self._tangles) * len(found))
        for tangle in self._tangles:
            places = [
                [
                    number
                    for number, segment in enumerate(found)
                    if segment.region == needed.region
                    and segment.places & needed.groups == needed.groups
                    and not segment.places & needed.avoided
                ]
                for needed in tangle
            ]
            for numbers in product(*places):
                if len(set(numbers)) == len(numbers):
                    return list(zip(numbers, tangle, strict=True))
                self._count(1)
        return None

    def _untangling(
        self, tangled: Sequence[tuple[int, _Needed]], state: _State
    ) -> Iterator[_State]:
        """A state for each way in which a segment touches what it would have avoided."""
        found = state.found
        tried: set[tuple[int, _Segment]] = set()
        for number, needed in tangled:
            others = [s.connects for place, s in enumerate(found) if place != number]
            first = reduce(or_, (bits for bits, _ in others), 0)
            second = reduce(or_, (bits for _, bits in others), 0)
            for cell in needed.cells:
                own = needed.region, cell
                more = self._ends.get(own, (0, 0, 0, 0))
                grown = found[number].grown(more, self._places[own])
                if (number, grown) in tried:
                    continue
                tried.add((number, grown))
                self._count(len(state.left))
                if not (grown.connects[0] & second or grown.connects[1] & first):
                    segments = (*found[:number], grown, *found[number + 1 :])
                    yield _State(segments, state.left, state.more)

    def _touching(
        self,
        cell: int,
        able: Sequence[tuple[int, _Segment]],
        regions: Sequence[ColorRegion],
        state: _State,
    ) -> Iterator[_State]:
        """A state with a cell touched: by each segment that is able to, or a new one."""
        found, rest, more = state.found, state.left, state.more
        for number, grown in able:
            self._count(len(rest))
            yield _State((*found[:number], grown, *found[number + 1 :]), rest, more)
        for region in regions:
            self._count(len(rest))
            ends = self._ends.get((region, cell), (0, 0, 0, 0))
            opening = _Segment(region, ends, self._places.get((region, cell), 0))
            yield _State((*found, opening), rest, more - 1)

    def _able_to_touch(self, state: _State) -> dict[int, list[tuple[int, _Segment]]]:
        """For each cell the numbers of the segments that can touch it, and each as it is then."""
        connected = [segment.connects for segment in state.found]
        first = reduce(or_, (bits for bits, _ in connected), 0)
        second = reduce(or_, (bits for _, bits in connected), 0)
        numbers: dict[ColorRegion, list[int]] = defaultdict(list)
        for number, segment in enumerate(state.found):
            numbers[segment.region].append(number)
        found: dict[int, list[tuple[int, _Segment]]] = {}
        for cell in state.left:
            able = []
            for region in self._regions[cell]:
                more = self._ends.get((region, cell))
                places = self._places.get((region, cell), 0)
                for number in numbers.get(region, ()):
                    segment = state.found[number]
                    if more is None and not places:
                        able.append((number, segment))
                        continue
                    grown = segment.grown(more or (0, 0, 0, 0), places)
                    # A segment is of one region, so that it never is both segments of a conflict.
                    if not (grown.connects[0] & second or grown.connects[1] & first):
                        able.append((number, grown))
            found[cell] = sorted(able, key=lambda choice: choice[0])
        return found

    def _count(self, cells: int) -> None:
        """Count a choice among some cells; every fifty cells count as one more choice."""
        self.tried += 1 + cells // 50
        if self.tried > self._budget or self._deadline.over:
            raise BudgetExceeded

    def _need_segments_of_their_own(self, cells: Sequence[int]) -> int:
        """How many of the cells need a segment each: no two of them are in one color region."""
        used: set[ColorRegion] = set()
        count = 0
        for cell in sorted(cells, key=lambda cell: len(self._regions[cell])):
            if used.isdisjoint(self._regions[cell]):
                used |= self._regions[cell]
                count += 1
        return count
