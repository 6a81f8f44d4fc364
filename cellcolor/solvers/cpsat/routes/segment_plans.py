"""Segment plans: which color regions get how many segments, and which cells each of them touches.

A segment plan compares segments only two at a time. It can be made in milliseconds where the full
model takes seconds. If there is no plan with a number of segments, there is no such division of
the surface either (docs/bounds.md, "Segment plans").
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.conflicts import Parting, RegionPair, Side
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_cells import merge_cells
from cellcolor.solvers.bounds.tangles import Tangle, Tangles, Touching
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed
from cellcolor.solvers.cpsat.routes.plan_model import PartedCells, PlanCells, PlanModel


@dataclass(frozen=True, slots=True)
class PlannedSegment:
    """A segment as planned.

    Attributes:
        region: the color region it lies in.
        cells: the cells that it has to touch, so that some segment touches every cell.
        besides: cells that it touches as well, because a tangle would hold if it avoided them.
    """

    region: Region
    cells: frozenset[int]
    besides: frozenset[int] = frozenset()

    @property
    def touched(self) -> frozenset[int]:
        """All cells that it is known to touch."""
        return self.cells | self.besides


SegmentPlan = tuple[PlannedSegment, ...]

MOST_LITERALS = 100_000
"""Literals of the largest model that is built: one for each merged cell
(``bounds/merged_cells.py``) and each segment that may touch it."""

MOST_PARTED, MOST_PARTED_THOROUGHLY = 2_000, 200_000
"""The most literals in the constraints that keep segments from crossing. With more the planner
gives up: around a cell with many petals, which are cells with a single live dart, nearly every two
segments are in conflict, and there counting links and the full model have the better bounds."""

MOST_TANGLED = 20_000
"""The most literals in the clauses that keep segments from tangles; with more the planner gives
up."""

MOST_PARTINGS = 200
"""How many are looked for in a plan before the next plan is made that heeds them."""

MOST_STARTS = 5
"""Merged cells of a segment from which curves are drawn to its other ones, if one such merged cell
does not show that the segment crosses another."""


class Undecided(Exception):
    """Within its limits the solver neither found a plan nor proved that there is none."""


class Planner:
    """Plans for an instance, with the partings and tangles found so far (docs/bounds.md).

    Args:
        instance: the topological graph.
        regions: its color regions.
        fewest: at least this many regions are needed to touch every cell.
        solve: runs a model with a seed, within limits.
        cover: color regions that touch every cell, with which the first plan begins.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[Region],
        fewest: int,
        solve: SolveWithSeed,
        cover: Sequence[Region] = (),
    ) -> None:
        self._instance = instance
        self._regions = regions
        self._fewest = fewest
        self._solve = solve
        self._number = {region: number for number, region in enumerate(regions)}
        # A segment that touches one cell of a merged cell in which nothing separates its cells can
        # be grown over all of it, so that merged cells are all that a plan has to know.
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
        self._last: dict[tuple[int, int], set[int]] = {
            (self._number[region], 0): set() for region in cover
        }

    def plan(self, segments: int, seed: int, thoroughly: bool = False) -> SegmentPlan | None:
        """A plan with an exact number of segments that satisfies all partings and tangles so far.

        Args:
            segments: how many, the smallest cover or more.
            seed: other seeds give other plans, where there are several.
            thoroughly: whether to respect far more partings, which takes longer.

        Returns:
            A plan, or None if it is proved that there is none.

        Raises:
            Undecided: the limits of the solver came first, or there are too many partings.
        """
        copies = segments - self._fewest + 1
        most = MOST_PARTED_THOROUGHLY if thoroughly else MOST_PARTED
        parted = [parting for partings in self._partings.values() for parting in partings]
        if copies**2 * sum(2 + len(parting.groups) for parting in parted) > most:
            raise Undecided
        if sum(t.size * copies ** len(t.segments) for t in self._tangles) > MOST_TANGLED:
            raise Undecided
        cells = PlanCells(self._merged_cells_of, self._parted_cells(), self._tangles)
        if copies * sum(len(set(own.values())) for own in cells.kinds) > MOST_LITERALS:
            raise Undecided
        built = PlanModel(cells, segments, copies, self._last)
        model, touched = built.model, built.touched
        if seed:
            # Left to themselves, other seeds find the same plan again.
            chance = random.Random(seed)
            literals = [literal for own in touched.values() for literal in own.values()]
            model.minimize(sum(chance.randrange(4) * literal for literal in literals))
        solver, status = self._solve(model, seed)
        if status == cp_model.INFEASIBLE:
            return None
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            raise Undecided
        self._last = {
            segment: {kind for kind, own in touched[segment].items() if solver.boolean_value(own)}
            for segment, literal in built.in_use.items()
            if solver.boolean_value(literal)
        }
        return self._read(cells.kinds, seed)

    @property
    def heeds_conflicts(self) -> bool:
        """Whether plans have constraints besides touching every cell."""
        return bool(self._partings or self._tangles)

    @property
    def partings(self) -> Iterator[tuple[Region, Region, Parting]]:
        """All partings found so far: of whose segments which two regions, and the parting."""
        for (one, other), partings in self._partings.items():
            for parting in partings:
                yield self._regions[one], self._regions[other], parting

    @property
    def tangles(self) -> Iterator[list[tuple[Region, list[list[frozenset[int]]], frozenset[int]]]]:
        """All tangles found so far: of each segment its region, groups of areas, avoided cells."""
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
        """Look for segments of a plan that cannot all be drawn; whether there are any.

        Args:
            plan: made by :meth:`plan`.
            deadline: when to stop.
            avoiding: whether to look for tangles that hold because segments do not touch some
                cells, too. They rule out more plans, and the next ones have more to say.

        Raises:
            OutOfTime: the deadline came first.
        """
        return self.find_partings(plan, deadline) or self._find_tangles(plan, deadline, avoiding)

    def find_partings(self, plan: SegmentPlan, deadline: Deadline) -> bool:
        """Look for segments of a plan that would cross; whether there are any.

        Raises:
            OutOfTime: the deadline came first.
        """
        return any(self._find(plan, every, deadline) for every in (False, True))

    def _find_tangles(self, plan: SegmentPlan, deadline: Deadline, avoiding: bool) -> bool:
        """Look for segments that fit two at a time only."""
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
        """Look at curves from one merged cell of each segment, or from every one of a few."""
        found = 0
        for one, other in combinations(plan, 2):
            first, second = sorted((one, other), key=lambda s: self._number[s.region])
            numbers = self._number[first.region], self._number[second.region]
            if first.region[0] == second.region[0] or first.region[1].isdisjoint(second.region[1]):
                continue
            if numbers not in self._pairs:
                deadline.check()
                self._pairs[numbers] = RegionPair(self._instance, first.region, second.region)
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
        """New partings, by a segment that touches some merged cells, of the cells of another
        segment."""
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
        """The partings found so far, in the merged cells of all colors."""
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
        """The merged cells that some cells are parts of."""
        return frozenset(self._merged.merged_cell_of[cell] for cell in cells)

    def _read(self, kinds: Sequence[Mapping[int, int]], seed: int) -> SegmentPlan:
        """The last plan, in which every cell is given to one segment only."""
        chance = random.Random(seed)
        cells: dict[tuple[int, int], set[int]] = {segment: set() for segment in self._last}
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
