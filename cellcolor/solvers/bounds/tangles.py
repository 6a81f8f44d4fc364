"""Segments of which any two fit but not all can be drawn: lower bounds for any division.

Two segments that do not meet cross evenly, and so do any two ways within them. How often two ways
cross modulo 2 is known but for the sides on which they pass what is in their way. So a plan of
segments gives equations over the field of two elements, with a variable for each of these sides,
and where the equations have no solution the segments cannot all be drawn. If it is also known what
a segment does not touch, it has less room, and there are more equations. The proof is in
docs/bounds/tangles.md.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import MergedCells, PolygonSurface, spanning_tree
from cellcolor.union_find import UnionFind


@dataclass(frozen=True, slots=True)
class Domain:
    """Where a segment can be: merged cells that its color connects.

    Attributes:
        id: identifies the domain on its surface.
        tree: by which edge each merged cell of the domain is first reached, and from which one.
        number: of each of these merged cells, from 0.
        wall: for each other merged cell, its component outside the domain.
    """

    id: int
    tree: Mapping[int, tuple[int, int]]
    number: Mapping[int, int]
    wall: Mapping[int, int]

    def apart(self, other: Domain) -> bool:
        """Whether two domains have no merged cell in common."""
        return self.number.keys().isdisjoint(other.number)


class Domains:
    """The domains of segments on one surface, and how often ways within them cross.

    Args:
        merged: its cells, merged where nothing separates them in any color.
        regions: each color region as its color and its cells.

    Attributes:
        surface: the merged cells as polygons.
        cells: the merged cells of each color region.
    """

    def __init__(self, merged: MergedCells, regions: Sequence[Region]) -> None:
        self.surface = PolygonSurface(merged)
        self.cells = [frozenset(merged.merged_cell_of[c] for c in cells) for _, cells in regions]
        self._colors = [color for color, _ in regions]
        self._connected: dict[tuple[int, frozenset[int]], dict[int, int]] = {}
        self._known: dict[tuple[int, frozenset[int], int], Domain] = {}
        self._odd: dict[tuple[int, int], dict[int, int]] = {}

    def domain(self, region: int, avoided: frozenset[int], start: int) -> Domain:
        """Where a segment can be.

        Args:
            region: the number of its color region.
            avoided: merged cells that it does not touch.
            start: one that it touches.
        """
        if (region, avoided) not in self._connected:
            self._connected[region, avoided] = self._components(region, avoided)
        connected = self._connected[region, avoided]
        key = region, avoided, connected[start]
        if key not in self._known:
            own = frozenset(c for c, root in connected.items() if root == connected[start])
            self._known[key] = self._domain(region, own)
        return self._known[key]

    def odd_crossings(self, one: Domain, other: Domain) -> dict[int, int]:
        """For each merged cell of a domain its way's odd crossings with those of another domain.

        They are the bits of a number, one for each merged cell of the first domain; the way leads
        to a merged cell of the second.
        """
        if (one.id, other.id) not in self._odd:
            crossed: dict[int, int] = {}
            for cell, number in one.number.items():
                while one.tree[cell][0]:
                    edge, cell = one.tree[cell]
                    crossed[edge] = crossed.get(edge, 0) | 1 << number
            turns = self.surface.turns(crossed)
            odd: dict[int, int] = {}
            # A tree's merged cells come in the order in which they are reached.
            for cell, (edge, nearer) in other.tree.items():
                odd[cell] = odd[nearer] ^ turns[edge] if edge else 0
            self._odd[one.id, other.id] = odd
        return self._odd[one.id, other.id]

    def _sides(self, region: int, own: frozenset[int]) -> dict[int, tuple[int, int]]:
        """The edges between some merged cells that are joinable in a region's color."""
        merged = self.surface.merged
        return {
            edge: ends
            for edge, ends in merged.sides.items()
            if self._colors[region] in merged.joinable[edge] and own.issuperset(ends)
        }

    def _components(self, region: int, avoided: frozenset[int]) -> dict[int, int]:
        """For each merged cell of a region one that stands for all that are connected with it."""
        own = self.cells[region] - avoided
        connected: UnionFind[int] = UnionFind(sorted(own))
        for ends in self._sides(region, own).values():
            connected.union(*ends)
        return {cell: connected[cell] for cell in sorted(own)}

    def _domain(self, region: int, own: frozenset[int]) -> Domain:
        merged = self.surface.merged
        sides = self._sides(region, own)
        tree = spanning_tree(sides, [min(own)])
        wall = self.surface.borders()
        for edge in merged.sides:
            if edge not in sides:
                wall.union(edge, self.surface.before[edge])
        beyond = {cell: loops for cell, loops in merged.loops.items() if loops and cell not in own}
        for loops in beyond.values():
            wall.union(*(dart for loop in loops for dart in loop))
        return Domain(
            len(self._known),
            tree,
            {cell: number for number, cell in enumerate(tree)},
            {cell: wall[loops[0][0]] for cell, loops in beyond.items()},
        )


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


class Tangles:
    """The tangles of segments on one surface.

    Args:
        merged: its cells, merged where nothing separates them in any color.
        regions: its color regions.
    """

    def __init__(self, merged: MergedCells, regions: Sequence[Region]) -> None:
        self._domains = Domains(merged, regions)
        self._on_a_sphere = self._domains.surface.is_spheres

    def find(self, plan: Sequence[Touching], deadline: Deadline) -> list[Tangle]:
        """The tangles that a plan violates; empty if none is known.

        Up to a limit, these are all tangles of two segments; if there are none, those of three; if
        there are none either, one larger tangle.

        Args:
            plan: segments.
            deadline: when to stop.

        Raises:
            OutOfTime: the deadline came first.
        """
        plan = _among_themselves(plan)
        if not self._on_a_sphere or self._can_be_drawn(plan, deadline):
            return []
        found: list[Tangle] = []
        for number in (2, 3):
            for few in combinations(plan, number):
                deadline.check()
                if not self._can_be_drawn(own := _among_themselves(few), deadline):
                    found.append(self._grown(self._fewest(own, deadline), deadline))
                    if len(found) == MOST_TANGLES:
                        return found
            if found:
                return found
        return [self._grown(self._fewest(plan, deadline), deadline)]

    def _can_be_drawn(self, plan: Sequence[Touching], deadline: Deadline) -> bool:
        """Whether the equations of a plan have a solution, or are too many to tell.

        They have none, either, if what a segment avoids parts what it is to touch.
        """
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
            if own.apart(its):
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

    def _fewest(self, plan: Sequence[Touching], deadline: Deadline) -> list[Touching]:
        """What cannot be drawn of a plan: merged cells, touched or avoided, none to be spared.

        At first a merged cell goes from what one segment touches and from what others avoid at
        once, since most that is avoided is so for the sake of the segment that touches it.
        """

        def tangled(touched: _Places, avoided: _Places) -> bool:
            return not self._can_be_drawn(_reduced(plan, touched, avoided), deadline)

        def for_the_sake_of(touched: _Places) -> _Places:
            cells = {cell for _, cell in touched}
            return [place for place in every if place[1] in cells]

        every = [(number, cell) for number, own in enumerate(plan) for cell in sorted(own.avoided)]
        touched: _Places = [(number, c) for number, own in enumerate(plan) for c in own.cells]
        touched = _needed(touched, lambda some: tangled(some, for_the_sake_of(some)))
        avoided = _needed(for_the_sake_of(touched), lambda some: tangled(touched, some))
        touched = _needed(touched, lambda some: tangled(some, avoided))
        return _reduced(plan, touched, avoided)

    def _grown(self, plan: Sequence[Touching], deadline: Deadline) -> Tangle:
        """The tangle of a plan that cannot be drawn, with as large groups as are found easily."""
        groups = [[[cell] for cell in own.cells] for own in plan]
        for number, own in enumerate(plan):
            for group in groups[number]:
                taken = {cell for its in groups[number] for cell in its}
                for cell in sorted(self._domains.cells[own.region] - own.avoided - taken):
                    choices = [
                        [[cell] if its is group else its for its in segment] for segment in groups
                    ]
                    if self._none_can_be_drawn(plan, choices, deadline):
                        group.append(cell)
        return Tangle(
            tuple(
                TangledSegment(own.region, tuple(frozenset(group) for group in its), own.avoided)
                for own, its in zip(plan, groups, strict=True)
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
                [
                    Touching(own.region, cells, own.avoided)
                    for own, cells in zip(plan, chosen, strict=True)
                ],
                deadline,
            )
            for chosen in product(*(list(product(*segment)) for segment in groups))
        )


def _among_themselves(plan: Sequence[Touching]) -> list[Touching]:
    """Some segments, that avoid only what one of them touches."""
    touched = {cell for own in plan for cell in own.cells}
    return [Touching(own.region, own.cells, own.avoided & touched) for own in plan]


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
