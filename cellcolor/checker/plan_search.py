"""Whether so many segments can touch some cells: every way is tried.

A segment lies in one color region, and touches some of its cells. Two segments that are in
conflict cannot both touch all that the conflict names. Each cell has to be touched by some segment,
so a cell that is not touched yet is given to each segment that can still touch it, and to a new one
in each of its color regions. With no conflicts that is a search for a set cover.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import or_

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.deadline import NEVER, Deadline

__all__ = ["BudgetExceeded", "Conflict", "PlanSearch"]


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


class BudgetExceeded(Exception):
    """More choices than were allowed, or the deadline came first."""


_Ends = tuple[int, int, int, int]
"""Which conflicts have their cells 0, 1, 2 and 3 touched, as the bits of four numbers."""


@dataclass(frozen=True, slots=True)
class _Segment:
    region: ColorRegion
    ends: _Ends = (0, 0, 0, 0)

    @property
    def connects(self) -> tuple[int, int]:
        """The conflicts whose first segment it is by now, and those whose second it is, as bits."""
        return self.ends[0] & self.ends[1], self.ends[2] & self.ends[3]

    def grown(self, more: _Ends) -> _Segment:
        """It with more ends touched."""
        a, b, c, d = self.ends
        return _Segment(self.region, (a | more[0], b | more[1], c | more[2], d | more[3]))


class PlanSearch:
    """Every way to touch some cells with a number of segments.

    Attributes:
        tried: choices so far.
    """

    def __init__(
        self,
        regions: Mapping[int, frozenset[ColorRegion]],
        conflicts: Sequence[Conflict],
        budget: int,
        deadline: Deadline = NEVER,
    ) -> None:
        """
        Args:
            regions: the color regions that each cell lies in; these cells have to be touched.
            conflicts: between segments.
            budget: how many choices may be tried.
            deadline: when to give up.
        """
        self.tried = 0
        self._regions = regions
        self._budget = budget
        self._deadline = deadline
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
        """Whether so many segments can touch all cells.

        Raises:
            BudgetExceeded: too many choices have been tried.
        """
        return self._extends([], set(self._regions), segments)

    def _extends(self, found: list[_Segment], left: set[int], more: int) -> bool:
        """Whether some segments and ``more`` new ones can touch the cells that are left, too."""
        if not left:
            return True
        connected = [segment.connects for segment in found]
        first = reduce(or_, (bits for bits, _ in connected), 0)
        second = reduce(or_, (bits for _, bits in connected), 0)
        able = {cell: self._able(found, (first, second), cell) for cell in left}
        if self._need_segments_of_their_own([c for c in left if not able[c]]) > more:
            return False
        opened = {cell: len(self._regions[cell]) if more > 0 else 0 for cell in left}
        cell = min(left, key=lambda cell: (len(able[cell]) + opened[cell], cell))
        rest = left - {cell}
        for number, grown in able[cell]:
            self._count()
            if self._extends([*found[:number], grown, *found[number + 1 :]], rest, more):
                return True
        for region in sorted(self._regions[cell]) if more > 0 else ():
            self._count()
            opening = _Segment(region, self._ends.get((region, cell), (0, 0, 0, 0)))
            if self._extends([*found, opening], rest, more - 1):
                return True
        return False

    def _count(self) -> None:
        self.tried += 1
        if self.tried > self._budget or self._deadline.over:
            raise BudgetExceeded

    def _able(
        self, found: Sequence[_Segment], connected: tuple[int, int], cell: int
    ) -> list[tuple[int, _Segment]]:
        """The numbers of the segments that can touch a cell too, and each as it is then.

        Args:
            found: the segments.
            connected: the conflicts of which some segment is the first, and the second, as bits.
            cell: the cell.
        """
        able = []
        for number, segment in enumerate(found):
            if segment.region not in self._regions[cell]:
                continue
            more = self._ends.get((segment.region, cell))
            if more is None:
                able.append((number, segment))
                continue
            grown = segment.grown(more)
            # A segment is of one region, so that it never is both segments of a conflict.
            first, second = grown.connects
            if not (first & connected[1] or second & connected[0]):
                able.append((number, grown))
        return able

    def _need_segments_of_their_own(self, cells: Sequence[int]) -> int:
        """Of cells that no segment can touch: so many are in different color regions altogether."""
        used: set[ColorRegion] = set()
        count = 0
        for cell in sorted(cells, key=lambda cell: len(self._regions[cell])):
            if used.isdisjoint(self._regions[cell]):
                used |= self._regions[cell]
                count += 1
        return count
