"""Segment plans: how many segments each color region gets, and which cells each of them touches.

A plan is a relaxation of a division. It does not say how segments run; it only respects the pairs
of segments that are known to be unable to pass each other (``conflicts``). So if there is no plan
with n segments, no division of the surface has n segments (docs/bounds.md, "Segment
plans"). A plan takes milliseconds where the model takes seconds.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.conflicts import RegionPair, Separation, Side
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.solvers.cpsat.plan_model import (
    PlanCells,
    PlanModel,
    SegmentName,
    SeparatedCells,
)
from cellcolor.solvers.cpsat.runner import Solve


@dataclass(frozen=True, slots=True)
class PlannedSegment:
    """A segment of a plan: its color region, and the cells that it is to touch.

    Each cell is given to one segment.
    """

    region: Region
    cells: frozenset[int]


SegmentPlan = tuple[PlannedSegment, ...]

MOST_LITERALS = 100_000
"""The most literals of a model, one for each copy and kind; beyond that the planner gives up."""

MOST_SEPARATED = 200_000
"""The most literals in the constraints of separations; beyond that the planner gives up. Around a
cell with many leaf cells (cells with a single live dart) nearly all pairs of segments separate each
other, and there the model has better bounds."""

MOST_SEPARATIONS = 200
"""The most separations to find in one plan; then a plan is made that respects them."""

MOST_STARTS = 5
"""Curves are drawn from one merged cell of a segment to its others. If they show no crossing, they
are drawn from this many of its merged cells."""


class Undecided(Exception):
    """Within its limits the planner neither found a plan nor proved that there is none."""


class Planner:
    """Makes plans for an instance that respect all separations found so far.

    Args:
        regions: its color regions.
        fewest: the size of a smallest cover: as few regions can touch every cell, not fewer.
        cover: color regions that touch every cell, a hint for the first plan.

    Attributes:
        instance: the instance.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[Region],
        fewest: int,
        cover: Sequence[Region] = (),
    ) -> None:
        self.instance = instance
        self._regions = regions
        self._fewest = fewest
        # How many segments of each region are told apart; more only where a plan has more.
        self._copies = [1] * len(regions)
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
        self._separations: dict[tuple[int, int], list[Separation]] = {}
        self._looked_at: set[tuple[tuple[int, int], int, int]] = set()
        self._last: dict[SegmentName, set[int]] = {
            (self._number[region], 0): set() for region in cover
        }

    def plan(self, segments: int, solve: Solve) -> SegmentPlan | None:
        """A plan with an exact number of segments that respects all separations so far.

        Args:
            segments: how many; at least as many as a smallest cover has.
            solve: runs a model, within limits.

        Returns:
            A plan, or None if it is proved that there is none.

        Raises:
            Undecided: the model would be too large, or the limits came first.
        """
        # Without the segments of a region but one, the segments are still a cover.
        most = [segments - self._fewest + 1] * len(self._regions)
        cells = PlanCells(self._merged_cells_of, self._separated_cells())
        while True:
            copies = list(map(min, self._copies, most))
            self._refuse_large(cells, copies)
            built = PlanModel(cells, segments, copies, most, self._last)
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
        self._last = {
            segment: {
                kind for kind, own in built.touched[segment].items() if solver.boolean_value(own)
            }
            for segment, literal in built.in_use.items()
            if solver.boolean_value(literal)
        }
        return self._read(cells.kinds)

    def _refuse_large(self, cells: PlanCells, copies: Sequence[int]) -> None:
        """Refuse what would take too long.

        Raises:
            Undecided: the model would be too large.
        """
        kinds = (copies[region] * len({*own.values()}) for region, own in enumerate(cells.kinds))
        separated = (
            copies[one] * copies[other] * sum(2 + len(own.groups) for own in separations)
            for (one, other), separations in self._separations.items()
        )
        if sum(kinds) > MOST_LITERALS or sum(separated) > MOST_SEPARATED:
            raise Undecided

    @property
    def separations(self) -> Iterator[tuple[Region, Region, Separation]]:
        """All separations found so far, each with the region that separates and the separated."""
        for (one, other), separations in self._separations.items():
            for separation in separations:
                yield self._regions[one], self._regions[other], separation

    def find_separations(self, plan: SegmentPlan, deadline: Deadline) -> bool:
        """Look for two segments of a plan that would cross; returns whether there are any."""
        return any(self._find(plan, every, deadline) for every in (False, True))

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
            for key, side, own, separated in (
                (numbers, pair.first, first, second),
                (numbers[::-1], pair.second, second, first),
            ):
                held = {pair.merged_cell_of(cell) for cell in own.cells}
                ends = [merged_cell for merged_cell in side.merged_cells if merged_cell in held]
                for new in self._violated(key, side, ends, separated.cells, every, deadline):
                    self._separations.setdefault(key, []).append(new)
                    found += 1
                    if found == MOST_SEPARATIONS:
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
    ) -> Iterator[Separation]:
        """New separations by a segment that touches ``ends``, of the cells of another segment."""
        starts = range(min(MOST_STARTS, len(ends))) if every else range(1)
        for near, far in ((ends[n], merged_cell) for n in starts for merged_cell in ends[n + 1 :]):
            if (key, near, far) in self._looked_at:
                continue
            deadline.check()
            for separation in side.separations(near, far):
                touched = (
                    any(not merged_cell.isdisjoint(cells) for merged_cell in group)
                    for group in separation.groups
                )
                if sum(touched) > 1:
                    self._looked_at.add((key, near, far))
                    yield separation

    def _separated_cells(self) -> SeparatedCells:
        """The separations found so far, in merged cells of the whole instance."""
        return {
            pair: [
                (
                    [self._held(end) for end in separation.ends],
                    [self._held(frozenset[int]().union(*group)) for group in separation.groups],
                )
                for separation in separations
            ]
            for pair, separations in self._separations.items()
        }

    def _held(self, cells: frozenset[int]) -> frozenset[int]:
        """The merged cells that contain some cells."""
        return frozenset(self._merged.merged_cell_of[cell] for cell in cells)

    def _read(self, kinds: Sequence[Mapping[int, int]]) -> SegmentPlan:
        """The last plan, with each merged cell given to the first segment that touches it."""
        cells: dict[SegmentName, set[int]] = {segment: set() for segment in self._last}
        for merged_cell, own in self._merged_cells.items():
            touching = (
                (number, copy)
                for (number, copy), touched in self._last.items()
                if merged_cell in self._merged_cells_of[number]
                and (merged_cell not in kinds[number] or kinds[number][merged_cell] in touched)
            )
            cells[next(touching)] |= own
        return tuple(
            PlannedSegment(self._regions[number], frozenset(own))
            for (number, _), own in cells.items()
            if own
        )
