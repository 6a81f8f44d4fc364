"""The CP-SAT solver: reductions, a first division, then the full model until it is proved."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from math import ceil, isfinite
from threading import Thread

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam
from cellcolor.solvers.bounds import color_regions, set_cover
from cellcolor.solvers.cpsat.enumeration import optimal_schemes
from cellcolor.solvers.cpsat.graph import DartGraph, dart_graph, seams_of
from cellcolor.solvers.cpsat.model import Model, add_hint, build, read_painting
from cellcolor.solvers.cpsat.painting import Painting, canonical, division_of, painting_of
from cellcolor.solvers.cpsat.whole import paint_whole_cells
from cellcolor.solvers.interface import Answer, Options, Progress
from cellcolor.solvers.reductions import drop_dominated

__all__ = ["CpSatSolver"]

PORTFOLIO = 8
"""Workers unless asked for otherwise: different searches, useful beyond the number of cores."""

FEW_STRANDS = 2
"""Seams are tried this narrow first, which is enough when the result meets the cover bound."""

WHOLE_EFFORT = 0.2
"""Deterministic seconds a worker for undivided cells; often in vain where cutting paths are needed."""

TRIAL_EFFORT = 2.0
"""Deterministic seconds a worker for a model that is not the widest, so that its bound proves nothing."""


class CpSatSolver:
    """Fewest segments by a CP-SAT model with sub-cell cutting paths."""

    name = "cp-sat"

    def minimize(
        self, instance: Instance, options: Options, progress: Progress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best that the time limit allowed."""
        if not instance.cells:
            return Answer((), (), 0)
        search = _Search(instance, options, progress)
        # The paper's divisions are among the surface's, and usually enough for the bound.
        for strands in sorted({1, options.strands}):
            wide = seams_of(instance, search.colors, strands, None)
            narrow = seams_of(instance, search.colors, strands, FEW_STRANDS)
            for seams in dict.fromkeys((narrow, wide)):
                search.run(strands, seams, final=strands == options.strands and seams == wide)
                if search.done:
                    return search.answer()
        return search.answer()

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        """Every scheme with the given minimum, once."""
        return optimal_schemes(instance, options, segments)


class _Search:
    """The best division so far, over models of growing width."""

    def __init__(self, instance: Instance, options: Options, progress: Progress | None) -> None:
        self._instance = instance
        self._options = options
        self._progress = progress
        self._start = time.monotonic()
        self._stopped = False
        self.colors = drop_dominated(instance)
        self._regions = color_regions(instance, self.colors)
        self._cover = set_cover(instance, self.colors)
        self._bound = len(self._cover)
        self._best: int | None = None
        self._division: Division | None = None
        self._seams: tuple[Seam, ...] = ()
        self._strands = 1
        self._report(None, None)

    @property
    def done(self) -> bool:
        """Whether the best division is proved, or there is no time left."""
        return self._best == self._bound or self._stopped or self._left() <= 0

    def answer(self) -> Answer:
        """The best division, in the strands that were asked for, and what is proved of it."""
        division, seams = self._division, self._seams
        if division is not None and self._strands != self._options.strands:
            graph = dart_graph(self._instance, self.colors, self._options.strands, seams)
            division = division_of(graph, canonical(graph, painting_of(graph, division)))
        return Answer(division, seams, self._bound)

    def run(self, strands: int, seams: tuple[Seam, ...], final: bool) -> None:
        """Solve one model; only the final one, the widest, proves a bound of its own."""
        graph = dart_graph(self._instance, self.colors, strands, seams)
        if self._division is None:
            first = paint_whole_cells(graph, self._cover, self._solver(WHOLE_EFFORT))
            if first is not None:
                self._offer(graph, strands, first)
            if self.done:
                return
        built = build(graph, self._regions)
        if self._division is not None:
            add_hint(built, graph, canonical(graph, painting_of(graph, self._division)))
        solver = self._solver(None if final else TRIAL_EFFORT)
        if final:
            solver.best_bound_callback = lambda bound: self._report(None, ceil(bound - 1e-6))
        status = self._solve(solver, built)
        if final:
            self._raise_bound(solver)
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._offer(graph, strands, read_painting(graph, built.variables, solver))

    def _solve(self, solver: cp_model.CpSolver, built: Model) -> cp_model.CpSolverStatus:
        """Solve in a thread, so that an interrupt here ends the search with its best."""
        found: list[cp_model.CpSolverStatus] = []
        watcher = _Watcher(self._report)
        thread = Thread(target=lambda: found.append(solver.solve(built.model, watcher)))
        thread.start()
        while thread.is_alive():
            try:
                thread.join()
            except KeyboardInterrupt:
                self._stopped = True
                solver.stop_search()
        return found[0]

    def _solver(self, effort: float | None) -> cp_model.CpSolver:
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = self._options.workers or PORTFOLIO
        solver.parameters.random_seed = self._options.seed
        solver.parameters.catch_sigint_signal = False
        if self._options.time_limit is not None:
            solver.parameters.max_time_in_seconds = max(0.0, self._left())
        if effort is not None:
            solver.parameters.max_deterministic_time = effort
        return solver

    def _left(self) -> float:
        limit = self._options.time_limit
        return float("inf") if limit is None else limit - (time.monotonic() - self._start)

    def _offer(self, graph: DartGraph, strands: int, painting: Painting) -> None:
        division = division_of(graph, canonical(graph, painting))
        segments = 1 + max(sub.segment for cell in division for sub in cell.subcells)
        if self._best is None or segments < self._best:
            self._best = segments
            self._division, self._seams, self._strands = division, graph.seams, strands
            self._report(segments, None)

    def _raise_bound(self, solver: cp_model.CpSolver) -> None:
        bound = solver.best_objective_bound
        if isfinite(bound):
            self._bound = max(self._bound, ceil(bound - 1e-6))

    def _report(self, segments: int | None, bound: int | None) -> None:
        if self._progress is not None:
            known = [n for n in (segments, self._best) if n is not None]
            self._progress(min(known, default=None), max(bound or 0, self._bound))


class _Watcher(cp_model.CpSolverSolutionCallback):
    """Reports each better division while the search runs."""

    def __init__(self, report: Callable[[int | None, int | None], None]) -> None:
        super().__init__()
        self._report = report

    def on_solution_callback(self) -> None:
        self._report(round(self.objective_value), None)
