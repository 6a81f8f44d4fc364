"""Segment plans: how many segments each color region gets, and which cells each of them touches.

A plan is a relaxation of a division. It does not say how segments run; it only respects the reasons
found so far why some segments cannot be drawn together (partings and tangles, see ``plan_model``).
So if there is no plan with n segments, no division of the surface has n segments
(docs/bounds/conflicts.md, "Segment plans"). A plan takes milliseconds where the full model takes
seconds.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import prod

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.conflicts import Parting, RegionPair, Side
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.solvers.bounds.tangles import Tangle, Tangles, Touching
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed
from cellcolor.solvers.cpsat.routes.plan_model import (
    PartedCells,
    PlanCells,
    PlanModel,
    SegmentName,
)


@dataclass(frozen=True, slots=True)
class PlannedSegment:
    """A segment of a plan.

    Attributes:
        region: its color region.
        cells: the cells that it has to touch. Each cell is given to one segment.
        besides: further cells that it touches, because a tangle would apply if it avoided them.
    """

    region: Region
    cells: frozenset[int]
    besides: frozenset[int] = frozenset()

    @property
    def touched(self) -> frozenset[int]:
        """All cells that it has to touch."""
        return self.cells | self.besides


SegmentPlan = tuple[PlannedSegment, ...]

Quota = Mapping[Region, int]
"""How many segments each color region may have at most; none if it is not named."""

MOST_LITERALS = 100_000
"""The most literals of a model, one for each copy and kind; beyond that the planner gives up."""

MOST_PARTED, MOST_PARTED_THOROUGHLY = 2_000, 200_000
"""The most literals in the constraints of partings; beyond that the planner gives up. Around a cell
with many petals (cells with a single live dart) nearly all pairs of segments are in conflict, and
there the full model and counting links have better bounds."""

MOST_TANGLED = 20_000
"""The most literals in the clauses of tangles; beyond that the planner gives up."""

MOST_PARTINGS = 200
"""The most partings to find in one plan; then a plan is made that respects them."""

MOST_STARTS = 5
"""Curves are drawn from one merged cell of a segment to its others. If they show no crossing, they
are drawn from this many of its merged cells."""


@dataclass(frozen=True, slots=True)
class ModelWithin:
    """The model of the plans that keep to a quota.

    Attributes:
        model: the model.
        touching: for a color region and a cell of it, literals of which one is true if a segment of
            the region touches the cell; None if no parting and no tangle asks.
    """

    model: cp_model.CpModel
    touching: Callable[[Region, int], list[cp_model.IntVar] | None]


class Undecided(Exception):
    """Within its limits the planner neither found a plan nor proved that there is none."""


class Planner:
    """Makes plans for an instance that respect all partings and tangles found so far.

    Args:
        regions: its color regions.
        fewest: the size of a smallest cover: as few regions can touch every cell, not fewer.
        solve: runs a model with a seed, within limits.
        cover: color regions that touch every cell, a hint for the first plan.
        at_once: whether all segments of a region are told apart from the beginning. With few cells
            that is decided sooner; with many the model would be too large.

    Attributes:
        instance: the instance.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[Region],
        fewest: int,
        solve: SolveWithSeed,
        cover: Sequence[Region] = (),
        at_once: bool = False,
    ) -> None:
        self.instance = instance
        self._regions = regions
        self._fewest = fewest
        self._solve = solve
        # How many segments of each region are told apart; more only where a plan has more.
        self._copies = [len(instance.cells) if at_once else 1] * len(regions)
        self._number = {region: number for number, region in enumerate(regions)}
        # Nothing separates the cells of a merged cell, so a segment that touches one of them can be
        # grown over all. So a plan need not tell them apart.
        own = {cell.id: frozenset(cell.colors) for cell in instance.cells}
        self._merged = merge_cells(instance, own)
        self._merged_cells = self._merged.cells()
        self._merged_cells_of = [
            frozenset(self._merged.merged_cell_of[cell] for cell in cells) for _, cells in regions
        ]
        self._pairs: dict[tuple[int, int], RegionPair] = {}
        self._partings: dict[tuple[int, int], list[Parting]] = {}
        self._looked_at: set[tuple[tuple[int, int], int, int]] = set()
        self._surface: Tangles | None = None
        self._tangles: list[Tangle] = []
        self._last: dict[SegmentName, set[int]] = {
            (self._number[region], 0): set() for region in cover
        }

    def plan(
        self,
        segments: int,
        seed: int,
        thoroughly: bool = False,
        refused: Sequence[Quota] = (),
    ) -> SegmentPlan | None:
        """A plan with an exact number of segments that respects all partings and tangles so far.

        Args:
            segments: how many; at least as many as a smallest cover has.
            seed: other seeds give other plans, if there are several.
            thoroughly: whether to accept far more partings before giving up, which takes longer.
            refused: the plan keeps to none of these quotas.

        Returns:
            A plan, or None if it is proved that there is none.

        Raises:
            Undecided: the model would be too large, or the solver's limits came first.
        """
        # Without the segments of a region but one, the segments are still a cover.
        most = [segments - self._fewest + 1] * len(self._regions)
        cells = PlanCells(self._merged_cells_of, self._parted_cells(), self._tangles)
        while True:
            copies = list(map(min, self._copies, most))
            self._refuse_large(cells, copies, thoroughly)
            built = PlanModel(cells, segments, copies, most, self._last)
            for quota in refused:
                built.refuse({self._number[region]: number for region, number in quota.items()})
            model, touched = built.model, built.touched
            if seed:
                # Without a random objective, other seeds find the same plan again.
                chance = random.Random(seed)
                literals = [literal for own in touched.values() for literal in own.values()]
                wish = sum(chance.randrange(4) * literal for literal in literals)
                model.minimize(wish + 4 * len(literals) * sum(built.beyond.values()))
            solver, status = self._solve(model, seed)
            if status == cp_model.INFEASIBLE:
                return None
            if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
                raise Undecided
            beyond = [r for r, literal in built.beyond.items() if solver.boolean_value(literal)]
            if not beyond:
                break
            for region in beyond:
                self._copies[region] += 1
        self._last = {
            segment: {kind for kind, own in touched[segment].items() if solver.boolean_value(own)}
            for segment, literal in built.in_use.items()
            if solver.boolean_value(literal)
        }
        return self._read(cells.kinds, seed)

    def model_within(self, quota: Quota, segments: int) -> ModelWithin:
        """The model of the plans with an exact number of segments that keep to a quota.

        Args:
            segments: as in :meth:`plan`.
        """
        cells = PlanCells(self._merged_cells_of, self._parted_cells(), self._tangles)
        copies = [quota.get(region, 0) for region in self._regions]
        built = PlanModel(cells, segments, copies, copies, self._last)

        def touching(region: Region, cell: int) -> list[cp_model.IntVar] | None:
            number = self._number[region]
            kind = cells.kinds[number].get(self._merged.merged_cell_of[cell])
            if kind is None:
                return None
            return [built.touched[number, copy][kind] for copy in range(copies[number])]

        return ModelWithin(built.model, touching)

    def _refuse_large(self, cells: PlanCells, copies: Sequence[int], thoroughly: bool) -> None:
        """Refuse what would take too long.

        Raises:
            Undecided: the model would be too large.
        """
        kinds = (copies[region] * len({*own.values()}) for region, own in enumerate(cells.kinds))
        parted = (
            copies[one] * copies[other] * sum(2 + len(parting.groups) for parting in partings)
            for (one, other), partings in self._partings.items()
        )
        tangled = (t.size * prod(copies[s.region] for s in t.segments) for t in self._tangles)
        if (
            sum(kinds) > MOST_LITERALS
            or sum(parted) > (MOST_PARTED_THOROUGHLY if thoroughly else MOST_PARTED)
            or sum(tangled) > MOST_TANGLED
        ):
            raise Undecided

    @property
    def quota(self) -> Quota:
        """How many segments each color region has in the last plan.

        Together they are as many as were asked for. The plan itself leaves out segments for which
        no cell is left.
        """
        return Counter(self._regions[region] for region, _ in self._last)

    @property
    def heeds_conflicts(self) -> bool:
        """Whether any parting or tangle has been found, so that plans are more than covers."""
        return bool(self._partings or self._tangles)

    @property
    def partings(self) -> Iterator[tuple[Region, Region, Parting]]:
        """All partings found so far: the region that parts, the region parted, and the parting."""
        for (one, other), partings in self._partings.items():
            for parting in partings:
                yield self._regions[one], self._regions[other], parting

    @property
    def tangles(self) -> Iterator[list[tuple[Region, list[list[frozenset[int]]], frozenset[int]]]]:
        """All tangles found so far: for each segment its region, its groups, and what it avoids.

        A group is a list of merged cells, each a set of cells.
        """
        cells = self._merged_cells
        for tangle in self._tangles:
            yield [
                (
                    self._regions[segment.region],
                    [[frozenset(cells[m]) for m in sorted(group)] for group in segment.groups],
                    frozenset(cell for m in segment.avoided for cell in cells[m]),
                )
                for segment in tangle.segments
            ]

    def find_conflicts(self, plan: SegmentPlan, deadline: Deadline, *, avoiding: bool) -> bool:
        """Look for segments of a plan that cannot all be drawn; returns whether there are any.

        Args:
            plan: made by :meth:`plan`.
            avoiding: whether to look also for tangles that need segments to avoid some cells. They
                rule out more plans, but the model has to decide about more cells then.
        """
        return self.find_partings(plan, deadline) or self._find_tangles(plan, deadline, avoiding)

    def find_partings(self, plan: SegmentPlan, deadline: Deadline) -> bool:
        """Look for two segments of a plan that would cross; returns whether there are any."""
        return any(self._find(plan, every, deadline) for every in (False, True))

    def _find_tangles(self, plan: SegmentPlan, deadline: Deadline, avoiding: bool) -> bool:
        """Look for segments of a plan that form a tangle."""
        if self._surface is None:
            self._surface = Tangles(self._merged, self._regions)
        held = [self._held(segment.touched) for segment in plan]
        every = frozenset[int]().union(*held)
        found: list[Tangle] = []
        for avoids in (False, True) if avoiding else (False,):
            touching = []
            for segment, own in zip(plan, held, strict=True):
                number = self._number[segment.region]
                avoided = (every - own) & self._merged_cells_of[number] if avoids else frozenset()
                touching.append(Touching(number, tuple(sorted(own)), avoided))
            found = found or self._surface.find(touching, deadline)
        self._tangles += found
        return bool(found)

    def _find(self, plan: SegmentPlan, every: bool, deadline: Deadline) -> bool:
        """Look at curves from one merged cell of each segment or, with ``every``, from a few."""
        found = 0
        for one, other in combinations(plan, 2):
            first, second = sorted((one, other), key=lambda s: self._number[s.region])
            numbers = self._number[first.region], self._number[second.region]
            if first.region[0] == second.region[0] or first.region[1].isdisjoint(second.region[1]):
                continue
            if numbers not in self._pairs:
                deadline.check()
                self._pairs[numbers] = RegionPair(self.instance, first.region, second.region)
            pair = self._pairs[numbers]
            for key, side, own, parted in (
                (numbers, pair.first, first, second),
                (numbers[::-1], pair.second, second, first),
            ):
                held = {pair.merged_cell_of(cell) for cell in own.touched}
                ends = [merged_cell for merged_cell in side.merged_cells if merged_cell in held]
                for parting in self._violated(key, side, ends, parted.touched, every, deadline):
                    self._partings.setdefault(key, []).append(parting)
                    found += 1
                    if found == MOST_PARTINGS:
                        return True
        return found > 0

    def _violated(
        self,
        key: tuple[int, int],
        side: Side,
        ends: Sequence[int],
        cells: frozenset[int],
        every: bool,
        deadline: Deadline,
    ) -> Iterator[Parting]:
        """New partings by a segment that touches ``ends`` of the cells of another segment."""
        starts = range(min(MOST_STARTS, len(ends))) if every else range(1)
        for near, far in ((ends[n], merged_cell) for n in starts for merged_cell in ends[n + 1 :]):
            if (key, near, far) in self._looked_at:
                continue
            deadline.check()
            for parting in side.partings(near, far):
                touched = (
                    any(not merged_cell.isdisjoint(cells) for merged_cell in group)
                    for group in parting.groups
                )
                if sum(touched) > 1:
                    self._looked_at.add((key, near, far))
                    yield parting

    def _parted_cells(self) -> PartedCells:
        """The partings found so far, in merged cells of the whole instance."""
        return {
            pair: [
                (
                    [self._held(end) for end in parting.ends],
                    [self._held(frozenset[int]().union(*group)) for group in parting.groups],
                )
                for parting in partings
            ]
            for pair, partings in self._partings.items()
        }

    def _held(self, cells: frozenset[int]) -> frozenset[int]:
        """The merged cells that contain some cells."""
        return frozenset(self._merged.merged_cell_of[cell] for cell in cells)

    def _read(self, kinds: Sequence[Mapping[int, int]], seed: int) -> SegmentPlan:
        """The last plan, with each merged cell given to one of the segments that touch it."""
        chance = random.Random(seed)
        cells: dict[SegmentName, set[int]] = {segment: set() for segment in self._last}
        for merged_cell, own in self._merged_cells.items():
            touching = [
                (number, copy)
                for (number, copy), touched in self._last.items()
                if merged_cell in self._merged_cells_of[number]
                and (merged_cell not in kinds[number] or kinds[number][merged_cell] in touched)
            ]
            cells[chance.choice(touching) if seed else touching[0]] |= own
        asked: dict[int, set[int]] = {}
        for segment in (segment for tangle in self._tangles for segment in tangle.segments):
            asked.setdefault(segment.region, set()).update(segment.avoided)
        return tuple(
            PlannedSegment(
                self._regions[number],
                frozenset(own),
                frozenset(
                    cell
                    for merged_cell in asked.get(number, ())
                    if kinds[number][merged_cell] in self._last[number, copy]
                    for cell in self._merged_cells[merged_cell]
                ),
            )
            for (number, copy), own in cells.items()
            if own
        )
