"""Segments that cannot all be drawn: verified by equations modulo 2.

The proof is in docs/bounds/tangles.md, "The certificate of a tangle". An area is a set of cells
that the segment's color connects; a segment touches it where it touches one of its cells. From
there a curve leads on within the area to its first cell. Where the area lies outside of the domain
of another segment, that one does not meet the rest of this curve.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from cellcolor.checker.filled_surface import WORK, Domain, FilledSurface
from cellcolor.checker.groups import Groups
from cellcolor.data.instance import Instance

Area = frozenset[int]
"""Cells that a segment's color connects."""

_Side = tuple[int, object]
"""An area, by its number, and a wall: on which side of what leads to the area the wall lies."""


@dataclass(frozen=True, slots=True)
class Tangled:
    """A segment that is said not to fit beside others.

    Attributes:
        cells: those of its color region that it does not avoid.
        groups: it touches an area of each.
    """

    color: int
    cells: frozenset[int]
    groups: tuple[tuple[Area, ...], ...]


@dataclass(frozen=True, slots=True)
class _Drawn:
    """A segment with one area chosen of each group, by their numbers, and where it can be."""

    domain: Domain
    areas: tuple[int, ...]


def cannot_be_drawn(
    instance: Instance, segments: Sequence[Tangled], count: Callable[[int], None]
) -> bool:
    """Whether it is proved that segments cannot lie side by side, which needs a sphere.

    ``count`` is called with the amount of work about to be done; it raises if that is too much.
    """
    rooms = list(dict.fromkeys((segment.color, segment.cells) for segment in segments))
    surface = FilledSurface(instance, rooms, count)
    if not surface.is_spheres:
        return False
    finder = _Finder(surface, segments, count)
    for chosen in finder.choices():
        count(1)
        drawn = finder.drawn(chosen)
        if drawn is not None and finder.may_be_drawn(drawn):
            return False
    return True


class _Finder:
    """Holds choices of areas against the equations."""

    def __init__(
        self, surface: FilledSurface, segments: Sequence[Tangled], count: Callable[[int], None]
    ) -> None:
        self._surface = surface
        self._segments = segments
        self._count = count
        self._areas = [area for own in segments for group in own.groups for area in group]
        self._first = [min(area) for area in self._areas]
        self._domains: list[list[Domain]] = [[] for _ in segments]
        self._outside: dict[tuple[int, int], bool] = {}
        self._turns: dict[int, dict[int, int]] = {}
        self._odd: dict[tuple[int, int, int], int] = {}

    def choices(self) -> Iterator[Iterator[int]]:
        """Each choice of one area of each group of each segment, by their numbers."""
        numbers = iter(range(len(self._areas)))
        groups = [
            [next(numbers) for _ in group] for segment in self._segments for group in segment.groups
        ]
        return map(iter, product(*groups))

    def drawn(self, chosen: Iterator[int]) -> list[_Drawn] | None:
        """The segments by a choice of areas; None if one would not be connected."""
        found = []
        for number, segment in enumerate(self._segments):
            areas = tuple(next(chosen) for _ in segment.groups)
            domain = self._domain(number, self._first[areas[0]])
            if any(self._first[area] not in domain.tree for area in areas):
                return None
            found.append(_Drawn(domain, areas))
        return found

    def may_be_drawn(self, drawn: Sequence[_Drawn]) -> bool:
        """Whether the equations modulo 2 have a solution (Gaussian elimination)."""
        numbers: dict[_Side, int] = {}
        reduced: dict[int, tuple[int, bool]] = {}
        for sides, odd in self._equations(drawn):
            row = 0
            for side in sides:
                row ^= 1 << numbers.setdefault(side, len(numbers))
            self._count(len(reduced) // 100)
            while row and row.bit_length() in reduced:
                known, its = reduced[row.bit_length()]
                row, odd = row ^ known, odd ^ its
            if row:
                reduced[row.bit_length()] = row, odd
            elif odd:
                return False
        return True

    def _equations(self, drawn: Sequence[_Drawn]) -> Iterator[tuple[list[_Side], bool]]:
        """Sides whose sum is known, eight at a time, of areas of two segments."""
        for number, (one, two) in enumerate(combinations(drawn, 2), start=1):
            self._count(number % 2)
            own, its = one.domain, two.domain
            near = [area for area in one.areas if self._lies_outside(area, its)]
            far = [area for area in two.areas if self._lies_outside(area, own)]
            self._count(len(near) * len(far) // 10)
            for u, v in ((near[0], area) for area in near[1:]):
                for a, b in ((far[0], area) for area in far[1:]):
                    pairs = list(product((u, v), (a, b)))
                    sides: list[_Side] = []
                    sides += [(area, own.wall[self._first[place]]) for area, place in pairs]
                    sides += [(place, its.wall[self._first[area]]) for area, place in pairs]
                    crossed = self._crossed(own, u, its) ^ self._crossed(own, v, its)
                    yield sides, (crossed >> a ^ crossed >> b) & 1 == 1

    def _lies_outside(self, area: int, domain: Domain) -> bool:
        """Whether no cell of an area is in a domain, so that all of it is in one of its walls."""
        key = area, id(domain)
        if key not in self._outside:
            cells = self._areas[area]
            self._count(len(cells) // WORK)
            outside = self._first[area] in domain.wall and cells.isdisjoint(domain.tree)
            self._outside[key] = outside
        return self._outside[key]

    def _domain(self, segment: int, start: int) -> Domain:
        """Where a segment can be that touches a cell."""
        known = self._domains[segment]
        for domain in known:
            if start in domain.tree:
                return domain
        self._count(1 + len(known) // 100)
        own = self._segments[segment]
        known.append(self._surface.domain(own.color, own.cells, start))
        return known[-1]

    def _crossed(self, own: Domain, area: int, its: Domain) -> int:
        """Which ways in another domain the way to an area crosses oddly, as bits of a number.

        The ways are those in the trees of the domains, to the first cells of areas. Only the sum
        for two ways means anything (``FilledSurface.turns``).
        """
        if id(its) not in self._turns:
            crossed: dict[int, int] = {}
            for number, first in enumerate(self._first):
                if first in its.tree:
                    way = self._surface.way(its, first)
                    self._count(len(way) * (1 + number // 1_000) // WORK)
                    for edge in way:
                        crossed[edge] = crossed.get(edge, 0) | 1 << number
            self._count(self._surface.size * (1 + len(self._first) // 1_000) // WORK)
            self._turns[id(its)] = self._surface.turns(crossed)
        key = id(own), area, id(its)
        if key not in self._odd:
            way = self._surface.way(own, self._first[area])
            self._count(len(way) // WORK)
            odd = 0
            for edge in way:
                odd ^= self._turns[id(its)][edge]
            self._odd[key] = odd
        return self._odd[key]


def is_connected(instance: Instance, color: int, cells: Area) -> bool:
    """Whether a color connects some cells among themselves."""
    together: Groups[int] = Groups()
    for cell in cells:
        together.find(cell)
        for dart in (dart for loop in instance.cells[cell].loops for dart in loop):
            edge = instance.edge(abs(dart))
            if edge.left in cells and edge.right in cells and color in instance.joinable(abs(dart)):
                together.join(edge.left, edge.right)
    return len(together.sets()) == 1
