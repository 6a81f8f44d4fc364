"""Segments that cannot all be drawn: verified by equations modulo 2 (docs/bounds.md, "Tangles").

A segment touches an area where it touches one of its cells. An area is connected in the segment's
color. So from wherever the segment touches it a curve leads on within the area to its first cell. A
pair of segments gives equations for areas of the one that lie wholly outside of the other's domain;
there the other segment cannot cross the rest of that curve.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from cellcolor.checker.filled_surface import Domain, FilledSurface
from cellcolor.checker.groups import Groups
from cellcolor.data.instance import Instance

__all__ = ["Area", "Tangled", "cannot_be_drawn", "is_connected"]

Area = frozenset[int]
"""Cells that a segment's color connects."""

WORK = 2_000
"""Darts that are walked over for what counts as one choice."""


@dataclass(frozen=True, slots=True)
class Tangled:
    """A segment that is said not to fit beside others.

    Attributes:
        color: its color.
        cells: those of its color region that it does not avoid.
        groups: it touches an area of each.
    """

    color: int
    cells: frozenset[int]
    groups: tuple[tuple[Area, ...], ...]


@dataclass(frozen=True, slots=True)
class _Drawn:
    """A segment with one area chosen of each group, and where it can be."""

    domain: Domain
    areas: tuple[Area, ...]


def cannot_be_drawn(
    instance: Instance,
    surface_cells: frozenset[int],
    segments: Sequence[Tangled],
    count: Callable[[int], None],
) -> bool:
    """Whether it is proved that segments cannot lie side by side.

    Args:
        instance: the topological graph.
        surface_cells: those of all the segments' color regions.
        segments: that touch an area of each of their groups.
        count: is told how much work is about to be done; raises if that is too much.
    """
    surface = FilledSurface(instance, surface_cells)
    count(1 + surface.size // WORK)
    if not surface.is_spheres:
        return False
    finder = _Finder(surface, segments, count)
    sizes = [len(segment.groups) for segment in segments]
    for chosen in product(*(group for segment in segments for group in segment.groups)):
        count(1)
        areas = iter(chosen)
        own = [tuple(next(areas) for _ in range(size)) for size in sizes]
        drawn = finder.drawn(own)
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
        self._domains: dict[tuple[int, frozenset[int], int], Domain] = {}
        starts = [min(a) for s in segments for group in s.groups for a in group]
        self._number = {start: number for number, start in enumerate(dict.fromkeys(starts))}
        self._turns: dict[int, dict[int, int]] = {}
        self._odd: dict[tuple[int, int, int], int] = {}

    def drawn(self, chosen: Sequence[tuple[Area, ...]]) -> list[_Drawn] | None:
        """The segments by a choice of areas; None if one would not be connected."""
        found = []
        for segment, areas in zip(self._segments, chosen, strict=True):
            domain = self._domain(segment, min(areas[0]))
            if any(min(area) not in domain.tree for area in areas):
                return None
            found.append(_Drawn(domain, areas))
        return found

    def may_be_drawn(self, drawn: Sequence[_Drawn]) -> bool:
        """Whether the equations have a solution."""
        numbers: dict[tuple[int, int, object], int] = {}
        reduced: dict[int, tuple[int, bool]] = {}
        for sides, odd in self._equations(drawn):
            row = 0
            for side in sides:
                row ^= 1 << numbers.setdefault(side, len(numbers))
            self._count(1 if len(numbers) > 50 else 0)
            while row and row.bit_length() in reduced:
                known, its = reduced[row.bit_length()]
                row, odd = row ^ known, odd ^ its
            if row:
                reduced[row.bit_length()] = row, odd
            elif odd:
                return False
        return True

    def _equations(
        self, drawn: Sequence[_Drawn]
    ) -> Iterator[tuple[list[tuple[int, int, object]], bool]]:
        """Sides whose sum is known, each of a segment, one of its areas, and a wall."""
        for one, two in combinations(range(len(drawn)), 2):
            own, its = drawn[one].domain, drawn[two].domain
            self._count(0)
            near = [
                min(a) for a in drawn[one].areas if a.isdisjoint(its.tree) and min(a) in its.wall
            ]
            far = [
                min(a) for a in drawn[two].areas if a.isdisjoint(own.tree) and min(a) in own.wall
            ]
            for u, v in ((near[0], cell) for cell in near[1:]):
                for a, b in ((far[0], cell) for cell in far[1:]):
                    pairs = list(product((u, v), (a, b)))
                    sides: list[tuple[int, int, object]] = []
                    sides += [(one, cell, own.wall[place]) for cell, place in pairs]
                    sides += [(two, place, its.wall[cell]) for cell, place in pairs]
                    crossed = self._crossed(own, u, its) ^ self._crossed(own, v, its)
                    odd = (crossed >> self._number[a] ^ crossed >> self._number[b]) & 1
                    yield sides, odd == 1

    def _domain(self, segment: Tangled, start: int) -> Domain:
        key = segment.color, segment.cells, start
        if key not in self._domains:
            self._count(1 + self._surface.size // WORK)
            # What a color connects is one domain, whichever of its cells comes first.
            known = (
                domain
                for (color, cells, _), domain in self._domains.items()
                if color == segment.color and start in domain.tree and cells == segment.cells
            )
            self._domains[key] = next(known, None) or self._surface.domain(
                segment.color, segment.cells, start
            )
        return self._domains[key]

    def _crossed(self, own: Domain, cell: int, its: Domain) -> int:
        """Which ways in another domain the way to a cell crosses oddly, as bits of a number."""
        if id(its) not in self._turns:
            self._count(1 + self._surface.size * (1 + len(self._number) // 64) // WORK)
            crossed: dict[int, int] = {}
            for start, number in self._number.items():
                if start in its.tree:
                    way = self._surface.way(its, start)
                    self._count(len(way) // WORK)
                    for edge in way:
                        crossed[edge] = crossed.get(edge, 0) | 1 << number
            self._turns[id(its)] = self._surface.turns(crossed)
        key = id(own), cell, id(its)
        if key not in self._odd:
            way = self._surface.way(own, cell)
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
