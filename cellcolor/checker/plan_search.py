"""Whether so many segments can touch some cells: every way is tried.

A segment lies in one color region, and touches some of its cells. Two segments that are in
conflict cannot both touch all that the conflict names. Each cell has to be touched by some segment,
so a cell that is not touched yet is given to each segment that can still touch it, and to a new one
in each of its color regions. With no conflicts that is a search for a set cover.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from cellcolor.checker.color_regions import ColorRegion

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
    """More choices than were allowed."""


@dataclass(slots=True)
class _Segment:
    region: ColorRegion
    touched: set[int] = field(default_factory=set)


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
    ) -> None:
        """
        Args:
            regions: the color regions that each cell lies in; these cells have to be touched.
            conflicts: between segments.
            budget: how many choices may be tried.
        """
        self.tried = 0
        self._regions = regions
        self._budget = budget
        self._conflicts: dict[ColorRegion, list[Conflict]] = {}
        for conflict in conflicts:
            for region in set(conflict.regions):
                self._conflicts.setdefault(region, []).append(conflict)

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
        able = {cell: self._able(found, cell) for cell in left}
        if self._need_segments_of_their_own([c for c in left if not able[c]]) > more:
            return False
        opened = {cell: len(self._regions[cell]) if more > 0 else 0 for cell in left}
        cell = min(left, key=lambda cell: (len(able[cell]) + opened[cell], cell))
        rest = left - {cell}
        for segment in able[cell]:
            self._count()
            segment.touched.add(cell)
            possible = self._extends(found, rest, more)
            segment.touched.remove(cell)
            if possible:
                return True
        for region in sorted(self._regions[cell]) if more > 0 else ():
            self._count()
            if self._extends([*found, _Segment(region, {cell})], rest, more - 1):
                return True
        return False

    def _count(self) -> None:
        self.tried += 1
        if self.tried > self._budget:
            raise BudgetExceeded

    def _able(self, found: Sequence[_Segment], cell: int) -> list[_Segment]:
        """The segments that can touch a cell besides what they touch."""
        return [
            segment
            for segment in found
            if segment.region in self._regions[cell] and not self._crosses(found, segment, cell)
        ]

    def _crosses(self, found: Sequence[_Segment], segment: _Segment, cell: int) -> bool:
        """Whether a segment that touches a cell as well would cross another one."""
        touched = segment.touched | {cell}
        for conflict in self._conflicts.get(segment.region, ()):
            first = conflict.regions[0] == segment.region
            own, theirs = conflict.cells[:2], conflict.cells[2:]
            if not first:
                own, theirs = theirs, own
            if any(touched.isdisjoint(end) for end in own):
                continue
            region = conflict.regions[1 if first else 0]
            for another in found:
                connects = not any(another.touched.isdisjoint(end) for end in theirs)
                if another.region == region and connects:
                    return True
        return False

    def _need_segments_of_their_own(self, cells: Sequence[int]) -> int:
        """Of cells that no segment can touch: so many are in different color regions altogether."""
        used: set[ColorRegion] = set()
        count = 0
        for cell in sorted(cells, key=lambda cell: len(self._regions[cell])):
            if used.isdisjoint(self._regions[cell]):
                used |= self._regions[cell]
                count += 1
        return count
