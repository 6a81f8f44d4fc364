"""Segments that fit two at a time and still cannot all be drawn: lower bounds for any division.

Two segments that do not meet cross evenly, and so do any two ways within them. How often two ways
cross modulo 2 is known but for the sides on which they pass what is in their way. So a plan of
segments gives equations over the field of two elements, with a variable for each of these sides,
and where the equations have no solution the segments cannot all be drawn. The proof is in
docs/bounds.md, "Tangles".
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_cells import MergedCells
from cellcolor.solvers.bounds.polygons import PolygonSurface, spanning_tree

__all__ = ["Tangle", "Tangles", "Touching"]

Touching = tuple[int, tuple[int, ...]]
"""A segment: the number of its color region, and merged cells that it touches."""

MOST_EQUATIONS = 5_000
"""With more of them nothing is concluded from a plan."""

MOST_TANGLES = 20
"""How many are looked for in a plan before the next one is made that heeds them."""

MOST_CHOICES = 60
"""As many choices of merged cells, one of each group, may be held against the equations before a
merged cell is let into a group of a tangle."""


@dataclass(frozen=True, slots=True)
class Tangle:
    """What some segments cannot do side by side, however often cutting paths cross the edges.

    Attributes:
        segments: for each of them the number of its color region, and groups of merged cells. It
            is not possible that each segment touches a merged cell of each of its groups.
    """

    segments: tuple[tuple[int, tuple[frozenset[int], ...]], ...]

    @property
    def groups(self) -> int:
        """How many groups there are altogether."""
        return sum(len(groups) for _, groups in self.segments)


class Tangles:
    """The tangles of segments on one surface.

    Args:
        merged: its cells, merged where nothing separates them in any color.
        regions: its color regions.
    """

    def __init__(self, merged: MergedCells, regions: Sequence[Region]) -> None:
        self._merged = merged
        self._regions = regions
        self._surface = PolygonSurface(merged)
        self._on_a_sphere = self._surface.is_spheres
        self._known: dict[int, _Reached] = {}
        self._odd: dict[tuple[int, int], dict[int, int]] = {}

    def find(self, plan: Sequence[Touching], deadline: Deadline) -> list[Tangle]:
        """Tangles that a plan breaks, none if none is known.

        Of three segments as many as there are, up to a limit, or else one of more segments.

        Args:
            plan: segments.
            deadline: when to stop.

        Raises:
            OutOfTime: the deadline came first.
        """
        if not self._on_a_sphere or self._can_be_drawn(plan, deadline):
            return []
        found: list[Tangle] = []
        for three in combinations(plan, 3):
            deadline.check()
            if not self._can_be_drawn(three, deadline):
                found.append(self._grown(self._fewest(three, deadline), deadline))
                if len(found) == MOST_TANGLES:
                    break
        return found or [self._grown(self._fewest(plan, deadline), deadline)]

    def _can_be_drawn(self, plan: Sequence[Touching], deadline: Deadline) -> bool:
        """Whether the equations of a plan have a solution, or are too many to tell."""
        numbers: dict[tuple[int, int, int], int] = {}
        reduced: dict[int, tuple[int, bool]] = {}
        for count, (sides, odd) in enumerate(self._equations(plan)):
            if count == MOST_EQUATIONS:
                return True
            if count % 100 == 0:
                deadline.check()
            row = 0
            for side in sides:
                row ^= 1 << numbers.setdefault(side, len(numbers))
            while row and row.bit_length() in reduced:
                known, its = reduced[row.bit_length()]
                row, odd = row ^ known, odd ^ its
            if row:
                reduced[row.bit_length()] = row, odd
            elif odd:
                return False
        return True

    def _equations(
        self, plan: Sequence[Touching]
    ) -> Iterator[tuple[tuple[tuple[int, int, int], ...], bool]]:
        """Sides whose sum is known, each of a segment's way to a merged cell and of a wall."""
        for (one, (region, cells)), (two, (other, further)) in combinations(enumerate(plan), 2):
            own, its = self._reached(region), self._reached(other)
            if self._regions[region][0] == self._regions[other][0] or own.apart(its):
                continue
            near = [cell for cell in cells if cell in its.wall]
            far = [cell for cell in further if cell in own.wall]
            odd = self._odd_crossings(region, other)
            for u, v in ((near[0], cell) for cell in near[1:]):
                for a, b in ((far[0], cell) for cell in far[1:]):
                    pairs = list(product((u, v), (a, b)))
                    sides = [(one, cell, own.wall[place]) for cell, place in pairs]
                    sides += [(two, place, its.wall[cell]) for cell, place in pairs]
                    crossings = sum(odd[place] >> own.number[cell] & 1 for cell, place in pairs)
                    yield tuple(sides), crossings % 2 == 1

    def _reached(self, region: int) -> _Reached:
        if region not in self._known:
            self._known[region] = _reached(self._surface, self._regions[region])
        return self._known[region]

    def _odd_crossings(self, region: int, other: int) -> dict[int, int]:
        """For each merged cell of a region its way's odd crossings with those of another region.

        These are the bits of a number, one for each merged cell of the other region, which is the
        first that is given.
        """
        if (region, other) not in self._odd:
            own, its = self._reached(region), self._reached(other)
            crossed: dict[int, int] = {}
            for cell, number in own.number.items():
                while own.tree[cell][0]:
                    edge, cell = own.tree[cell]
                    crossed[edge] = crossed.get(edge, 0) | 1 << number
            turns = self._surface.turns(crossed)
            odd: dict[int, int] = {}
            # A tree's merged cells come in the order in which they are reached.
            for cell, (edge, nearer) in its.tree.items():
                odd[cell] = odd[nearer] ^ turns[edge] if edge else 0
            self._odd[region, other] = odd
        return self._odd[region, other]

    def _fewest(self, plan: Sequence[Touching], deadline: Deadline) -> list[Touching]:
        """Merged cells of a plan that cannot be drawn, none of which can be spared."""
        touched = [(number, cell) for number, (_, cells) in enumerate(plan) for cell in cells]
        step = len(touched)
        while step > 1:
            step = (step + 1) // 2
            place = 0
            while place < len(touched):
                fewer = touched[:place] + touched[place + step :]
                if self._can_be_drawn(_part(plan, fewer), deadline):
                    place += step
                else:
                    touched = fewer
        return [(region, cells) for region, cells in _part(plan, touched) if cells]

    def _grown(self, plan: Sequence[Touching], deadline: Deadline) -> Tangle:
        """The tangle of a plan that cannot be drawn, with as large groups as are found easily."""
        groups = [[[cell] for cell in cells] for _, cells in plan]
        for number, (region, _) in enumerate(plan):
            for group in groups[number]:
                taken = {cell for own in groups[number] for cell in own}
                for cell in sorted(self._reached(region).number.keys() - taken):
                    choices = [
                        [[cell] if own is group else own for own in segment] for segment in groups
                    ]
                    if self._none_can_be_drawn(plan, choices, deadline):
                        group.append(cell)
        return Tangle(
            tuple(
                (region, tuple(frozenset(group) for group in own))
                for (region, _), own in zip(plan, groups, strict=True)
            )
        )

    def _none_can_be_drawn(
        self,
        plan: Sequence[Touching],
        groups: Sequence[Sequence[Sequence[int]]],
        deadline: Deadline,
    ) -> bool:
        """Whether no choice of a merged cell of each group can be drawn."""
        count = 1
        for group in (group for segment in groups for group in segment):
            count *= len(group)
        return count <= MOST_CHOICES and not any(
            self._can_be_drawn(
                [(region, cells) for (region, _), cells in zip(plan, chosen, strict=True)], deadline
            )
            for chosen in product(*(list(product(*segment)) for segment in groups))
        )


def _part(plan: Sequence[Touching], touched: Iterable[tuple[int, int]]) -> list[Touching]:
    """A plan with some of its merged cells only, each given with its segment's place."""
    cells: list[list[int]] = [[] for _ in plan]
    for number, cell in touched:
        cells[number].append(cell)
    return [(region, tuple(own)) for (region, _), own in zip(plan, cells, strict=True)]


@dataclass(frozen=True, slots=True)
class _Reached:
    """What a segment of a color region can reach, and what it cannot.

    Attributes:
        tree: by which edge each merged cell of the region is first reached, and from which one.
        number: of each of these merged cells, from 0.
        wall: of each other merged cell, the component of what the region is not.
    """

    tree: Mapping[int, tuple[int, int]]
    number: Mapping[int, int]
    wall: Mapping[int, int]

    def apart(self, other: _Reached) -> bool:
        """Whether two regions have no merged cell in common."""
        return self.number.keys().isdisjoint(other.number)


def _reached(surface: PolygonSurface, region: Region) -> _Reached:
    color, cells = region
    merged = surface.merged
    own = {merged.merged_cell_of[cell] for cell in cells}
    sides = {
        edge: ends
        for edge, ends in merged.sides.items()
        if color in merged.joinable[edge] and own.issuperset(ends)
    }
    tree = spanning_tree(sides, [min(own)])
    wall = surface.borders()
    for edge in merged.sides:
        if edge not in sides:
            wall.union(edge, surface.before[edge])
    beyond = {cell: loops for cell, loops in merged.loops.items() if loops and cell not in own}
    for loops in beyond.values():
        wall.union(*(dart for loop in loops for dart in loop))
    return _Reached(
        tree,
        {cell: number for number, cell in enumerate(tree)},
        {cell: wall[loops[0][0]] for cell, loops in beyond.items()},
    )
