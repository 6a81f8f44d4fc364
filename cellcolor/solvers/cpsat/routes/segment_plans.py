"""Segment plans: which color regions get how many segments, and which cells each of them touches.

A segment plan compares segments only two at a time, or by tangles. It can be made in milliseconds
where the full model takes seconds. If there is no plan with a number of segments, there is no such
division of the surface either (docs/bounds/conflicts.md, "Segment plans").
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.conflicts import Parting, RegionPair, Side
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.merged_surface import merge_cells
from cellcolor.solvers.bounds.tangles import Tangle, Tangles, Touching
from cellcolor.solvers.cpsat.model_runs import SolveWithSeed

PartedCells = Mapping[
    tuple[int, int], Sequence[tuple[Sequence[frozenset[int]], Sequence[frozenset[int]]]]
]
"""Of the numbers of two color regions the partings: merged cells at both ends of a segment of the
one, and the groups of merged cells of the other that it parts."""

_Segment = tuple[int, int]
"""The number of a color region, and that of one of its segments."""


class PlanCells:
    """The merged cells that a plan is about.

    Args:
        of_region: the merged cells of each color region.
        parted: the partings that a plan has to satisfy.
        tangles: the tangles that a plan has to satisfy.

    Attributes:
        regions_of: the color regions of each merged cell.
        kinds: of each color region the merged cells that partings or tangles name, with the first
            of their kind. Merged cells that are ends of the same partings, and in the same groups,
            are of one kind: a segment that touches one of them may touch all. Those that none
            names any segment of the region can touch, so that nothing has to be decided about them.
    """

    def __init__(
        self,
        of_region: Sequence[frozenset[int]],
        parted: PartedCells,
        tangles: Sequence[Tangle],
    ) -> None:
        self.of_region = of_region
        self.regions_of: dict[int, list[int]] = {}
        for region, merged_cells in enumerate(of_region):
            for merged_cell in sorted(merged_cells):
                self.regions_of.setdefault(merged_cell, []).append(region)
        self.parted = parted
        self.tangles = tangles
        places: list[dict[int, list[int]]] = [{} for _ in of_region]
        for number, (region, merged_cells) in enumerate(self._named()):
            for merged_cell in merged_cells:
                places[region].setdefault(merged_cell, []).append(number)
        self.kinds: list[dict[int, int]] = []
        for own in places:
            first: dict[tuple[int, ...], int] = {}
            self.kinds.append({m: first.setdefault(tuple(own[m]), m) for m in sorted(own)})

    def demands(self) -> Iterator[int]:
        """Merged cells such that a plan touches all others wherever it touches these.

        A merged cell is touched where another one is if it lies in all regions of that one, and is
        of its kind there, or of none.
        """
        different: dict[tuple[tuple[int, int | None], ...], int] = {}
        for merged_cell, regions in self.regions_of.items():
            key = tuple((region, self.kinds[region].get(merged_cell)) for region in regions)
            different.setdefault(key, merged_cell)
        cells_with: dict[int, set[int]] = {}
        of = {merged_cell: dict(key) for key, merged_cell in different.items()}
        for merged_cell, own in of.items():
            for region in own:
                cells_with.setdefault(region, set()).add(merged_cell)
        implied: set[int] = set()
        for merged_cell, own in of.items():
            for other in set.intersection(*(cells_with[region] for region in own)):
                its = of[other]
                if other != merged_cell and all(its[r] in (None, kind) for r, kind in own.items()):
                    implied.add(other)
        return (merged_cell for merged_cell in of if merged_cell not in implied)

    def kinds_of(self, region: int, merged_cells: Iterable[int]) -> frozenset[int]:
        """The kinds of some merged cells of a region."""
        return frozenset(self.kinds[region][merged_cell] for merged_cell in merged_cells)

    def _named(self) -> Iterable[tuple[int, frozenset[int]]]:
        """Sets of merged cells that partings or tangles name, each with its region."""
        for tangle in self.tangles:
            for segment in tangle.segments:
                for merged_cells in (*segment.groups, segment.avoided):
                    yield segment.region, merged_cells
        for (one, other), partings in self.parted.items():
            for ends, groups in partings:
                yield from ((one, end) for end in ends)
                yield from ((other, group) for group in groups)


class PlanModel:
    """A plan with an exact number of segments.

    Args:
        cells: what the plan is about.
        segments: how many.
        copies: how many of them one region may have.
        last: the kinds that each segment of the last plan touches, for a hint.

    Attributes:
        model: the model.
        in_use: the literals of all segments that there may be.
        touched: for each of these the literals of the kinds that it touches.
    """

    def __init__(
        self,
        cells: PlanCells,
        segments: int,
        copies: int,
        last: Mapping[_Segment, set[int]],
    ) -> None:
        self.model = cp_model.CpModel()
        self.in_use: dict[_Segment, cp_model.IntVar] = {}
        self.touched: dict[_Segment, dict[int, cp_model.IntVar]] = {}
        self._cells = cells
        self._copies = copies
        self._touching: dict[tuple[_Segment, frozenset[int]], cp_model.IntVar] = {}
        self._add_segments(last)
        self.model.add(sum(self.in_use.values()) == segments)
        self._add_cover()
        for one, other in cells.parted:
            self._add_partings(one, other)
        for tangle in cells.tangles:
            self._add_tangle(tangle)

    def _add_segments(self, last: Mapping[_Segment, set[int]]) -> None:
        """Literals for the segments in use and for what each touches."""
        model = self.model
        for segment in product(range(len(self._cells.of_region)), range(self._copies)):
            region, copy = segment
            self.in_use[segment] = own = model.new_bool_var("")
            model.add_hint(own, segment in last)
            if copy:
                model.add_implication(own, self.in_use[region, copy - 1])
            self.touched[segment] = {}
            for kind in sorted(set(self._cells.kinds[region].values())):
                self.touched[segment][kind] = literal = model.new_bool_var("")
                model.add_implication(literal, own)
                model.add_hint(literal, kind in last.get(segment, ()))

    def _add_cover(self) -> None:
        """Every merged cell is touched by some segment."""
        for merged_cell in self._cells.demands():
            literals = []
            for region in self._cells.regions_of[merged_cell]:
                kind = self._cells.kinds[region].get(merged_cell)
                if kind is None:
                    literals.append(self.in_use[region, 0])
                else:
                    own = range(self._copies)
                    literals += [self.touched[region, copy][kind] for copy in own]
            self.model.add_bool_or(literals)

    def _touches(self, segment: _Segment, merged_cells: Iterable[int]) -> cp_model.IntVar:
        """A literal that is true where a segment touches one of some merged cells."""
        key = segment, self._cells.kinds_of(segment[0], merged_cells)
        if key not in self._touching:
            self._touching[key] = self.model.new_bool_var("")
            for kind in sorted(key[1]):
                self.model.add_implication(self.touched[segment][kind], self._touching[key])
        return self._touching[key]

    def _add_partings(self, one: int, other: int) -> None:
        """No segment of a region touches two groups that a segment of another one parts."""
        for own, groups in self._cells.parted[one, other]:
            for near, far in product(range(self._copies), repeat=2):
                ends = [self._touches((one, near), merged_cells) for merged_cells in own]
                parted = [self._touches((other, far), group) for group in groups]
                self.model.add(sum(parted) <= 1).only_enforce_if(ends)

    def _add_tangle(self, tangle: Tangle) -> None:
        """Whichever segments its regions get, they do not touch some group, or do touch what they
        would have to avoid."""
        for chosen in product(range(self._copies), repeat=len(tangle.segments)):
            segments = [(s.region, copy) for s, copy in zip(tangle.segments, chosen, strict=True)]
            if len(set(segments)) < len(segments):
                continue  # none is beside itself
            literals: list[cp_model.LiteralT] = []
            for segment, own in zip(segments, tangle.segments, strict=True):
                literals += [~self._touches(segment, group) for group in own.groups]
                kinds = self._cells.kinds_of(segment[0], own.avoided)
                literals += [self.touched[segment][kind] for kind in sorted(kinds)]
            self.model.add_bool_or(literals)


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
(``bounds/merged_surface.py``) and each segment that may touch it."""

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
