"""The CP-SAT solver: reductions, a first division, then the full model until it is proved."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress
from math import ceil, isfinite

from ortools.sat.python import cp_model

from cellcolor.data.bound import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam
from cellcolor.deadline import OutOfTime
from cellcolor.errors import InputError
from cellcolor.solvers.bounds import color_regions, set_cover
from cellcolor.solvers.cpsat.enumeration import optimal_schemes
from cellcolor.solvers.cpsat.fewest import FewestCuts
from cellcolor.solvers.cpsat.graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model import Model, add_hint, build, read_painting
from cellcolor.solvers.cpsat.painting import Painting, canonical, division_of, moved, painting_of
from cellcolor.solvers.cpsat.plans import Plan, Planner, Undecided
from cellcolor.solvers.cpsat.refined import refined
from cellcolor.solvers.cpsat.routing import route
from cellcolor.solvers.cpsat.runner import Runner
from cellcolor.solvers.crossings import enough_crossings
from cellcolor.solvers.interface import Answer, Options, Progress
from cellcolor.solvers.reductions import drop_dominated

__all__ = ["CpSatSolver"]

FEW_STRANDS = 2
"""Seams are tried this narrow first, which is enough when the result meets the cover bound."""

PLAN_EFFORT = 0.05
"""Deterministic seconds for a plan; most take a hundredth of that."""

FIRST_ROUNDS, ROUNDS = 20, 60
"""Of routing: before conflicts are looked for, and after. What can be routed takes a few."""

ATTEMPTS = 3
"""Plans to route before the full model has to decide."""

TRIAL_EFFORT = 2.0
"""Deterministic seconds a worker for a model that is not the widest: its bound proves nothing."""


class CpSatSolver:
    """Fewest segments by plans, routes and a CP-SAT model with sub-cell cutting paths.

    Args:
        plans: False leaves everything to the model.
    """

    def __init__(self, plans: bool = True) -> None:
        self.name = "cp-sat" if plans else "cp-sat-model"
        self._plans = plans

    def minimize(
        self, instance: Instance, options: Options, progress: Progress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best that the time limit allowed."""
        if not instance.cells:
            return Answer((), (), (), 0 if options.fewest_cuts else None)
        search = _Search(instance, options, progress, self._plans)
        with suppress(OutOfTime):  # an interrupt between two models
            search.run()
        return search.answer()

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        """Every scheme with the given minimum, once."""
        return optimal_schemes(instance, options, segments)


class _Search:
    """The best division so far, over models of growing width."""

    def __init__(
        self, instance: Instance, options: Options, progress: Progress | None, plans: bool
    ) -> None:
        self._instance = instance
        self._options = options
        self._progress = progress
        self._plans = plans
        self._runner = Runner(options)
        own = tuple(frozenset(cell.colors) for cell in instance.cells)
        # A division to start from may use colors that would be dropped.
        self._colors = drop_dominated(instance) if options.start is None else own
        self._regions = color_regions(instance, self._colors)
        self._cover = self._planned = set_cover(instance, self._colors)
        self._bound = self._surface_bound = len(self._cover)
        self._cuts_bound = 0
        self._fewest: tuple[DartGraph, Painting] | None = None
        self._enough = enough_crossings(instance, self._colors)
        self._best: tuple[DartGraph, Painting] | None = None
        self._segments: int | None = None
        self._known: int | None = None
        self._report(None, None)

    def answer(self) -> Answer:
        """The best division, in the strands that were asked for, and what is proved of it."""
        division: Division | None = None
        seams: tuple[Seam, ...] = ()
        if self._best is not None:
            graph, painting = self._best
            seams = graph.seams
            strands = self._options.strands
            full = self._graph(dict.fromkeys(self._enough, strands), seams)
            painting = canonical(full, moved(graph, painting, full))
            division = division_of(full, painting, strands)
        if self._fewest is not None:
            graph, painting = self._fewest
            division, seams = division_of(graph, painting, self._options.strands), graph.seams
        cuts = self._cuts_bound if self._options.fewest_cuts else None
        return Answer(division, seams, self._bounds(), cuts)

    def _bounds(self) -> tuple[Bound, ...]:
        """What is proved of the number of segments, and how."""
        # Where more corridors across an edge are never needed, the bound is one for the surface.
        wide = all(enough <= self._options.strands for enough in self._enough.values())
        return (
            Bound("cover", len(self._cover), "surface"),
            Bound("conflicts", self._surface_bound, "surface"),
            Bound("crossings", self._bound, "surface")
            if wide
            else Bound("model", self._bound, "strands"),
        )

    def run(self) -> None:
        """Solve until the best division is proved, or there is no time left."""
        self._begin()
        most = self._options.strands
        wanted = {edge: int(min(most, enough)) for edge, enough in self._enough.items()}
        # The paper's divisions are among the surface's, and usually enough for the bound.
        widths = [dict.fromkeys(wanted, 1), wanted]
        stages = [
            (strands, self._seams(strands, width))
            for strands in (widths if widths[0] != wanted else widths[1:])
            for width in (FEW_STRANDS, None)
        ]
        for number, (strands, seams) in enumerate(stages):
            if not self._done and stages.index((strands, seams)) == number:
                self._minimize(strands, seams, self._colors, final=(strands, seams) == stages[-1])
        if self._options.fewest_cuts and self._segments == self._bound and not self._runner.over:
            self._fewest_cuts(stages[-1][0])

    @property
    def _done(self) -> bool:
        return self._segments == self._bound or self._runner.over

    def _begin(self) -> None:
        """A first division: what was handed in, or what plans lead to."""
        start = self._options.start
        if start is not None:
            strands = dict.fromkeys(self._enough, self._options.strands)
            places = {(s.id, s.cell, s.from_, s.to) for s in self._seams(strands, None)}
            if {(s.id, s.cell, s.from_, s.to) for s in start.seams} != places:
                raise InputError(None, "seams", "lie elsewhere than this solver puts them")
            graph = self._graph(strands, start.seams)
            self._offer(graph, painting_of(graph, start.division))
        if self._done:
            return
        if self._plans:
            self._route_plans()
        colors = tuple(
            frozenset(color for color, cells in self._planned if cell.id in cells)
            for cell in self._instance.cells
        )
        if not self._done and colors != self._colors:
            # In the colors of the last plan only: a much smaller model.
            once = dict.fromkeys(self._enough, 1)
            self._minimize(once, self._seams(once, FEW_STRANDS), colors, final=False)

    def _route_plans(self) -> None:
        """Divisions by routing what is planned; where nothing can be planned the bound rises."""
        planner = Planner(self._instance, self._regions, len(self._cover), self._solve_plan)
        with suppress(Undecided):
            for attempt in range(ATTEMPTS):
                plan = self._conflict_free_plan(planner, attempt)
                for rings in (1, 2):
                    self._route(plan, rings, ROUNDS, attempt)
            if not self._done:
                plan = planner.plan(self._bound + 1, 0) or plan
                self._route(plan, 1, ROUNDS, 0)

    def _conflict_free_plan(self, planner: Planner, attempt: int) -> Plan:
        """A plan with as many segments as the bound, if not one that could be routed before."""
        while True:
            plan = planner.plan(self._bound, attempt)
            if plan is None:
                self._bound = self._surface_bound = self._bound + 1
                self._report(None, None)
                continue
            self._planned = [segment.region for segment in plan]
            # Looking for conflicts takes longer than routing when there are none.
            for rings in (0, 1):
                self._route(plan, rings, FIRST_ROUNDS, attempt)
            if self._done or not planner.find_conflicts(plan):
                return plan

    def _solve_plan(
        self, model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = self._runner.solver(PLAN_EFFORT)
        solver.parameters.num_workers = 1  # too small for a portfolio
        solver.parameters.random_seed = self._options.seed + seed
        return solver, self._runner.solve(solver, model)

    def _route(self, plan: Plan, rings: int, rounds: int, seed: int) -> None:
        if self._done:
            return
        once = dict.fromkeys(self._enough, 1)
        graph = self._graph(once, self._seams(once, FEW_STRANDS))
        painting = route(
            refined(graph, rings),
            plan,
            rounds,
            self._options.seed + seed,
            lambda: self._runner.over,
        )
        self._offer(graph, painting)

    def _minimize(
        self,
        strands: dict[int, int],
        seams: tuple[Seam, ...],
        colors: tuple[frozenset[int], ...],
        final: bool,
    ) -> None:
        """Solve one model; only the final one, the widest, proves a bound of its own."""
        graph = dart_graph(self._instance, colors, strands, seams)
        built = build(graph, color_regions(self._instance, colors))
        self._hint(built, graph)
        solver = self._runner.solver(None if final else TRIAL_EFFORT)
        if final:
            solver.best_bound_callback = lambda bound: self._report(None, ceil(bound - 1e-6))
        status = self._runner.solve(solver, built.model, lambda found: self._report(found, None))
        if final and isfinite(solver.best_objective_bound):
            self._bound = max(self._bound, ceil(solver.best_objective_bound - 1e-6))
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._offer(graph, read_painting(graph, built.variables, solver))

    def _fewest_cuts(self, strands: dict[int, int]) -> None:
        """Of the divisions with the fewest segments, one with the fewest cutting paths."""
        if self._best is None:
            return
        written = dict.fromkeys(self._enough, self._options.strands)
        search = FewestCuts(
            self._instance, self._colors, strands, written, self._bound, self._runner
        )
        with suppress(OutOfTime):
            search.run(*self._best)
        self._cuts_bound, self._fewest = search.bound, search.best

    def _hint(self, built: Model, graph: DartGraph) -> None:
        """Hint the best division, if it has no strands and no colors beyond the model's."""
        if self._best is None:
            return
        known, painting = self._best
        fits = all(
            block.color in graph.colors[cell]
            for cell, blocks in enumerate(painting)
            for block in blocks
        )
        if fits and {dart.name for dart in known.darts} <= {dart.name for dart in graph.darts}:
            add_hint(built, graph, canonical(graph, moved(known, painting, graph)))

    def _graph(self, strands: dict[int, int], seams: tuple[Seam, ...]) -> DartGraph:
        return dart_graph(self._instance, self._colors, strands, seams)

    def _seams(self, strands: dict[int, int], most: int | None) -> tuple[Seam, ...]:
        return seams_of(self._instance, self._colors, strands, most)

    def _offer(self, graph: DartGraph, painting: Painting) -> None:
        painting = canonical(graph, painting)
        division = division_of(graph, painting)
        segments = 1 + max(sub.segment for cell in division for sub in cell.subcells)
        if self._segments is None or segments < self._segments:
            self._segments = segments
            self._best = graph, painting
            self._report(segments, None)

    def _report(self, segments: int | None, bound: int | None) -> None:
        # What the running model has found is not offered before it ends, but stays known.
        known = [n for n in (segments, self._known) if n is not None]
        self._known = min(known, default=None)
        if self._progress is not None:
            self._progress(self._known, max(bound or 0, self._bound))
