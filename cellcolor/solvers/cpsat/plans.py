"""Plans: which color regions get how many segments, and which segment touches which cell.

A plan looks at segments two at a time only. It can be made in milliseconds where the full model
takes seconds; where there is none with so many segments, there is no division of the surface with
so many either (docs/solver.md, "Plans").
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations, product

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds import Region
from cellcolor.solvers.conflicts import Conflict, conflicts

__all__ = ["Plan", "PlannedSegment", "Planner", "Undecided"]


@dataclass(frozen=True, slots=True)
class PlannedSegment:
    """A segment as planned.

    Attributes:
        region: the color region it lies in.
        cells: the cells that it is to touch, so that every cell is touched by some segment.
    """

    region: Region
    cells: frozenset[int]


Plan = tuple[PlannedSegment, ...]

MOST_CLAUSES = 1000
"""Around a cell with many petals nearly everything is in conflict, which the full model bounds
better; where plans help there are a few dozen."""

Solve = Callable[[cp_model.CpModel, int], tuple[cp_model.CpSolver, cp_model.CpSolverStatus]]

_Touched = dict[tuple[int, int], dict[int, cp_model.IntVar]]


class Undecided(Exception):
    """Within its limits the solver found neither a plan nor that there is none."""


class Planner:
    """Plans for an instance, with the conflicts found so far.

    Args:
        instance: the topological graph.
        regions: its color regions.
        fewest: so many regions at least are needed to touch every cell.
        solve: runs a model with a seed, within limits.
    """

    def __init__(
        self,
        instance: Instance,
        regions: Sequence[Region],
        fewest: int,
        solve: Solve,
    ) -> None:
        self._instance = instance
        self._regions = regions
        self._fewest = fewest
        self._solve = solve
        self._conflicts: dict[tuple[int, int], list[Conflict]] = {}

    def plan(self, segments: int, seed: int) -> Plan | None:
        """A plan with exactly so many segments, no two of which are known to be in conflict.

        Args:
            segments: how many, the smallest cover or more.
            seed: other seeds give other plans, where there are several.

        Returns:
            A plan, or None if it is proved that there is none.

        Raises:
            Undecided: the limits of the solver came first, or there are too many conflicts.
        """
        self._refuse_too_many(segments - self._fewest + 1)
        model = cp_model.CpModel()
        touched = self._add_segments(model, segments)
        for one, other in self._conflicts:
            self._add_conflicts(model, touched, one, other)
        solver, status = self._solve(model, seed)
        if status == cp_model.INFEASIBLE:
            return None
        if status != cp_model.OPTIMAL:
            raise Undecided
        return self._read(solver, touched)

    def find_conflicts(self, plan: Plan) -> bool:
        """Look at the plan's regions, two at a time; whether conflicts were found in new ones.

        Raises:
            Undecided: there are too many conflicts.
        """
        numbers = sorted({self._regions.index(segment.region) for segment in plan})
        new = [pair for pair in combinations(numbers, 2) if pair not in self._conflicts]
        for one, other in new:
            self._conflicts[one, other] = conflicts(
                self._instance, self._regions[one], self._regions[other]
            )
            self._refuse_too_many(1)
        return any(self._conflicts[pair] for pair in new)

    def _refuse_too_many(self, copies: int) -> None:
        if copies**2 * sum(map(len, self._conflicts.values())) > MOST_CLAUSES:
            raise Undecided

    def _add_segments(self, model: cp_model.CpModel, segments: int) -> _Touched:
        """Literals for the cells that each segment touches, by region and copy."""
        # The regions in use touch all cells, so there are at least the fewest different ones.
        copies = segments - self._fewest + 1
        touched: _Touched = {}
        used: list[cp_model.IntVar] = []
        touching: dict[int, list[cp_model.IntVar]] = {cell.id: [] for cell in self._instance.cells}
        for number, (_, cells) in enumerate(self._regions):
            for copy in range(copies):
                in_use = model.new_bool_var("")
                if copy:
                    model.add_implication(in_use, used[-1])
                used.append(in_use)
                touched[number, copy] = {cell: model.new_bool_var("") for cell in sorted(cells)}
                for cell, literal in touched[number, copy].items():
                    model.add_implication(literal, in_use)
                    touching[cell].append(literal)
        for literals in touching.values():
            model.add_bool_or(literals)
        model.add(sum(used) == segments)
        return touched

    def _add_conflicts(
        self, model: cp_model.CpModel, touched: _Touched, one: int, other: int
    ) -> None:
        """Each two segments of two regions heed all their conflicts."""
        touching: dict[tuple[int, int, frozenset[int]], cp_model.IntVar] = {}

        def in_area(region: int, copy: int, area: frozenset[int]) -> cp_model.IntVar:
            key = region, copy, area
            if key not in touching:
                touching[key] = model.new_bool_var("")
                for cell in sorted(area):
                    model.add_implication(touched[region, copy][cell], touching[key])
            return touching[key]

        copies = {copy for _, copy in touched}
        for conflict in self._conflicts[one, other]:
            for near, far in product(copies, repeat=2):
                areas = [in_area(one, near, area) for area in conflict.one]
                areas += [in_area(other, far, area) for area in conflict.other]
                model.add_bool_or(~literal for literal in areas)

    def _read(self, solver: cp_model.CpSolver, touched: _Touched) -> Plan:
        """The plan in which every cell is touched by one segment only."""
        left = {cell.id for cell in self._instance.cells}
        plan = []
        for (number, _), literals in touched.items():
            cells = {cell for cell, literal in literals.items() if solver.boolean_value(literal)}
            if cells:
                plan.append(PlannedSegment(self._regions[number], frozenset(cells & left)))
                left -= cells
        return tuple(plan)
