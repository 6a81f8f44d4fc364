"""Solves full models of a part, with more and more strands up to as many as can be needed."""

from __future__ import annotations

from math import ceil, isfinite

from ortools.sat.python import cp_model

from cellcolor.data.solution import Seam
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph
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
from cellcolor.solvers.cpsat.model.painting import canonical, moved
from cellcolor.solvers.cpsat.part_state import FEW_STRANDS, PartState
from cellcolor.solvers.cpsat.quota_model import colors_within, quota_model
from cellcolor.solvers.cpsat.routes.segment_plans import Planner, Quota
from cellcolor.solvers.interface import PORTFOLIO

TRIAL_EFFORT = 2.0
"""Deterministic seconds per worker for every model but the widest, whose bound alone is a proof."""


class ModelSearch:
    """Solves full models of a part, and offers it the divisions and bounds that they give.

    Attributes:
        notes: models that were not built, and why, a sentence each.
    """

    def __init__(self, part: PartState) -> None:
        self._part = part
        self.notes: list[str] = []

    def solve(self, deadline: Deadline) -> None:
        """Solve the stages one after the other; the last one proves a bound."""
        stages = self._stages()
        # Equal stages are solved once, and a stage that equals the last one is final.
        for number, stage in enumerate(stages):
            if not self._part.done and stages.index(stage) == number:
                self._minimize(*stage, deadline, final=stage == stages[-1])

    def draw(
        self, planner: Planner, quota: Quota, effort: float, deadline: Deadline
    ) -> bool | None:
        """Look for a division that meets the bound and a quota of segments for each color region.

        Args:
            planner: the one whose plan gave the quota.
            effort: deterministic seconds.

        Returns:
            Whether there is one, which is then offered to the part; None if it was not decided.
        """
        colors = colors_within(quota, len(self._part.colors))
        stages = self._stages()
        for stage in reversed(stages):
            graph = self._graph(*stage, colors, deadline, 1)
            if isinstance(graph, DartGraph):
                break
        else:
            return None
        built = quota_model(graph, planner, quota, self._part.bound, deadline)
        solver = self._part.runner.single(effort, 0, deadline)
        # Nothing is minimized, and without a linear relaxation CP-SAT is far quicker then.
        solver.parameters.linearization_level = 0
        status = self._part.runner.solve(solver, built.model)
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._part.offer(graph, read_painting(graph, built.variables, solver))
            return True
        return False if status == cp_model.INFEASIBLE and stage == stages[-1] else None

    def _graph(
        self,
        strands: dict[int, int],
        seams: tuple[Seam, ...],
        colors: tuple[frozenset[int], ...],
        deadline: Deadline,
        workers: int,
    ) -> DartGraph | float:
        """The graph of a model, or how many terms the model would have if these are too many.

        Every worker has its own copy, and up to ``PORTFOLIO`` copies are counted as one.

        Raises:
            OutOfTime: there is no time to build it.
        """
        copies = max(1.0, workers / PORTFOLIO)
        if copies * (size := seams_size(seams)) > LARGEST_MODEL:
            return copies * size
        graph = dart_graph(self._part.instance, colors, strands, seams, self._part.connected.loops)
        if copies * (size := model_size(graph)) > LARGEST_MODEL:
            return copies * size
        if size * SECONDS_A_TERM > deadline.left:
            raise OutOfTime("building the model would take longer than the time left")
        return graph

    def _stages(self) -> list[tuple[dict[int, int], tuple[Seam, ...]]]:
        """Strands and seams, from narrow to as wide as was asked for and can be needed."""
        wanted = self._part.widest
        # One strand an edge, as in the paper, usually suffices to meet the bound.
        widths = [self._part.once, wanted] if wanted != self._part.once else [wanted]
        return [
            (strands, self._part.seams(strands, width))
            for strands in widths
            for width in (FEW_STRANDS, None)
        ]

    def _minimize(
        self,
        strands: dict[int, int],
        seams: tuple[Seam, ...],
        deadline: Deadline,
        final: bool,
    ) -> None:
        """Solve one model; only the final one, the widest, also proves a bound."""
        workers = self._part.options.workers or PORTFOLIO
        colors = self._part.colors
        graph = self._graph(strands, seams, colors, deadline, workers)
        if not isinstance(graph, DartGraph):
            self.notes.append(not_built(graph))
            return
        regions = color_regions(self._part.instance, colors)
        built = full_model(graph, regions, deadline=deadline)
        # The known bound as a constraint: a division that meets it ends the search, without the
        # model having to prove the bound again.
        built.model.add(built.segments >= self._part.bound)
        self._hint(built, graph)
        solver = self._part.runner.portfolio(None if final else TRIAL_EFFORT, deadline)
        if final:
            solver.best_bound_callback = self._proved
        status = self._part.runner.solve(solver, built.model, self._part.watch)
        self._part.watch(None)
        if final and isfinite(solver.best_objective_bound):
            self._proved(solver.best_objective_bound)
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._part.offer(graph, read_painting(graph, built.variables, solver))

    def _proved(self, bound: float) -> None:
        self._part.raise_to(ceil(bound - 1e-6), for_surface=False)

    def _hint(self, built: Model, graph: DartGraph) -> None:
        """Hint the best division, if the model has all of its strands."""
        known, painting = self._part.best
        if {dart.name for dart in known.darts} <= {dart.name for dart in graph.darts}:
            add_hint(built, graph, canonical(graph, moved(known, painting, graph)))
