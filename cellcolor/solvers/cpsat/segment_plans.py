"""Segment plans: how many segments each color region gets, and which cells each of them touches.

A plan is a relaxation of a division: it respects only the pairs of segments that are known to be
unable to pass each other (``conflicts``). So if there is no plan with n segments, no division of
the surface has n segments (docs/bounds.md, "Segment plans"). A plan takes milliseconds where the
model takes seconds. Terms:

- A **merged cell** consists of cells that nothing separates in any color (``merged_surface``).
- A **separation** of two color regions: if a segment of the one region touches both ``ends``, no
  segment of the other region touches merged cells of two of the ``groups``.
- Merged cells of a region are of one **kind** if the same separations name them in the same places.
  A segment that touches one may touch all of them, so the model has one literal for each kind. What
  no separation names any segment of the region may touch.
- A region gets several **copies**, of which the plan uses as many as it has segments there. If it
  may have more segments than copies, nothing is asked of a plan that has: such a region touches all
  its merged cells, and no separation counts there.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import combinations, product

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.conflicts import RegionPair, Separation, Side
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.solvers.interruptible import Solve

SegmentPlan = tuple[tuple[Region, frozenset[int]], ...]
"""Each segment's color region, and the cells that it is to touch; each cell is given to one."""

MOST_LITERALS = 100_000
"""The most literals of a model, one for each copy and kind; beyond that the planner gives up."""

MOST_SEPARATED = 200_000
"""The most literals in the constraints of separations. Around a cell with many leaf cells (cells
with a single live dart) nearly all pairs of segments separate each other, and there the model has
better bounds."""

MOST_SEPARATIONS = 200
"""The most separations to find in one plan; then a plan is made that respects them."""

MOST_STARTS = 5
"""Curves are drawn from one merged cell of a segment to its others. If they show no crossing, they
are drawn from this many of its merged cells."""

_Named = tuple[int, frozenset[int]]
"""The number of a color region, and some of its merged cells."""

_Copy = tuple[int, int]
"""The number of a color region, and that of one of its copies."""


class Undecided(Exception):
    """Within its limits the planner neither found a plan nor proved that there is none."""


class Planner:
    """Makes plans for an instance that respect all separations found so far.

    Args:
        regions: its color regions.
        fewest: the size of a smallest cover: as few regions can touch every cell, not fewer.
        cover: color regions that touch every cell, a hint for the first plan.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[Region],
        fewest: int,
        cover: Sequence[Region] = (),
    ) -> None:
        self._instance, self._regions, self._fewest = instance, regions, fewest
        # How many segments of each region are told apart; more only where a plan has more.
        self._copies = [1] * len(regions)
        self._number = {region: number for number, region in enumerate(regions)}
        # Nothing separates the cells of a merged cell, so a segment that touches one of them can be
        # grown over all. So a plan need not tell them apart.
        own = {cell.id: frozenset(cell.colors) for cell in instance.cells}
        self._merged = merge_cells(instance, own)
        self._regions_of: dict[int, list[int]] = defaultdict(list)
        for number, (_, cells) in enumerate(regions):
            for merged_cell in sorted(self._held(cells)):
                self._regions_of[merged_cell].append(number)
        self._pairs: dict[tuple[int, int], RegionPair] = {}
        self._separations: dict[tuple[int, int], list[Separation]] = {}
        self._refuted: dict[int, list[set[int]]] = defaultdict(list)
        # The segments of the last plan, with the kinds that they touch.
        self._last: dict[_Copy, set[int]] = {(self._number[region], 0): set() for region in cover}

    def plan(self, segments: int, solve: Solve) -> SegmentPlan | None:
        """A plan with an exact number of segments that respects all separations so far.

        Args:
            segments: how many; at least as many as a smallest cover has.
            solve: runs a model, within limits.

        Returns:
            None if it is proved that there is none.

        Raises:
            Undecided: the model would be too large, or the limits came first.
        """
        # Without the segments of a region but one, the segments are still a cover.
        most = segments - self._fewest + 1
        separated = list(self._separated())
        kinds = self._kinds(separated)
        while True:
            copies = [min(own, most) for own in self._copies]
            literals = sum(n * len({*own.values()}) for n, own in zip(copies, kinds, strict=True))
            in_separations = sum(
                copies[ends[0][0]] * copies[groups[0][0]] * (2 + len(groups))
                for ends, groups in separated
            )
            if literals > MOST_LITERALS or in_separations > MOST_SEPARATED:
                raise Undecided
            built = _PlanModel(segments, copies, most, kinds, self._last)
            built.add_cover(self._demands(kinds))
            for ends, groups in separated:
                built.add_separation(ends, groups)
            for regions in self._refuted[segments]:
                built.add_another(regions)
            solver, status = solve(built.model)
            if status == cp_model.INFEASIBLE:
                return None
            if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
                raise Undecided
            beyond = [r for r, literal in built.beyond.items() if solver.boolean_value(literal)]
            if not beyond:
                break
            for region in beyond:
                self._copies[region] += 1
        true = solver.boolean_value
        self._last = {
            segment: {kind for kind, own in built.touched[segment].items() if true(own)}
            for segment, literal in built.in_use.items()
            if true(literal)
        }
        return self._read(kinds)

    @property
    def regions_in_use(self) -> list[Region]:
        """Those of the last plan's segments, also of the ones that no cell was given to."""
        return [self._regions[number] for number in sorted({number for number, _ in self._last})]

    def refute(self, segments: int) -> None:
        """No division with so many segments has all of them in the regions of the last plan."""
        self._refuted[segments].append({number for number, _ in self._last})

    def refuted(self, segments: int) -> bool:
        """Whether some plan with so many segments was refuted."""
        return bool(self._refuted[segments])

    @property
    def separations(self) -> Iterator[tuple[Region, Region, Separation]]:
        """All separations found so far, each with the region that separates and the separated."""
        for (one, other), separations in self._separations.items():
            for separation in separations:
                yield self._regions[one], self._regions[other], separation

    def find_separations(self, plan: SegmentPlan, deadline: Deadline) -> bool:
        """Look for two segments of a plan that would cross; returns whether there are any."""
        return any(self._find(plan, starts, deadline) for starts in (1, MOST_STARTS))

    def _find(self, plan: SegmentPlan, starts: int, deadline: Deadline) -> bool:
        """Look at curves from so many merged cells of each segment."""
        found = 0
        for one, other in combinations(plan, 2):
            first, second = sorted((one, other), key=lambda segment: self._number[segment[0]])
            numbers = self._number[first[0]], self._number[second[0]]
            if first[0][0] == second[0][0] or first[0][1].isdisjoint(second[0][1]):
                continue
            if numbers not in self._pairs:
                deadline.check()
                self._pairs[numbers] = RegionPair(self._instance, first[0], second[0])
            pair = self._pairs[numbers]
            for key, side, own, separated in (
                (numbers, pair.first, first[1], second[1]),
                (numbers[::-1], pair.second, second[1], first[1]),
            ):
                held = {pair.merged_cell_of.get(cell) for cell in own}
                ends = [merged_cell for merged_cell in side.merged_cells if merged_cell in held]
                for new in _violated(side, ends, separated, starts, deadline):
                    self._separations.setdefault(key, []).append(new)
                    found += 1
                    if found == MOST_SEPARATIONS:
                        return True
        return found > 0

    def _separated(self) -> Iterator[tuple[list[_Named], list[_Named]]]:
        """The separations so far: two ends in the one region, and groups in the other."""
        for (one, other), separations in self._separations.items():
            for separation in separations:
                groups = [frozenset[int]().union(*group) for group in separation.groups]
                yield (
                    [(one, self._held(end)) for end in separation.ends],
                    [(other, self._held(group)) for group in groups],
                )

    def _held(self, cells: Iterable[int]) -> frozenset[int]:
        """The merged cells that contain some cells."""
        return frozenset(self._merged.merged_cell_of[cell] for cell in cells)

    def _kinds(
        self, separated: Iterable[tuple[list[_Named], list[_Named]]]
    ) -> list[dict[int, int]]:
        """For each region its merged cells that separations name, with the first of their kind."""
        places: list[dict[int, list[int]]] = [defaultdict(list) for _ in self._regions]
        named = (own for ends, groups in separated for own in (*ends, *groups))
        for number, (region, merged_cells) in enumerate(named):
            for merged_cell in merged_cells:
                places[region][merged_cell].append(number)
        kinds: list[dict[int, int]] = []
        for own in places:
            first: dict[tuple[int, ...], int] = {}
            kinds.append({m: first.setdefault(tuple(own[m]), m) for m in sorted(own)})
        return kinds

    def _demands(self, kinds: Sequence[Mapping[int, int]]) -> Iterable[dict[int, int | None]]:
        """The regions of the merged cells that have to be touched, with the kinds there.

        Merged cells of the same regions and kinds are touched together. One needs no constraint if
        another one implies it: if it lies in all regions of the other one, and in each of them has
        the kind of the other one or no kind.
        """
        different = dict.fromkeys(
            tuple((region, kinds[region].get(merged_cell)) for region in regions)
            for merged_cell, regions in self._regions_of.items()
        )
        demands = [dict(key) for key in different]
        lying_in: dict[int, set[int]] = defaultdict(set)
        for number, own in enumerate(demands):
            for region in own:
                lying_in[region].add(number)
        implied = {
            other
            for number, own in enumerate(demands)
            for other in set.intersection(*(lying_in[region] for region in own)) - {number}
            if all(demands[other][region] in (None, kind) for region, kind in own.items())
        }
        return [own for number, own in enumerate(demands) if number not in implied]

    def _read(self, kinds: Sequence[Mapping[int, int]]) -> SegmentPlan:
        """The last plan, with each merged cell given to the first segment that touches it."""
        cells: dict[_Copy, set[int]] = {segment: set() for segment in self._last}
        for merged_cell, own in self._merged.cells().items():
            touching = (
                (number, copy)
                for (number, copy), touched in self._last.items()
                if number in self._regions_of[merged_cell]
                and (merged_cell not in kinds[number] or kinds[number][merged_cell] in touched)
            )
            cells[next(touching)] |= own
        return tuple(
            (self._regions[number], frozenset(own)) for (number, _), own in cells.items() if own
        )


def _violated(
    side: Side, ends: Sequence[int], cells: frozenset[int], starts: int, deadline: Deadline
) -> Iterator[Separation]:
    """Separations by a segment that touches ``ends`` of the cells of another segment."""
    for near, far in combinations(ends, 2):
        if near not in ends[:starts]:
            return
        deadline.check()
        for separation in side.separations(near, far):
            touched = (
                any(not merged_cell.isdisjoint(cells) for merged_cell in group)
                for group in separation.groups
            )
            if sum(touched) > 1:
                yield separation


class _PlanModel:
    """The CP-SAT model of plans with an exact number of segments.

    Args:
        copies: how many segments of each region the plan tells apart.
        most: how many segments a region may have at most, as many as its copies or more.
        kinds: of each region.
        last: the segments of the last plan with the kinds that they touch, as a hint.

    Attributes:
        in_use: for every copy: it is a segment of the plan.
        beyond: for every region that may have more segments than copies: it has.
        touched: for every copy and kind: the segment touches that kind.
    """

    def __init__(
        self,
        segments: int,
        copies: Sequence[int],
        most: int,
        kinds: Sequence[Mapping[int, int]],
        last: Mapping[_Copy, set[int]],
    ) -> None:
        self.model = model = cp_model.CpModel()
        self.in_use: dict[_Copy, cp_model.IntVar] = {}
        self.beyond: dict[int, cp_model.IntVar] = {}
        self.touched: dict[_Copy, dict[int, cp_model.IntVar]] = {}
        self._copies, self._kinds = copies, kinds
        self._touching: dict[tuple[_Copy, frozenset[int]], cp_model.IntVar] = {}
        further = []
        for region, count in enumerate(copies):
            for copy in range(count):
                segment = region, copy
                self.in_use[segment] = own = model.new_bool_var("")
                model.add_hint(own, segment in last)
                if copy:
                    model.add_implication(own, self.in_use[region, copy - 1])
                self.touched[segment] = {}
                for kind in sorted(set(kinds[region].values())):
                    self.touched[segment][kind] = literal = model.new_bool_var("")
                    model.add_implication(literal, own)
                    model.add_hint(literal, kind in last.get(segment, ()))
            if count < most:  # segments besides the copies, which then are all in use
                further.append(model.new_int_var(0, most - count, ""))
                self.beyond[region] = literal = model.new_bool_var("")
                model.add_implication(literal, self.in_use[region, count - 1])
                model.add(further[-1] == 0).only_enforce_if(~literal)
                model.add(further[-1] >= 1).only_enforce_if(literal)
                model.add_hint(literal, False)
                model.add_hint(further[-1], 0)
        model.add(sum([*self.in_use.values(), *further]) == segments)

    def add_cover(self, demands: Iterable[Mapping[int, int | None]]) -> None:
        """Some segment touches each merged cell, given by its regions and its kinds there."""
        for demand in demands:
            literals = []
            for region, kind in demand.items():
                if kind is None:
                    literals.append(self.in_use[region, 0])
                else:
                    literals += [self.touched[own][kind] for own in self._segments_in(region)]
                    literals += self._beyond(region)
            self.model.add_bool_or(literals)

    def add_separation(self, ends: Sequence[_Named], groups: Sequence[_Named]) -> None:
        """No segment touches two groups if one of the other region touches both ends."""
        one, other = ends[0][0], groups[0][0]
        told_apart = [~literal for literal in self._beyond(one, other)]
        for near, far in product(self._segments_in(one), self._segments_in(other)):
            both = [self._touches(near, merged_cells) for _, merged_cells in ends]
            touched = [self._touches(far, merged_cells) for _, merged_cells in groups]
            self.model.add(sum(touched) <= 1).only_enforce_if(both + told_apart)

    def add_another(self, regions: Collection[int]) -> None:
        """Some segment lies in a region that is not among these."""
        self.model.add_bool_or(
            own for (region, copy), own in self.in_use.items() if not copy and region not in regions
        )

    def _segments_in(self, region: int) -> list[_Copy]:
        return [(region, copy) for copy in range(self._copies[region])]

    def _beyond(self, *regions: int) -> list[cp_model.IntVar]:
        """Literals of which one is true if one of the regions has more segments than copies."""
        return [self.beyond[region] for region in sorted({*regions}) if region in self.beyond]

    def _touches(self, segment: _Copy, merged_cells: Iterable[int]) -> cp_model.IntVar:
        """A literal that is true if a segment touches one of some merged cells."""
        key = segment, frozenset(self._kinds[segment[0]][m] for m in merged_cells)
        if key not in self._touching:
            self._touching[key] = self.model.new_bool_var("")
            for kind in sorted(key[1]):
                self.model.add_implication(self.touched[segment][kind], self._touching[key])
        return self._touching[key]
