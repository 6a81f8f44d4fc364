"""Segment plans: which color regions get how many segments, and which cells each of them touches.

A segment plan looks at segments two at a time only. It can be made in milliseconds where the full
model takes seconds; where there is none with so many segments, there is no division of the surface
with so many either (docs/bounds.md, "Segment plans").
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.conflicts import Parting, RegionPair, Side
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_cells import merge_cells
from cellcolor.solvers.bounds.tangles import Tangle, Tangles
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed

__all__ = ["PlannedSegment", "Planner", "SegmentPlan", "Undecided"]


@dataclass(frozen=True, slots=True)
class PlannedSegment:
    """A segment as planned.

    Attributes:
        region: the color region it lies in.
        cells: the cells that it is to touch, so that every cell is touched by some segment.
    """

    region: Region
    cells: frozenset[int]


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

_Touched = dict[tuple[int, int], dict[int, cp_model.IntVar]]
_Touches = Callable[[int, int, Iterable[int]], cp_model.IntVar]
"""The literal that a segment, by region and copy, touches one of some merged cells."""


class Undecided(Exception):
    """Within its limits the solver found neither a plan nor that there is none."""


class Planner:
    """Plans for an instance, with the partings and tangles found so far (docs/bounds.md).

    Args:
        instance: the topological graph.
        regions: its color regions.
        fewest: so many regions at least are needed to touch every cell.
        solve: runs a model with a seed, within limits.
        deadline: when to stop looking for partings.
        cover: color regions that touch every cell, with which the first plan begins.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[Region],
        fewest: int,
        solve: SolveWithSeed,
        deadline: Deadline,
        cover: Sequence[Region] = (),
    ) -> None:
        self._instance = instance
        self._regions = regions
        self._fewest = fewest
        self._solve = solve
        self._deadline = deadline
        self._number = {region: number for number, region in enumerate(regions)}
        # A segment that touches one cell of a merged cell in which nothing separates its cells can
        # be grown over all of it, so that merged cells are all that a plan has to know.
        own = {cell.id: frozenset(cell.colors) for cell in instance.cells}
        self._merged = merge_cells(instance, own)
        self._merged_cells = self._merged.cells()
        self._merged_cells_of = [
            {self._merged.merged_cell_of[cell] for cell in cells} for _, cells in regions
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
        """A plan with exactly so many segments that heeds all partings and tangles found so far.

        Args:
            segments: how many, the smallest cover or more.
            seed: other seeds give other plans, where there are several.
            thoroughly: whether to heed far more partings, which takes longer.

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
        if sum(t.groups * copies ** len(t.segments) for t in self._tangles) > MOST_TANGLED:
            raise Undecided
        kinds = self._kinds()
        if copies * sum(len(set(own.values())) for own in kinds) > MOST_LITERALS:
            raise Undecided
        model = cp_model.CpModel()
        in_use, touched = self._add_segments(model, segments, kinds)
        touches = self._touches(model, touched, kinds)
        for one, other in self._partings:
            self._add_partings(model, touches, copies, one, other)
        self._add_tangles(model, touches, copies)
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
            for segment, literal in in_use.items()
            if solver.boolean_value(literal)
        }
        return self._read(kinds, seed)

    @property
    def partings(self) -> Iterator[tuple[Region, Region, Parting]]:
        """All partings found so far: of whose segments which two regions, and the parting."""
        for (one, other), partings in self._partings.items():
            for parting in partings:
                yield self._regions[one], self._regions[other], parting

    def find_conflicts(self, plan: SegmentPlan) -> bool:
        """Look for segments of a plan that cannot all be drawn; whether there are any.

        Raises:
            OutOfTime: the deadline came first.
        """
        return self.find_partings(plan) or self._find_tangles(plan)

    def find_partings(self, plan: SegmentPlan) -> bool:
        """Look for segments of a plan that would cross; whether there are any.

        Raises:
            OutOfTime: the deadline came first.
        """
        return any(self._find(plan, every) for every in (False, True))

    def _find_tangles(self, plan: SegmentPlan) -> bool:
        """Look for segments that fit two at a time only."""
        if self._surface is None:
            self._surface = Tangles(self._merged, self._regions)
        touching = [(self._number[s.region], tuple(sorted(self._held(s.cells)))) for s in plan]
        found = self._surface.find(touching, self._deadline)
        self._tangles += found
        return bool(found)

    def _find(self, plan: SegmentPlan, every: bool) -> bool:
        """Look at curves from one merged cell of each segment, or from every one of a few."""
        found = 0
        for one, other in combinations(plan, 2):
            first, second = sorted((one, other), key=lambda s: self._number[s.region])
            numbers = self._number[first.region], self._number[second.region]
            if first.region[0] == second.region[0] or first.region[1].isdisjoint(second.region[1]):
                continue
            if numbers not in self._pairs:
                self._deadline.check()
                self._pairs[numbers] = RegionPair(self._instance, first.region, second.region)
            pair = self._pairs[numbers]
            for key, side, own, parted in (
                (numbers, pair.first, first, second),
                (numbers[::-1], pair.second, second, first),
            ):
                held = {pair.merged_cell_of(cell) for cell in own.cells}
                ends = [merged_cell for merged_cell in side.merged_cells if merged_cell in held]
                for parting in self._violated(key, side, ends, parted.cells, every):
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
    ) -> Iterator[Parting]:
        """New partings, by a segment that touches some merged cells, of the cells of another
        segment."""
        starts = range(min(MOST_STARTS, len(ends))) if every else range(1)
        for near, far in ((ends[n], merged_cell) for n in starts for merged_cell in ends[n + 1 :]):
            if (key, near, far) in self._looked_at:
                continue
            self._deadline.check()
            for parting in side.partings(near, far):
                touched = (
                    any(not merged_cell.isdisjoint(cells) for merged_cell in group)
                    for group in parting.groups
                )
                if sum(touched) > 1:
                    self._looked_at.add((key, near, far))
                    yield parting

    def _kinds(self) -> list[dict[int, int]]:
        """Of each region the merged cells that partings or tangles name, the first of their kind.

        Merged cells that are ends of the same partings, and in the same groups, are of one kind: a
        segment that touches one of them may touch all. Those that none names any segment of
        the region can touch, so that nothing has to be decided about them.
        """
        places: list[dict[int, list[int]]] = [{} for _ in self._regions]
        number = 0
        for region, groups in (own for tangle in self._tangles for own in tangle.segments):
            for merged_cells in groups:
                number += 1
                for merged_cell in merged_cells:
                    places[region].setdefault(merged_cell, []).append(number)
        for (one, other), partings in self._partings.items():
            for parting in partings:
                ends = ((one, (end,)) for end in parting.ends)
                for region, group in (*ends, *((other, group) for group in parting.groups)):
                    number += 1
                    for merged_cell in self._held(frozenset().union(*group)):
                        places[region].setdefault(merged_cell, []).append(number)
        kinds: list[dict[int, int]] = []
        for own in places:
            first: dict[tuple[int, ...], int] = {}
            kinds.append({m: first.setdefault(tuple(own[m]), m) for m in sorted(own)})
        return kinds

    def _held(self, cells: frozenset[int]) -> set[int]:
        """The merged cells that some cells are parts of."""
        return {self._merged.merged_cell_of[cell] for cell in cells}

    def _add_segments(
        self, model: cp_model.CpModel, segments: int, kinds: Sequence[dict[int, int]]
    ) -> tuple[dict[tuple[int, int], cp_model.IntVar], _Touched]:
        """Literals for the segments in use and for what each touches, by region and copy."""
        # The regions in use touch all cells, so there are at least the fewest different ones.
        copies = segments - self._fewest + 1
        in_use: dict[tuple[int, int], cp_model.IntVar] = {}
        touched: _Touched = {}
        touching: dict[int, list[cp_model.IntVar]] = {
            merged_cell: [] for merged_cell in self._merged_cells
        }
        for number, merged_cells in enumerate(self._merged_cells_of):
            for copy in range(copies):
                in_use[number, copy] = own = model.new_bool_var("")
                model.add_hint(own, (number, copy) in self._last)
                if copy:
                    model.add_implication(own, in_use[number, copy - 1])
                touched[number, copy] = {}
                last = self._last.get((number, copy), ())
                for kind in sorted(set(kinds[number].values())):
                    touched[number, copy][kind] = literal = model.new_bool_var("")
                    model.add_implication(literal, own)
                    model.add_hint(literal, kind in last)
                for merged_cell, kind in kinds[number].items():
                    touching[merged_cell].append(touched[number, copy][kind])
            for merged_cell in merged_cells - kinds[number].keys():
                touching[merged_cell].append(in_use[number, 0])
        # Most merged cells are touched wherever another one is.
        different = {tuple(literal.index for literal in own): own for own in touching.values()}
        for literals in different.values():
            model.add_bool_or(literals)
        model.add(sum(in_use.values()) == segments)
        return in_use, touched

    def _touches(
        self, model: cp_model.CpModel, touched: _Touched, kinds: Sequence[dict[int, int]]
    ) -> _Touches:
        touching: dict[tuple[int, int, frozenset[int]], cp_model.IntVar] = {}

        def touches(region: int, copy: int, merged_cells: Iterable[int]) -> cp_model.IntVar:
            key = region, copy, frozenset(kinds[region][m] for m in merged_cells)
            if key not in touching:
                touching[key] = model.new_bool_var("")
                for kind in sorted(key[2]):
                    model.add_implication(touched[region, copy][kind], touching[key])
            return touching[key]

        return touches

    def _add_partings(
        self, model: cp_model.CpModel, touches: _Touches, copies: int, one: int, other: int
    ) -> None:
        """No segment of a region touches two groups that a segment of another one parts."""
        for parting in self._partings[one, other]:
            own = [self._held(merged_cell) for merged_cell in parting.ends]
            groups = [self._held(frozenset[int]().union(*group)) for group in parting.groups]
            for near, far in product(range(copies), repeat=2):
                ends = [touches(one, near, merged_cells) for merged_cells in own]
                parted = [touches(other, far, group) for group in groups]
                model.add(sum(parted) <= 1).only_enforce_if(ends)

    def _add_tangles(self, model: cp_model.CpModel, touches: _Touches, copies: int) -> None:
        """Some group of each tangle is not touched, whichever segments its regions get."""
        for tangle in self._tangles:
            regions = [region for region, _ in tangle.segments]
            for chosen in product(range(copies), repeat=len(regions)):
                segments = list(zip(regions, chosen, strict=True))
                if len(set(segments)) == len(segments):  # none is beside itself
                    model.add_bool_or(
                        ~touches(*segment, group)
                        for segment, (_, groups) in zip(segments, tangle.segments, strict=True)
                        for group in groups
                    )

    def _read(self, kinds: Sequence[dict[int, int]], seed: int) -> SegmentPlan:
        """The last plan, in which every cell is touched by one segment only."""
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
        return tuple(
            PlannedSegment(self._regions[number], frozenset(own))
            for (number, _), own in cells.items()
            if own
        )
