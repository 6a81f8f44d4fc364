"""Lower bounds verified without a solver, from what their certificates say (docs/bounds.md).

The certificate of a ``cover`` or of ``strangers`` names some cells, and the claim is that fewer
color regions than the bound says do not touch all of them. That of ``conflicts`` names, for each
part of the surface, such cells as well, pairs of segments that would have to cross, and tangles of
more of them. The color regions that another color can stand in for are left out before. What
crosses is verified by :mod:`cellcolor.checker.crossing_segments`, what is tangled by
:mod:`cellcolor.checker.tangles`, and then every way to touch the cells is tried by
:mod:`cellcolor.checker.plan_search`, to the end or until the budget is used up.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from pydantic import ConfigDict, NonNegativeInt, TypeAdapter

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.checker.crossing_segments import TwoRegions
from cellcolor.checker.filled_surface import WORK
from cellcolor.checker.hubs import Hubs
from cellcolor.checker.plan_search import (
    BudgetExceeded,
    Conflict,
    PlanSearch,
    Tangle,
    TangledSegment,
)
from cellcolor.checker.tangles import Tangled, cannot_be_drawn, is_connected
from cellcolor.data.bound import Bound
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.files.documents import validate

__all__ = ["BUDGET", "BoundVerdict", "verify_bound"]

BUDGET = 200_000
"""Choices that are tried before a certificate is given up; some seconds."""

Outcome = Literal["verified", "refused", "budget exceeded", "no certificate"]
_NAMED = 20
_STRICT = ConfigDict(extra="forbid", strict=True)


@dataclass(frozen=True, slots=True)
class BoundVerdict:
    """What came of verifying a bound.

    Attributes:
        bound: the bound.
        outcome: ``verified``: it is true. ``refused``: its certificate does not prove it.
            ``budget exceeded``: not known. ``no certificate``: it is taken on trust, or of a kind
            that nothing here can verify.
        reason: why it was refused, a sentence; empty otherwise.
        tried: how many choices were tried.
        budget: how many could have been tried.
    """

    bound: Bound
    outcome: Outcome
    reason: str = ""
    tried: int = 0
    budget: int = BUDGET

    @property
    def trusted(self) -> bool:
        """Nothing here verifies or refutes it: it rests on the solver that found it."""
        return self.outcome in ("no certificate", "budget exceeded")

    def __str__(self) -> str:
        tried = f", {self.tried} of {self.budget} choices tried" if self.tried else ""
        reason = f": {self.reason}" if self.reason else ""
        return f"{self.bound}: {self.outcome}{tried}{reason}"

    def to_document(self) -> dict[str, Any]:
        """The JSON object that ``cellcolor check --json`` has for it."""
        return {
            "kind": self.bound.kind,
            "value": self.bound.value,
            "holds_for": self.bound.holds_for,
            "outcome": self.outcome,
            "reason": self.reason,
            "tried": self.tried,
            "budget": self.budget,
        }


@dataclass(frozen=True, slots=True)
class _Crossing:
    """Two segments that would have to cross.

    Attributes:
        colors: the first segment's color, and the second one's.
        one: two sets of cells of which the first segment touches one each.
        other: the same for the second segment.
    """

    __pydantic_config__ = _STRICT

    colors: tuple[int, int]
    one: tuple[tuple[int, ...], tuple[int, ...]]
    other: tuple[tuple[int, ...], tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class _TangledSegment:
    """What a tangle says of one of its segments.

    Attributes:
        color: its color.
        groups: groups of areas, each a set of cells; it touches a cell of some area of each group.
        avoided: cells of its color region, none of which it touches.
    """

    __pydantic_config__ = _STRICT

    color: int
    groups: tuple[tuple[tuple[int, ...], ...], ...]
    avoided: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class _Tangle:
    """Segments that cannot all be drawn."""

    __pydantic_config__ = _STRICT

    segments: tuple[_TangledSegment, ...]


@dataclass(frozen=True, slots=True)
class _Part:
    """Cells that so many segments at least are needed to touch, and why fewer cannot.

    Attributes:
        value: so many.
        cells: what they are needed to touch.
        conflicts: what two segments cannot do.
        tangles: what one segment or more cannot do.
        hubs: cells that are taken away, to see how many pieces of segments are needed.
    """

    __pydantic_config__ = _STRICT

    value: NonNegativeInt
    cells: tuple[int, ...]
    conflicts: tuple[_Crossing, ...] = ()
    tangles: tuple[_Tangle, ...] = ()
    hubs: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True)
class _Certificate:
    """Of ``conflicts`` and ``hubs``; ``left_out`` has color, a cell of the region, and stand-in."""

    __pydantic_config__ = _STRICT

    parts: tuple[_Part, ...]
    left_out: tuple[tuple[int, int, int], ...] = ()


_CERTIFICATE = TypeAdapter(_Certificate)
_CELLS = TypeAdapter(_Part)


def _few(cells: Iterable[int]) -> str:
    """Cells as a list, which is cut off where nobody would read on."""
    named = sorted(set(cells))
    further = len(named) - _NAMED
    return str(named) if further <= 0 else f"{named[:_NAMED]} and {further} more"


class _Refused(Exception):
    """A certificate does not prove its bound; the text says why."""


def verify_bound(
    instance: Instance,
    bound: Bound,
    regions: Sequence[frozenset[ColorRegion]],
    budget: int = BUDGET,
    deadline: Deadline = NEVER,
) -> BoundVerdict:
    """Verify a lower bound of the number of segments by its certificate.

    Args:
        instance: the topological graph.
        bound: one of a solution of it.
        regions: the color regions that each cell lies in, see
            :mod:`cellcolor.checker.color_regions`.
        budget: how many choices may be tried.
        deadline: when to give up, as if the budget was used up.
    """
    if bound.kind not in ("cover", "strangers", "conflicts", "hubs") or bound.certificate is None:
        return BoundVerdict(bound, "no certificate", budget=budget)
    proof = _Proof(instance, list(regions), budget, deadline)
    try:
        if bound.kind in ("conflicts", "hubs"):
            certificate = validate(_CERTIFICATE, bound.certificate)
            proof.leave_out(certificate.left_out)
            proof.verify(certificate.parts, bound.value)
        else:
            part = validate(_CELLS, {"value": bound.value} | bound.certificate)
            proof.verify((part,), bound.value)
    except BudgetExceeded:
        return BoundVerdict(bound, "budget exceeded", "", proof.tried, budget)
    except (InputError, _Refused) as error:
        return BoundVerdict(bound, "refused", str(error), proof.tried, budget)
    return BoundVerdict(bound, "verified", "", proof.tried, budget)


class _Proof:
    """Verifies the steps of one certificate.

    Attributes:
        tried: choices so far.
    """

    def __init__(
        self,
        instance: Instance,
        regions: list[frozenset[ColorRegion]],
        budget: int,
        deadline: Deadline,
    ) -> None:
        self.tried = 0
        self._instance = instance
        self._regions = regions
        self._budget = budget
        self._deadline = deadline

    def leave_out(self, steps: Sequence[tuple[int, int, int]]) -> None:
        """Leave out color regions that another color can stand in for, one after the other.

        Raises:
            _Refused: it cannot.
        """
        for color, cell, stand_in in steps:
            region = self._region(color, cell)
            cells = self._cells_of(region)
            inside = frozenset(cells)
            for own in cells:
                if not any(other[0] == stand_in for other in self._regions[own]):
                    raise _Refused(f"color {stand_in} cannot stand in for color {color} in {own}")
                for dart in (dart for loop in self._instance.cells[own].loops for dart in loop):
                    joinable = self._instance.joinable(abs(dart))
                    edge = self._instance.edge(abs(dart))
                    within = edge.left in inside and edge.right in inside
                    if within and color in joinable and stand_in not in joinable:
                        text = f"color {stand_in} does not continue across edge {abs(dart)}"
                        raise _Refused(f"{text}, where color {color} does")
            if stand_in == color:
                raise _Refused(f"color {color} cannot stand in for itself")
            for own in cells:
                self._regions[own] -= {region}

    def verify(self, parts: Sequence[_Part], value: int) -> None:
        """Verify that the parts need so many segments together.

        Raises:
            _Refused: they do not.
            BudgetExceeded: too many choices have been tried.
        """
        if sum(part.value for part in parts) < value:
            raise _Refused(f"the parts need fewer than {value} segments")
        used: set[ColorRegion] = set()
        for part in parts:
            demands = {cell: self._regions_of(cell) for cell in part.cells}
            hubs = {cell: self._regions_of(cell) for cell in part.hubs}
            own = frozenset[ColorRegion]().union(*demands.values(), *hubs.values())
            if not used.isdisjoint(own):
                raise _Refused("one color region lies in two parts")
            used |= own
            conflicts = list(self._conflicts(part))
            tangles = [self._tangle(tangle) for tangle in part.tangles]
            pieces = part.value
            if part.hubs:
                demands = self._beside_hubs(part)
                pieces += self._saved(part)
            left = self._budget - self.tried
            search = PlanSearch(demands, conflicts, left, self._deadline, tangles)
            try:
                possible = search.is_possible(pieces - 1)
            finally:
                self.tried += search.tried
            if possible:
                least = f"fewer than {pieces}"
                what = "segments" if part.conflicts or part.tangles else "color regions"
                raise _Refused(f"{least} {what} touch all of the cells {_few(part.cells)}")

    def _beside_hubs(self, part: _Part) -> dict[int, frozenset[ColorRegion]]:
        """The color regions that are left of each cell to be touched when hubs are taken away."""
        if part.conflicts or part.tangles:
            raise _Refused("a part with hubs has conflicts or tangles as well")
        regions = Hubs(self._instance, self._regions, part.hubs).regions()
        for cell in part.cells:
            if not regions[cell]:
                raise _Refused(f"hub {cell} is to be touched")
        return {cell: regions[cell] for cell in part.cells}

    def _saved(self, part: _Part) -> int:
        """The most segments that hubs save, by their links."""
        hubs = Hubs(self._instance, self._regions, part.hubs)
        for hub in part.hubs:
            if problem := hubs.problem(hub):
                raise _Refused(problem)
        return sum(hubs.links(hub, self._count) for hub in sorted(set(part.hubs)))

    def _count(self, choices: int = 1) -> None:
        self.tried += choices
        if self.tried > self._budget or self._deadline.over:
            raise BudgetExceeded

    def _conflicts(self, part: _Part) -> Iterator[Conflict]:
        two_regions: dict[tuple[ColorRegion, ColorRegion], TwoRegions] = {}
        for crossing in part.conflicts:
            if self._deadline.over:
                raise BudgetExceeded
            ends = [frozenset(cells) for cells in (*crossing.one, *crossing.other)]
            if not all(ends):
                raise _Refused("a conflict names no cells")
            first = self._region(crossing.colors[0], min(ends[0]))
            second = self._region(crossing.colors[1], min(ends[2]))
            for cells in ends[:2]:
                self._one_area(cells, first, second)
            for cells in ends[2:]:
                self._one_area(cells, second, first)
            if (first, second) not in two_regions:
                cells_of = frozenset(self._cells_of(first)), frozenset(self._cells_of(second))
                two_regions[first, second] = TwoRegions(
                    self._instance, crossing.colors, cells_of, self._count
                )
            two = two_regions[first, second]
            one, other, far, farther = (min(cells) for cells in ends)
            if not two.must_cross((one, other), (far, farther)):
                text = f"segments that connect cells {one} and {other}, and {far} and {farther}"
                raise _Refused(f"{text}, need not cross")
            yield Conflict((first, second), (ends[0], ends[1], ends[2], ends[3]))

    def _tangle(self, tangle: _Tangle) -> Tangle:
        """A tangle that is verified."""
        found: list[TangledSegment] = []
        drawn: list[Tangled] = []
        for segment in tangle.segments:
            named = [cell for group in segment.groups for area in group for cell in area]
            areas = [area for group in segment.groups for area in group]
            if not areas or not all(segment.groups) or not all(areas):
                raise _Refused("a tangle names no cells")
            region = self._region(segment.color, named[0])
            for cell in (*named, *segment.avoided):
                if region not in self._regions_of(cell):
                    text = f"cell {cell} is not in the color region of cell {named[0]}"
                    raise _Refused(f"{text}, as a tangle says")
            avoided = frozenset(segment.avoided)
            if not avoided.isdisjoint(named):
                raise _Refused("a segment of a tangle avoids what it touches")
            cells = frozenset(self._cells_of(region))
            self._count(1 + (len(cells) + len(named)) // 100)
            groups = tuple(tuple(map(frozenset, group)) for group in segment.groups)
            for area in (area for group in groups for area in group):
                self._connected(area, segment.color)
            whole = tuple(frozenset[int]().union(*group) for group in groups)
            found.append(TangledSegment(region, whole, avoided))
            drawn.append(Tangled(segment.color, cells - avoided, groups))
        if not cannot_be_drawn(self._instance, drawn, self._count):
            named = [min(min(area) for area in s.groups[0]) for s in drawn]
            raise _Refused(f"the segments of a tangle, of cells {_few(named)}, could be drawn")
        return Tangle(tuple(found))

    def _one_area(self, cells: frozenset[int], region: ColorRegion, other: ColorRegion) -> None:
        """Hold cells of one region to be connected in its color, and outside of the other region.

        What touches one of them can then be grown over all of them: the other segment is in none.
        """
        for cell in cells:
            if region not in self._regions_of(cell):
                raise _Refused(f"cell {cell} is not in the color region of cell {min(cells)}")
            if other in self._regions_of(cell):
                raise _Refused(f"cell {cell} is in the color regions of both segments")
        self._connected(cells, region[0])

    def _connected(self, cells: frozenset[int], color: int) -> None:
        """Hold an area to be connected in a color."""
        loops = [loop for cell in cells for loop in self._instance.cells[cell].loops]
        self._count((len(cells) + sum(map(len, loops))) // WORK)
        if not is_connected(self._instance, color, cells):
            raise _Refused(f"the cells {_few(cells)} are not connected in color {color}")

    def _region(self, color: int, cell: int) -> ColorRegion:
        for region in self._regions_of(cell):
            if region[0] == color:
                return region
        raise _Refused(f"color {color} is not available in cell {cell}, or is left out there")

    def _regions_of(self, cell: int) -> frozenset[ColorRegion]:
        if not 0 <= cell < len(self._regions):
            raise _Refused(f"there is no cell {cell}")
        if not self._regions[cell]:
            raise _Refused(f"no color reaches cell {cell}, so that it need not be touched")
        return self._regions[cell]

    def _cells_of(self, region: ColorRegion) -> list[int]:
        return [cell for cell, own in enumerate(self._regions) if region in own]
