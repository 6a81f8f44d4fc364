"""The search for the fewest segments of one part: bounds, plans, routes, and the full model.

A part is what live edges connect (``parts``). A strand is one of the parallel corridors by which
segments may cross an edge, or a seam between two loops of a cell (docs/semantics.md, sections 4
and 5).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from math import ceil, isfinite

from ortools.sat.python import cp_model

from cellcolor.data.solution import Seam
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import color_regions, greedy_strangers, set_cover
from cellcolor.solvers.bounds.crossings import enough_crossings
from cellcolor.solvers.bounds.hubs import HubBound, hub_bound
from cellcolor.solvers.cpsat.hubs.division import divide_hubs
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph, widened
from cellcolor.solvers.cpsat.model.full import (
    LARGEST_MODEL,
    SECONDS_A_TERM,
    Model,
    add_hint,
    full_model,
    model_size,
    not_built,
    read_painting,
    seams_size,
)
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, moved, segments_of
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.parts import ConnectedPart
from cellcolor.solvers.cpsat.routes.dropping import FRUITLESS, drop_segments
from cellcolor.solvers.cpsat.routes.routing import route
from cellcolor.solvers.cpsat.routes.sectors import refined
from cellcolor.solvers.cpsat.routes.segment_plans import Planner, SegmentPlan, Undecided
from cellcolor.solvers.cpsat.windows import improve
from cellcolor.solvers.interface import PORTFOLIO, Options

__all__ = ["PartSearch"]

FEW_STRANDS = 2
"""Strands of a seam in the first models. More would only be needed if their result did not meet the
lower bound."""

PLAN_EFFORT, MORE_EFFORT = 0.05, 2.0
"""Deterministic seconds for a plan; most take a hundredth of the first number. The second one is
for plans that were left undecided, before the full model is tried."""

LARGE_MODEL = 200_000
"""Terms of a part's model; a larger part is first improved window by window."""

WIDE_GAP, SHARE_OF_ROUTES = 2, 1 / 4
"""Segments above the bound from which other routes are tried before models; and what part of the
time that is left one kind of them gets before the other has its turn."""

MORE_TRIES = 10
"""Segments left out in vain for each segment, once other routes have their turns."""

TURNS = 2
"""Turns of both kinds in a row without a better division before models are tried all the same."""

WINDOW_EFFORT = 0.1
"""Deterministic seconds for the model of a window."""

FIRST_ROUNDS, ROUNDS = 20, 60
"""Rounds of routing before crossing segments are looked for in a plan, and after. A plan that can
be routed takes a few."""

FAR = 2
"""How many times the bound a large part may have after its first routes to be planned further."""

FEW_DARTS = 10
"""The live darts of a cell up to which planning comes before counting links."""

ATTEMPTS = 3
"""Plans to route before the full model has to decide."""

TRIAL_EFFORT = 2.0
"""Deterministic seconds a worker for a model that is not the widest: its bound proves nothing."""


class PartSearch:
    """The best division of a part so far, and what is proved of it.

    Attributes:
        segments: of the best division.
        bound: no division in the search space has fewer segments.
        surface_bound: no division of the surface has fewer.
        best: the best division, on its dart graph.
        instance: the part's, in the colors that are left of each cell.
        cells: the cell of the whole instance that each cell of the part is.
        cover_bound: the size of a smallest cover, or what is proved of it.
        planner: what has planned its segments; None before.
        hubs: what counting links in hubs proves; None unless that is more than all before it.
        notes: what was left out and why, a sentence each.
    """

    def __init__(
        self, part: ConnectedPart, options: Options, runner: Runner, report: Callable[[], None]
    ) -> None:
        self._part = part
        self.instance = part.instance
        self._options = options
        self._runner = runner
        self._report = report
        self._colors = tuple(frozenset(cell.colors) for cell in part.instance.cells)
        self._enough = enough_crossings(part.instance, self._colors)
        self._once = dict.fromkeys(self._enough, 1)
        self.bound = self.surface_bound = len(greedy_strangers(part.instance))
        self.cells = part.cells
        self.cover_bound = self.bound
        self.planner: Planner | None = None
        self.hubs: HubBound | None = None
        self.notes: list[str] = []
        self._running: int | None = None
        self._plan_effort = PLAN_EFFORT
        self._undecided = False
        self._avoiding = False
        self._tries = 0
        graph = self._graph(self._once, self._seams(self._once, FEW_STRANDS))
        whole: Painting = [[Block(min(colors), set())] for colors in self._colors]
        self.best = graph, canonical(graph, whole)
        self.segments = len(segments_of(*self.best))

    @property
    def done(self) -> bool:
        """Whether the best division is proved, or there is no time left."""
        return self.segments == self.bound or self._runner.over

    @property
    def known(self) -> int:
        """Segments of the best division, that of a model that is still running included."""
        return self.segments if self._running is None else min(self.segments, self._running)

    @property
    def proved_for_surface(self) -> int:
        """No division of the surface has fewer segments.

        Where more corridors across an edge are never needed, the bound is one for the surface.
        """
        wide = all(enough <= self._options.strands for enough in self._enough.values())
        return self.bound if wide else self.surface_bound

    def cover(self, deadline: Deadline) -> None:
        """The first bound, and a division that follows from a smallest cover."""
        self._regions = color_regions(self.instance)
        found = set_cover(self.instance, None, deadline)
        self.cover_bound = max(self.bound, found.bound)
        self._planned = found.regions
        self._raise(found.bound)
        color_of = {cell: color for color, cells in found.regions for cell in cells}
        whole: Painting = [[Block(color_of[c.id], set())] for c in self.instance.cells]
        self._offer(self.best[0], whole)

    def count_links(self, deadline: Deadline, *, before_plans: bool) -> None:
        """A bound by what fits side by side in cells with many edges, and a division like it.

        Args:
            deadline: when to end.
            before_plans: whether nothing has been planned yet. That is the time for cells with more
                than ``FEW_DARTS`` live darts. For others it comes after plans, which are quick
                there, and whose conflicts have four areas that can be drawn.
        """
        if before_plans != (self.instance.most_live_darts > FEW_DARTS):
            return
        found = hub_bound(self.instance, deadline)
        if found.value > self.surface_bound:
            self._raise(found.value)
            self.hubs = found
        if found.hubs:
            whole = {cell: color for color, cells in self._planned for cell in cells}
            self._offer(*divide_hubs(self._part, found.hubs, whole, self._options.seed, deadline))

    def route_plans(self, deadline: Deadline) -> None:
        """Divisions by routing what is planned; where nothing can be planned the bound rises."""
        self.planner = planner = Planner(
            self.instance,
            self._regions,
            self.cover_bound,
            self._solve_plan,
            self._planned,
        )
        self._undecided = True
        with suppress(Undecided):
            self._route_all(planner, deadline)
            self._undecided = False

    def plan_on(self, deadline: Deadline) -> None:
        """What was left undecided is planned with more effort, where hubs do not say more."""
        if self._undecided:
            self._plan_with_effort(deadline)

    def plan_avoiding(self, deadline: Deadline) -> None:
        """Plans that say what segments avoid, too, where one segment is left above the bound.

        The bound rises by one in seconds, if at all. Where more is missing, models and other routes
        have the better use of the time.
        """
        if self.segments == self.bound + 1:
            self._avoiding = True
            self._plan_with_effort(deadline)

    def _plan_with_effort(self, deadline: Deadline) -> None:
        if self.planner is not None and self.hubs is None:
            self._plan_effort = MORE_EFFORT
            with suppress(Undecided):
                self._route_all(self.planner, deadline)

    def _route_all(self, planner: Planner, deadline: Deadline) -> None:
        for attempt in range(ATTEMPTS):
            plan = self._plan_that_holds(planner, attempt, deadline)
            for rings in (1, 2):
                self._route(plan, rings, ROUNDS, attempt, deadline)
            if self.done:
                return
        looser = planner.plan(self.bound + 1, 0)
        if looser is not None:
            self._route(looser, 1, ROUNDS, 0, deadline)

    def _plan_that_holds(self, planner: Planner, attempt: int, deadline: Deadline) -> SegmentPlan:
        """A plan with as many segments as the bound in which no two are known to cross.

        Raises:
            Undecided: none was found, nor that there is none.
            OutOfTime: the deadline came first.
        """
        while True:
            deadline.check()
            plan = planner.plan(self.bound, attempt, self._plan_effort > PLAN_EFFORT)
            if plan is None:
                self._raise(self.bound + 1)
                continue
            self._planned = [segment.region for segment in plan]
            # Looking for segments that cross takes longer than routing when none do. With 0 rings
            # a cell is painted whole, with 1 it has room for cutting paths. What has been planned
            # and not routed before is not likely to be routed now.
            for rings in () if self._avoiding else (0, 1):
                self._route(plan, rings, FIRST_ROUNDS, attempt, deadline)
                if self.large and self.segments > FAR * self.bound:
                    raise Undecided  # windows first: on so large a part all this takes too long
            if self.done or not planner.find_conflicts(plan, deadline, avoiding=self._avoiding):
                return plan

    def drop_segments(self, deadline: Deadline) -> None:
        """Better divisions by leaving out a segment and routing all others anew.

        Around hubs the model is the better way, as it is to their bound.
        """
        if self.hubs is None and not self.large:
            self._drop(self._options.seed, deadline, FRUITLESS)

    def improve_large(self, deadline: Deadline) -> None:
        """Better divisions by solving some cells at a time anew, of a part too large for more."""
        if self.large:
            self._improve(self._options.seed, deadline)

    def narrow_gap(self, deadline: Deadline) -> None:
        """Other routes and windows, where more is missing than a model is likely to close."""
        in_vain = 0
        while in_vain < TURNS and self.hubs is None and self.segments - self.bound >= WIDE_GAP:
            before = self.segments
            self._take_turns(deadline)
            in_vain = 0 if self.segments < before else in_vain + 1

    def improve_on(self, deadline: Deadline) -> None:
        """Better divisions by other routes and windows, as long as there is time."""
        while isfinite(deadline.moment) and not self.done:
            self._take_turns(deadline)

    def _take_turns(self, deadline: Deadline) -> None:
        """Segments left out, then windows, with another seed than before."""
        deadline.check()
        self._tries += 1
        seed = self._options.seed + self._tries
        if not self.large:
            self._drop(seed, deadline.share(SHARE_OF_ROUTES), MORE_TRIES)
        self._improve(seed, deadline.share(SHARE_OF_ROUTES))

    @property
    def large(self) -> bool:
        """Whether it is improved window by window before a model of the whole is thought of."""
        return model_size(self.best[0]) >= LARGE_MODEL

    def _drop(self, seed: int, deadline: Deadline, tries: float) -> None:
        graph, painting = self.best
        for better in drop_segments(graph, painting, self._regions, seed, deadline, tries):
            self._keep(graph, better)
            if self.done:
                return

    def _improve(self, seed: int, deadline: Deadline) -> None:
        graph, painting = self.best
        for better in improve(graph, painting, self._solve_window, seed, deadline):
            self._keep(graph, better)
            if self.done:
                return

    def _solve_window(
        self, model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = self._runner.solver(WINDOW_EFFORT, workers=1, seed=seed)
        return solver, self._runner.solve(solver, model)

    def solve_small_model(self, deadline: Deadline) -> None:
        """The full model in the colors of the last plan only."""
        colors = tuple(
            frozenset(color for color, cells in self._planned if cell.id in cells)
            for cell in self.instance.cells
        )
        if all(colors) and colors != self._colors:
            seams = self._seams(self._once, FEW_STRANDS)
            self._minimize(self._once, seams, colors, deadline, final=False)

    def solve_model(self, deadline: Deadline) -> None:
        """The full model, with as many strands as were asked for and seams can need."""
        stages = self._stages()
        for number, stage in enumerate(stages):
            if not self.done and stages.index(stage) == number:
                self._minimize(*stage, self._colors, deadline, final=stage == stages[-1])

    @property
    def widest(self) -> dict[int, int]:
        """As many strands of each live edge as were asked for and can be needed."""
        most = self._options.strands
        return {edge: int(min(most, enough)) for edge, enough in self._enough.items()}

    def _stages(self) -> list[tuple[dict[int, int], tuple[Seam, ...]]]:
        """Strands and seams, from narrow ones to as wide ones as can be needed."""
        wanted = self.widest
        # The paper's divisions are among the surface's, and usually enough for the bound.
        widths = [self._once, wanted] if wanted != self._once else [wanted]
        return [
            (strands, self._seams(strands, width))
            for strands in widths
            for width in (FEW_STRANDS, None)
        ]

    def _solve_plan(
        self, model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        # Too small for a portfolio.
        solver = self._runner.solver(self._plan_effort, workers=1, seed=seed)
        if self._plan_effort > PLAN_EFFORT:
            # What takes effort are plans of many segments. As with covers (``bounds/cover``), it is
            # the linear relaxation that tells that there are none. Small plans are quicker without.
            solver.parameters.linearization_level = 2
        return solver, self._runner.solve(solver, model)

    def _route(
        self, plan: SegmentPlan, rings: int, rounds: int, seed: int, deadline: Deadline
    ) -> None:
        if self.done:
            return
        graph = self._graph(self._once, self._seams(self._once, FEW_STRANDS))
        seed += self._options.seed
        self._offer(graph, route(refined(graph, rings), plan, rounds, seed, deadline))

    def _minimize(
        self,
        strands: dict[int, int],
        seams: tuple[Seam, ...],
        colors: tuple[frozenset[int], ...],
        deadline: Deadline,
        final: bool,
    ) -> None:
        """Solve one model; only the final one, the widest, proves a bound of its own."""
        if not self._fits(seams_size(seams)):
            return
        graph = dart_graph(self.instance, colors, strands, seams, self._part.loops)
        size = model_size(graph)
        if not self._fits(size):
            return
        if size * SECONDS_A_TERM > deadline.left:
            raise OutOfTime("building the model would take longer than there is time")
        built = full_model(graph, color_regions(self.instance, colors), deadline=deadline)
        # What meets the bound ends the search; by itself the model would have to prove it first.
        built.model.add(sum(built.variables.root) + sum(built.variables.alone) >= self.bound)
        self._hint(built, graph)
        solver = self._runner.solver(None if final else TRIAL_EFFORT, deadline)
        if final:
            solver.best_bound_callback = lambda bound: self._raise(ceil(bound - 1e-6), False)
        status = self._runner.solve(solver, built.model, self._watch)
        self._running = None
        if final and isfinite(solver.best_objective_bound):
            self._raise(ceil(solver.best_objective_bound - 1e-6), False)
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._offer(graph, read_painting(graph, built.variables, solver))

    def _fits(self, size: float) -> bool:
        """Whether a model of so many terms is small enough to be built; noted if it is not."""
        # Every worker has a copy of its own.
        size *= max(1.0, (self._options.workers or PORTFOLIO) / PORTFOLIO)
        if size > LARGEST_MODEL:
            self.notes.append(not_built(size))
        return size <= LARGEST_MODEL

    def _hint(self, built: Model, graph: DartGraph) -> None:
        """Hint the best division, if it has no strands and no colors beyond the model's."""
        known, painting = self.best
        fits = all(
            block.color in graph.colors[cell]
            for cell, blocks in enumerate(painting)
            for block in blocks
        )
        if fits and {dart.name for dart in known.darts} <= {dart.name for dart in graph.darts}:
            add_hint(built, graph, canonical(graph, moved(known, painting, graph)))

    def _graph(self, strands: dict[int, int], seams: tuple[Seam, ...]) -> DartGraph:
        return dart_graph(self.instance, self._colors, strands, seams, self._part.loops)

    def _seams(self, strands: dict[int, int], most: int | None) -> tuple[Seam, ...]:
        part = self._part
        return widened(self.instance, self._colors, strands, part.loops, part.seams, most)

    def _offer(self, graph: DartGraph, painting: Painting) -> None:
        self._keep(graph, canonical(graph, painting))

    def _keep(self, graph: DartGraph, painting: Painting) -> None:
        """A canonical painting, if it is the best so far."""
        segments = len(segments_of(graph, painting))
        if segments < self.segments:
            self.segments, self.best = segments, (graph, painting)
            self._report()

    def _raise(self, bound: int, for_surface: bool = True) -> None:
        if bound > self.bound:
            self.bound = bound
            self._report()
        if for_surface and bound > self.surface_bound:
            self.surface_bound = bound
            self.hubs = None

    def _watch(self, segments: int) -> None:
        # What the running model has found is not offered before it ends, but stays known.
        self._running = segments
        self._report()
