"""Plans for the segments of a part, and divisions made by routing them.

A plan says of each segment its color and the cells that it has a share in; ``routes`` has both.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.cpsat.model.painting import canonical
from cellcolor.solvers.cpsat.part_state import PartState
from cellcolor.solvers.cpsat.routes.recoloring import FEW_MOVES
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import refined
from cellcolor.solvers.cpsat.routes.segment_plans import (
    Planner,
    Quota,
    SegmentPlan,
    Undecided,
)

PLAN_EFFORT, MORE_EFFORT, GROWTH = 0.05, 2.0, 4
"""Deterministic seconds for a plan; most take a hundredth of the first number. The second one is
for plans that were left undecided, and grows by the factor with each further turn."""

FIRST_ROUNDS, ROUNDS = 20, 60
"""Rounds of routing before crossing segments are looked for in a plan, and after. A plan that can
be routed takes a few."""

LEVELS = ((1, 0.1), (2, 0.2), (0, 0.7)), ((1, 1.0), (2, 0.2))
"""How much of a linear relaxation plans are made with that were left undecided, and the share of
the effort; on large parts the second row. Plans of many segments are ruled out by a full
relaxation, by a small one or by none, hardly ever by all of these. On large parts a full one takes
longest, and seldom says more."""

LITTLE = 2
"""With a gap of up to so many segments, plans of large parts may also say which cells segments
avoid."""

WIDE_GAP = 2
"""With so many segments above the bound, divisions and plans are improved in turns first, since a
model is not likely to close the gap; and small parts are routed by plans of which any two segments
fit."""

SHARE_OF_BOTH = 0.25
"""The share of the effort for drawing the segments of two plans together."""

ATTEMPTS = 3
"""Plans to route before the full model has to decide; with more effort only one of a large part."""


Draw = Callable[[Planner, Quota, float, Deadline], bool | None]
"""Decides whether a division keeps to a quota (``ModelSearch.draw``)."""


class Planning:
    """Plans a part, and plans it on.

    Attributes:
        planner: what has planned its segments; None before.
        effort: deterministic seconds for a plan, of the last ones.
    """

    def __init__(self, part: PartState) -> None:
        self._part = part
        self.planner: Planner | None = None
        self.effort = PLAN_EFFORT
        self._undecided = False
        self._avoiding = False
        self._routed_at = 0
        # For a number of segments, quotas to which no division keeps that has so many.
        self._refused: dict[int, list[Quota]] = {}
        self._deadline = part.options.deadline

    def route(self, deadline: Deadline) -> None:
        """Divisions by routing what is planned; where nothing can be planned the bound rises."""
        self.planner = planner = Planner(
            self._part.instance,
            self._part.regions,
            self._part.cover_bound,
            self._solve_plan,
            self._part.planned,
            at_once=not self._part.large,
        )
        self._undecided = True
        with suppress(Undecided):
            self._route_all(planner, deadline)

    def go_on(self, deadline: Deadline) -> None:
        """Plan what was left undecided with more effort, unless hubs give a better bound."""
        if self._undecided:
            self._plan_with_effort(MORE_EFFORT, deadline)

    def decide(self, draw: Draw, deadline: Deadline) -> None:
        """Decide plan by plan whether its segments can be drawn, until one can be or none is left.

        If none is left, the bound rises, and it goes on with one segment more. What is proved so is
        true in the search space only, because it limits how many segments cross an edge.

        Args:
            draw: see there.
        """
        if self.planner is None or self._part.hubs is not None:
            return
        self._avoiding = True
        self._deadline = deadline
        self.effort = GROWTH * self.effort if self._thorough else MORE_EFFORT
        with suppress(Undecided):
            while not self._part.done:
                plan = self._plan_that_holds(self.planner, 0, deadline)
                if not self._rare:
                    self._route(plan, 1, ROUNDS, 0, deadline)
                if not self._part.done:
                    self._draw(self.planner, draw, deadline)

    def _draw(self, planner: Planner, draw: Draw, deadline: Deadline) -> None:
        """Draw the last plan, or refuse how many segments its regions have, and other plans, too.

        The quota that was refused last grows as long as that takes little effort. So a few models
        decide about many plans.

        Raises:
            Undecided: that takes more effort.
        """
        quota = planner.quota
        refused = self._refused.setdefault(self._part.bound, [])
        if refused:
            both = {region: max(most, quota.get(region, 0)) for region, most in refused[-1].items()}
            both = {**quota, **both}
            drawn = draw(planner, both, SHARE_OF_BOTH * self.effort, deadline)
            if drawn is False:
                refused[-1] = both
            if drawn is not None:
                return
        drawn = draw(planner, quota, self.effort, deadline)
        if drawn is None:
            raise Undecided
        if not drawn:
            refused.append(quota)

    def avoid(self, deadline: Deadline) -> None:
        """Plans of a large part that say what segments avoid, too, with few segments left.

        The bound rises by one in seconds, if at all. If the gap is larger, other routes use the
        time better.
        """
        if self._part.segments <= self._part.bound + LITTLE:
            self._avoiding = True
            self._plan_with_effort(MORE_EFFORT, deadline)

    def insist(self, deadline: Deadline) -> None:
        """Both again on a large part, as long as something is undecided, with more effort."""
        if self._undecided:
            effort = GROWTH * self.effort if self._thorough else MORE_EFFORT
            self._plan_with_effort(effort, deadline)
        elif not self._avoiding:
            self.avoid(deadline)

    def _plan_with_effort(self, effort: float, deadline: Deadline) -> None:
        if self.planner is not None and self._part.hubs is None:
            self.effort, self._undecided = effort, True
            with suppress(Undecided):
                self._route_all(self.planner, deadline)

    def _route_all(self, planner: Planner, deadline: Deadline) -> None:
        self._deadline = deadline
        for attempt in range(1 if self._part.large and self._thorough else ATTEMPTS):
            plan = self._plan_that_holds(planner, attempt, deadline)
            self._undecided = False
            for rings in (1,) if self._part.large else (1, 2):
                self._route(plan, rings, ROUNDS, attempt, deadline)
            if self._part.done:
                return
        looser = planner.plan(self._part.bound + 1, 0)
        if looser is not None:
            self._route(looser, 1, ROUNDS, 0, deadline)

    def _plan_that_holds(self, planner: Planner, attempt: int, deadline: Deadline) -> SegmentPlan:
        """A plan with as many segments as the bound in which no two are known to cross.

        Raises:
            Undecided: none was found, nor that there is none; or the part is done.
        """
        while not self._part.done:
            deadline.check()
            refused = self._refused.get(self._part.bound, ())
            plan = planner.plan(self._part.bound, attempt, self._thorough, refused)
            if plan is None:
                self._part.raise_to(self._part.bound + 1, for_surface=not refused)
                if not refused and not planner.heeds_conflicts:
                    self._part.cover_bound = self._part.bound  # nothing but the cells was heeded
                continue
            self._part.planned = [segment.region for segment in plan]
            for rings in self._rings_before_conflicts():
                self._route(plan, rings, FIRST_ROUNDS, attempt, deadline)
            if self._part.done:
                return plan
            if self._rare:
                if planner.find_partings(plan, deadline):
                    continue
                self._route(plan, 1, ROUNDS, attempt, deadline)
                if self._part.done:
                    return plan
            if not planner.find_conflicts(plan, deadline, avoiding=self._avoiding):
                return plan
        raise Undecided  # and nothing is left to decide

    def _solve_plan(
        self, model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        # Too small for a portfolio.
        for level, share in LEVELS[self._part.large] if self._thorough else ((None, 1.0),):
            solver = self._part.runner.single(share * self.effort, seed, self._deadline)
            if level is not None:
                solver.parameters.linearization_level = level
            status = self._part.runner.solve(solver, model)
            if status != cp_model.UNKNOWN:
                break
        return solver, status

    def _rings_before_conflicts(self) -> tuple[int, ...]:
        """With how many rings of sectors a plan is routed before conflicts are looked for in it.

        That takes longer than routing when there are none, except on large parts: there one plan
        for each bound is enough of a start for local search. With 0 rings a cell is painted whole,
        with 1 it has room for cutting paths.
        """
        if self._avoiding or (self._part.large and self._thorough):
            return ()
        if not self._part.large:
            return 0, 1
        known, self._routed_at = self._routed_at, self._part.bound
        return () if known == self._part.bound else (1,)

    @property
    def _rare(self) -> bool:
        """Whether hardly any plan holds, and others may well lead to better divisions."""
        wide = self._part.segments >= self._part.bound + WIDE_GAP
        return self._avoiding and wide and not self._part.large

    @property
    def _thorough(self) -> bool:
        """Whether this is for plans that were left undecided."""
        return self.effort > PLAN_EFFORT

    def _route(
        self, plan: SegmentPlan, rings: int, rounds: int, seed: int, deadline: Deadline
    ) -> None:
        if self._part.done:
            return
        graph = self._part.narrow_graph()
        seed += self._part.options.seed
        routed = canonical(graph, route(refined(graph, rings), plan, rounds, seed, deadline))
        self._part.keep(graph, routed)
        if self._part.large:
            # Routed as planned it has many fragments, and yet it is the best start that there is.
            self._part.recolor(graph, routed, seed, deadline, FEW_MOVES)
