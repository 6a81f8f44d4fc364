"""Segments that cannot all be drawn although any two can: lower bounds for any division.

Two segments that do not meet cross evenly, and so do any two ways within them. How often two ways
cross modulo 2 is known but for the sides on which they pass what is in their way. So a plan of
segments gives equations over the field of two elements, with a variable for each of these sides,
and where the equations have no solution the segments cannot all be drawn. If it is also known what
a segment does not touch, it has less room, and there are more equations. The proof is in
docs/bounds/tangles.md.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import prod

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.domains import Domain, Domains
from cellcolor.solvers.bounds.merged_surface import MergedCells, merge_further

MOST_EQUATIONS = 5_000
"""With more of them nothing is concluded from a plan."""

MOST_TANGLES = 20
"""How many are looked for in a plan before the next one is made that heeds them."""

MOST_CHOICES = 60
"""How many choices of merged cells, one of each group, may be tested with the equations before a
merged cell is let into a group of a tangle."""

_Places = Sequence[tuple[int, int]]
"""Merged cells, each with the place of a segment in a plan."""


@dataclass(frozen=True, slots=True)
class Touching:
    """A segment of a plan.

    Attributes:
        region: the number of its color region.
        cells: merged cells that it touches.
        avoided: merged cells of its color region that another segment touches and this one
            does not.
    """

    region: int
    cells: tuple[int, ...]
    avoided: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class TangledSegment:
    """What a tangle says of one of its segments.

    Attributes:
        region: the number of its color region.
        groups: groups of merged cells; it has to touch one cell of each group.
        avoided: merged cells of its color region; it must touch none of them.
    """

    region: int
    groups: tuple[frozenset[int], ...]
    avoided: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class Tangle:
    """Segments that cannot all be drawn, however often cutting paths cross the edges.

    Attributes:
        segments: it is not possible that each of them touches a merged cell of each of its groups,
            and none of those to be avoided.
    """

    segments: tuple[TangledSegment, ...]

    @property
    def size(self) -> int:
        """How many groups and avoided merged cells there are altogether."""
        return sum(len(own.groups) + len(own.avoided) for own in self.segments)


class _Surface:
    """The surface as some segments see it: cells merged where their colors have no border.

    What is merged and what is not makes no difference to the equations (docs/bounds/tangles.md,
    "Few cells"), and there are far fewer cells than with all colors.

    Args:
        merged: the cells, under names of their own.
        parts: what each of them consists of.
        regions: color regions by their numbers, those of the segments among them.
        plan: the segments.
        apart: cells with different values here are not merged.

    Attributes are the same after merging.
    """

    def __init__(
        self,
        merged: MergedCells,
        parts: Mapping[int, frozenset[int]],
        regions: Mapping[int, Region],
        plan: Sequence[Touching],
        apart: Mapping[int, Hashable],
    ) -> None:
        colors: dict[int, set[int]] = {}
        used = sorted({own.region for own in plan})
        for number in used:
            color, cells = regions[number]
            for cell in cells:
                colors.setdefault(cell, set()).add(color)
        own_colors = {cell: frozenset(colors[cell]) for cell in sorted(colors)}
        self.merged = merge_further(merged, own_colors, apart)
        of = self.merged.merged_cell_of
        self.parts = {
            name: frozenset[int]().union(*(parts[cell] for cell in cells))
            for name, cells in self.merged.cells().items()
        }
        self.regions: dict[int, Region] = {
            number: (regions[number][0], frozenset(of[cell] for cell in regions[number][1]))
            for number in used
        }
        self.plan = [
            Touching(
                own.region,
                tuple(dict.fromkeys(of[cell] for cell in own.cells)),
                frozenset(of[cell] for cell in own.avoided),
            )
            for own in plan
        ]
        self._domains = Domains(self.merged, self.regions)
        self._on_a_sphere = self._domains.surface.is_spheres

    def seen_by(self, plan: Sequence[Touching], apart: Mapping[int, Hashable]) -> _Surface:
        """The same as fewer segments see it."""
        return _Surface(self.merged, self.parts, self.regions, plan, apart)

    def in_parts(self, plan: Sequence[Touching]) -> list[Touching]:
        """A plan in parts of merged cells: one of each that is touched, all that are avoided."""
        return [
            Touching(
                own.region,
                tuple(min(self.parts[cell]) for cell in own.cells),
                frozenset(part for cell in own.avoided for part in self.parts[cell]),
            )
            for own in plan
        ]

    def can_be_drawn(self, plan: Sequence[Touching], deadline: Deadline) -> bool:
        """Whether the equations of a plan have a solution, or are too many to tell.

        They have none, either, if what a segment avoids parts what it is to touch. On surfaces with
        handles nothing is concluded.
        """
        if not self._on_a_sphere:
            return True
        domains = [self._domains.domain(s.region, s.avoided, s.cells[0]) for s in plan]
        if any(
            cell not in its.number
            for own, its in zip(plan, domains, strict=True)
            for cell in own.cells
        ):
            return False
        numbers: dict[tuple[int, int, int], int] = {}
        reduced: dict[int, tuple[int, bool]] = {}
        for count, (sides, odd) in enumerate(self._equations(plan, domains)):
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
        self, plan: Sequence[Touching], domains: Sequence[Domain]
    ) -> Iterator[tuple[tuple[tuple[int, int, int], ...], bool]]:
        """Sides whose sum is known, each of a segment's way to a merged cell and of a wall."""
        for one, two in combinations(range(len(plan)), 2):
            own, its = domains[one], domains[two]
            if own.number.keys().isdisjoint(its.number):
                continue
            near = [cell for cell in plan[one].cells if cell in its.wall]
            far = [cell for cell in plan[two].cells if cell in own.wall]
            if len(near) < 2 or len(far) < 2:
                continue
            odd = self._domains.odd_crossings(own, its)
            for u, v in ((near[0], cell) for cell in near[1:]):
                for a, b in ((far[0], cell) for cell in far[1:]):
                    pairs = list(product((u, v), (a, b)))
                    sides = [(one, cell, own.wall[place]) for cell, place in pairs]
                    sides += [(two, place, its.wall[cell]) for cell, place in pairs]
                    crossings = sum(odd[place] >> own.number[cell] & 1 for cell, place in pairs)
                    yield tuple(sides), crossings % 2 == 1

    def fewest(self, deadline: Deadline) -> list[Touching]:
        """What cannot be drawn of the plan: merged cells, touched or avoided, none to be spared."""
        plan = self.plan

        def tangled(touched: _Places, avoided: _Places) -> bool:
            return not self.can_be_drawn(_reduced(plan, touched, avoided), deadline)

        touched: _Places = [(number, c) for number, own in enumerate(plan) for c in own.cells]
        avoided: _Places = [(n, c) for n, own in enumerate(plan) for c in sorted(own.avoided)]
        touched = _needed(touched, lambda some: tangled(some, avoided))
        avoided = _needed(avoided, lambda some: tangled(touched, some))
        return _reduced(plan, touched, avoided)

    def grown(self, deadline: Deadline) -> Tangle:
        """The tangle of the plan, which cannot be drawn, with groups as large as easily found."""
        plan = self.plan
        groups = [[[cell] for cell in own.cells] for own in plan]
        for number, own in enumerate(plan):
            for group in groups[number]:
                taken = {cell for its in groups[number] for cell in its}
                for cell in sorted(self.regions[own.region][1] - own.avoided - taken):
                    choices = [
                        [[cell] if its is group else its for its in segment] for segment in groups
                    ]
                    if self._none_can_be_drawn(choices, deadline):
                        group.append(cell)

        def in_parts(cells: Iterable[int]) -> frozenset[int]:
            return frozenset[int]().union(*(self.parts[cell] for cell in cells))

        return Tangle(
            tuple(
                TangledSegment(own.region, tuple(map(in_parts, its)), in_parts(own.avoided))
                for own, its in zip(plan, groups, strict=True)
            )
        )

    def _none_can_be_drawn(
        self, groups: Sequence[Sequence[Sequence[int]]], deadline: Deadline
    ) -> bool:
        """Whether no choice of a merged cell of each group can be drawn."""
        count = prod(len(group) for segment in groups for group in segment)
        return count <= MOST_CHOICES and not any(
            self.can_be_drawn(
                [
                    Touching(own.region, cells, own.avoided)
                    for own, cells in zip(self.plan, chosen, strict=True)
                ],
                deadline,
            )
            for chosen in product(*(list(product(*segment)) for segment in groups))
        )


class Tangles:
    """The tangles of segments on one surface.

    Args:
        merged: its cells, merged where nothing separates them in any color.
        regions: its color regions.
    """

    def __init__(self, merged: MergedCells, regions: Sequence[Region]) -> None:
        self._merged = MergedCells(
            merged.loops, merged.sides, merged.joinable, {cell: cell for cell in merged.loops}
        )
        self._parts = {cell: frozenset((cell,)) for cell in merged.loops}
        self._regions = {
            number: (color, frozenset(merged.merged_cell_of[cell] for cell in cells))
            for number, (color, cells) in enumerate(regions)
        }

    def find(self, plan: Sequence[Touching], deadline: Deadline) -> list[Tangle]:
        """The tangles that a plan violates; empty if none is known.

        Up to a limit, these are all tangles of two segments; if there are none, those of three; if
        there are none either, one larger tangle.
        """
        plan = _among_themselves(plan)
        whole = self._seen_by(plan, _signs(plan))
        if whole.can_be_drawn(whole.plan, deadline):
            return []
        found: list[Tangle] = []
        for number in (2, 3):
            for few in combinations(whole.plan, number):
                deadline.check()
                own = _among_themselves(few)
                near = whole.seen_by(own, _signs(own))
                if not near.can_be_drawn(near.plan, deadline):
                    found.append(self._tangle(near, deadline))
                    if len(found) == MOST_TANGLES:
                        return found
            if found:
                return found
        return [self._tangle(whole, deadline)]

    def _tangle(self, near: _Surface, deadline: Deadline) -> Tangle:
        """One of a plan that cannot be drawn: small, then with large groups."""
        plan = near.in_parts(near.fewest(deadline))
        # What is avoided was merged as the whole plan has it, and a part of it may be enough.
        close = self._seen_by(plan, _each(plan))
        plan = close.fewest(deadline)
        return close.seen_by(plan, _each(plan)).grown(deadline)

    def _seen_by(self, plan: Sequence[Touching], apart: Mapping[int, Hashable]) -> _Surface:
        return _Surface(self._merged, self._parts, self._regions, plan, apart)


def _among_themselves(plan: Sequence[Touching]) -> list[Touching]:
    """Some segments, that avoid only what one of them touches."""
    touched = {cell for own in plan for cell in own.cells}
    return [Touching(own.region, own.cells, own.avoided & touched) for own in plan]


def _signs(plan: Sequence[Touching]) -> dict[int, Hashable]:
    """For each cell that a plan names which segments touch it, and which avoid it."""
    signs: dict[int, list[tuple[int, bool]]] = {}
    for number, own in enumerate(plan):
        for cell in own.cells:
            signs.setdefault(cell, []).append((number, True))
        for cell in own.avoided:
            signs.setdefault(cell, []).append((number, False))
    return {cell: tuple(its) for cell, its in signs.items()}


def _each(plan: Sequence[Touching]) -> dict[int, Hashable]:
    """For each cell that segments of a plan avoid a value of its own."""
    return {cell: cell for own in plan for cell in own.avoided}


def _reduced(plan: Sequence[Touching], touched: _Places, avoided: _Places) -> list[Touching]:
    """A plan with some of its merged cells only, and without segments that touch none of these."""
    return [
        Touching(own.region, cells, frozenset(cell for place, cell in avoided if place == number))
        for number, own in enumerate(plan)
        if (cells := tuple(cell for place, cell in touched if place == number))
    ]


def _needed(places: _Places, holds: Callable[[_Places], bool]) -> _Places:
    """As few merged cells as are found easily for which something holds, as it does for all."""
    step = len(places)
    while step:
        place = 0
        while place < len(places):
            fewer = [*places[:place], *places[place + step :]]
            if holds(fewer):
                places = fewer
            else:
                place += step
        step = (step + 1) // 2 if step > 1 else 0
    return places
