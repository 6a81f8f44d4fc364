"""Whether some number of segments is enough to touch some cells: tries everything.

A segment lies in one color region. Two segments in conflict cannot both touch all that the conflict
names. A cell that is not touched yet is given to each segment that can still touch it, and to a new
one in each of its color regions. With no conflicts that is a search for a set cover.

Cells that neither color regions nor conflicts connect, not even by way of other cells, are searched
by themselves, and the numbers add up.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_

from cellcolor.checker.groups import ColorRegion, Groups


@dataclass(frozen=True, slots=True)
class Conflict:
    """What two segments, in two color regions, cannot touch side by side.

    Attributes:
        cells: the first segment touches one of ``cells[0]`` and one of ``cells[1]``, the second one
            of ``cells[2]`` and one of ``cells[3]``.
    """

    regions: tuple[ColorRegion, ColorRegion]
    cells: tuple[frozenset[int], frozenset[int], frozenset[int], frozenset[int]]


_Ends = tuple[int, int, int, int]
"""Which conflicts have their cells 0, 1, 2 and 3 touched, as the bits of four numbers."""


@dataclass(frozen=True, slots=True)
class _Segment:
    region: ColorRegion
    ends: _Ends

    @property
    def connects(self) -> tuple[int, int]:
        """The conflicts whose first segment it is by now, and those whose second it is, as bits."""
        return self.ends[0] & self.ends[1], self.ends[2] & self.ends[3]

    def grown(self, more: _Ends) -> _Segment:
        """It with more ends of conflicts touched."""
        (a, b, c, d), (e, f, g, h) = self.ends, more
        return _Segment(self.region, (a | e, b | f, c | g, d | h))


@dataclass(frozen=True, slots=True)
class _State:
    """Some segments, the cells left to be touched, and how many further segments there may be."""

    found: tuple[_Segment, ...]
    left: tuple[int, ...]
    more: int


class PlanSearch:
    """Every way to touch some cells with a number of segments.

    Args:
        regions: the color regions that each cell lies in; these cells have to be touched.
        count: called with the number of choices about to be tried; raises if these are too many.
    """

    def __init__(
        self,
        regions: Mapping[int, frozenset[ColorRegion]],
        conflicts: Sequence[Conflict],
        count: Callable[[int], None],
    ) -> None:
        self._regions = regions
        self._conflicts = conflicts
        self._count = count
        ends: dict[tuple[ColorRegion, int], list[int]] = {}
        for number, conflict in enumerate(conflicts):
            for end, cells in enumerate(conflict.cells):
                for cell in cells:
                    key = conflict.regions[end // 2], cell
                    ends.setdefault(key, [0, 0, 0, 0])[end] |= 1 << number
        self._ends: dict[tuple[ColorRegion, int], _Ends] = {
            key: (a, b, c, d) for key, (a, b, c, d) in ends.items()
        }

    def is_possible(self, segments: int) -> bool:
        """Whether this many segments can touch all cells."""
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
        for first, *others in self._regions.values():
            for other in others:
                together.join(first, other)
        for conflict in self._conflicts:
            together.join(*conflict.regions)
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
            elif state.left:
                trail.append(self._choices(state))
            else:
                return True
        return False

    def _choices(self, state: _State) -> Iterator[_State]:
        """Each way to touch one more cell; a state without cells if nothing is left to choose."""
        found, more = state.found, state.more
        able = self._able_to_touch(state)
        # What a segment can touch without being any nearer to a conflict costs nothing.
        left = [c for c in state.left if not any(grown == found[n] for n, grown in able[c])]
        if self._need_segments_of_their_own([c for c in left if not able[c]]) > more:
            return
        if not left:
            yield _State(found, (), more)
            return
        regions_of = self._regions if more > 0 else dict.fromkeys(left, frozenset[ColorRegion]())
        cell = min(left, key=lambda c: (len(able[c]) + len(regions_of[c]), c))
        rest = tuple([c for c in left if c != cell])
        # Every fifty cells count as one more choice.
        choices = 1 + len(rest) // 50
        for number, grown in able[cell]:
            self._count(choices)
            yield _State((*found[:number], grown, *found[number + 1 :]), rest, more)
        for region in sorted(regions_of[cell]):
            self._count(choices)
            opening = _Segment(region, self._ends.get((region, cell), (0, 0, 0, 0)))
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
                for number in numbers.get(region, ()):
                    segment = state.found[number]
                    grown = segment if more is None else segment.grown(more)
                    # A segment is of one region, so that it never is both segments of a conflict.
                    if more is None or not (
                        grown.connects[0] & second or grown.connects[1] & first
                    ):
                        able.append((number, grown))
            found[cell] = sorted(able, key=lambda choice: choice[0])
        return found

    def _need_segments_of_their_own(self, cells: Sequence[int]) -> int:
        """How many of the cells need a segment each: no two of them are in one color region."""
        used: set[ColorRegion] = set()
        count = 0
        for cell in sorted(cells, key=lambda cell: len(self._regions[cell])):
            if used.isdisjoint(self._regions[cell]):
                used |= self._regions[cell]
                count += 1
        return count
