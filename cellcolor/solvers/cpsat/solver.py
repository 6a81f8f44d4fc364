"""The CP-SAT solver: reductions, then every part on its own until it is proved."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from importlib.metadata import version

from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam, count_segments
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.solvers.bounds.cover import greedy_strangers
from cellcolor.solvers.bounds.reductions import LeftOut, drop_dominated, left_out
from cellcolor.solvers.cpsat.conflict_certificate import conflict_certificate
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.cpsat.model.painting import (
    Block,
    Painting,
    canonical,
    division_of,
    painting_of,
)
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.part_search import PartSearch
from cellcolor.solvers.cpsat.parts import seam_places, split
from cellcolor.solvers.cpsat.schemes.enumeration import OptimalSchemes
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options, Start

RESERVES = 4
"""The search ends before the deadline by this multiple of the time to put a division together.
That time is needed once more for the answer, then by the checker, and for writing the file."""

_Stage = Callable[[PartSearch, Deadline], None]


class CpSatSolver:
    """Fewest segments by plans, routes and a CP-SAT model with sub-cell cutting paths.

    Args:
        plans: False leaves everything to the model.
    """

    abilities = Abilities(
        search_spaces=("paper", "surface"),
        several_loops=True,
        optimal_schemes=True,
        schemes_of_several_loops=True,
        start=True,
    )

    def __init__(self, plans: bool = True) -> None:
        self._plans = plans

    @property
    def version(self) -> str:
        """The version of OR-Tools."""
        return f"OR-Tools {version('ortools')}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline."""
        if not instance.cells:
            return Answer((), (), ())
        search = _Search(instance, options, progress, self._plans)
        with suppress(OutOfTime):
            search.run()
        return search.answer()

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> OptimalSchemes:
        """Every scheme with the given minimum, once."""
        return OptimalSchemes(instance, options, segments)


def model_alone() -> CpSatSolver:
    """The full model without the plans that settle most instances before it is built."""
    return CpSatSolver(plans=False)


class _Search:
    """The best division of the whole instance so far, put together from its parts."""

    def __init__(
        self, instance: Instance, options: Options, progress: OnProgress | None, plans: bool
    ) -> None:
        self._instance = instance
        self._options = options
        self._progress = progress
        self._plans = plans
        self._runner = Runner(options)
        self._loops = instance.live_loops
        self._own = tuple(frozenset(cell.colors) for cell in instance.cells)
        self._start: tuple[DartGraph, Painting] | None = None
        self._whole: tuple[DartGraph, Painting] | None = None
        self._parts: list[PartSearch] = []
        self._left_out: list[LeftOut] = []

    def run(self) -> None:
        """Solve until the best division is proved, or there is no time left.

        Raises:
            OutOfTime: the deadline, or an interrupt.
        """
        options, deadline = self._options, self._options.deadline
        begun = time.monotonic()
        self._whole = self._put_together()
        deadline = deadline.earlier(RESERVES * (time.monotonic() - begun))
        self._options = options = replace(options, deadline=deadline)
        self._runner = Runner(options)
        if options.start is not None:
            self._begin_with(options.start)
        deadline.check()
        self._left_out = left_out(self._instance, deadline)
        colors = drop_dominated(self._instance, self._left_out)
        deadline.check()
        self._parts = [
            PartSearch(part, options, self._runner, self._report)
            for part in deadline.watch(split(self._instance, colors))
        ]
        self._report()
        for stage in self._stages():
            self._run_stage(stage, [part for part in self._parts if not part.done])

    def answer(self) -> Answer:
        """The best division, in the strands that were asked for, and the proved bounds."""
        graph, painting = self._put_together()
        division = division_of(graph, painting, self._options.strands)
        if self._start is not None:
            known, its = self._start
            start = division_of(known, its, self._options.strands)
            if count_segments(start) < count_segments(division):
                graph, division = known, start
        notes = {note for part in self._parts for note in part.models.notes}
        return Answer(division, graph.seams, self._bounds(), tuple(sorted(notes)))

    def _stages(self) -> list[_Stage]:
        """The stages in order, steps 3 to 11 of docs/solver.md.

        Each is done for all open parts before the next begins.
        """
        if not self._plans:
            return [PartSearch.cover, lambda part, deadline: part.models.solve(deadline)]

        def within(share: float, stage: _Stage) -> _Stage:
            return lambda part, deadline: stage(part, deadline.share(share))

        return [
            PartSearch.cover,
            within(1 / 4, PartSearch.count_many_links),
            within(1 / 2, PartSearch.solve_exactly),
            within(1 / 4, PartSearch.begin_large),
            lambda part, its: part.planning.route(its.share(1 / 4 if part.large else 1 / 2)),
            within(1 / 4, PartSearch.count_few_links),
            PartSearch.accept_exact,
            within(1 / 4, PartSearch.recolor_best),
            within(1 / 2, lambda part, its: part.planning.go_on(its)),
            within(1 / 3, PartSearch.plan_in_detail),
            within(3 / 4, PartSearch.narrow_gap),
            within(3 / 4, PartSearch.decide_plans),
            within(1 / 3, PartSearch.plan_harder),
            lambda part, its: part.models.solve(its),
            PartSearch.improve_on,
        ]

    def _run_stage(self, stage: _Stage, parts: list[PartSearch]) -> None:
        """One stage for some parts, each with its share of the time that is left.

        Easy parts come first and leave most of their shares to the others.
        """
        for number, part in enumerate(parts):
            self._options.deadline.check()
            try:
                stage(part, self._options.deadline.share(1 / (len(parts) - number)))
            except OutOfTime as error:
                if isinstance(error, KeyboardInterrupt):
                    raise

    def _begin_with(self, start: Start) -> None:
        places = [replace(seam, strands=0) for seam in start.seams]
        if places != list(seam_places(self._instance, self._loops)):
            raise InputError(None, "seams", "lie in other places than this solver puts them")
        graph = self._whole_graph(start.seams)
        self._start = graph, canonical(graph, painting_of(graph, start.division))

    def _put_together(self) -> tuple[DartGraph, Painting]:
        """The best divisions of all parts as one; without parts every cell is painted whole."""
        if not self._parts and self._whole is not None:
            return self._whole
        found: dict[int, list[tuple[int, list[Strand]]]] = {}
        widths: dict[int, int] = {}
        for part in self._parts:
            graph, painting = part.best
            widths |= {seam.id: seam.strands for seam in graph.seams}
            for cell, blocks in zip(part.cells, painting, strict=True):
                found[cell] = [(b.color, [graph.darts[d].name for d in b.darts]) for b in blocks]
        seams = [
            replace(seam, strands=widths.get(seam.id, 0))
            for seam in seam_places(self._instance, self._loops)
        ]
        graph = self._whole_graph(seams)
        painting = [
            [
                Block(color, {graph.number_of[name] for name in names})
                for color, names in found.get(cell, [(min(colors), [])])
            ]
            for cell, colors in enumerate(self._own)
        ]
        return graph, canonical(graph, painting)

    def _whole_graph(self, seams: Sequence[Seam]) -> DartGraph:
        strands = dict.fromkeys(self._instance.live_edges, self._options.strands)
        return dart_graph(self._instance, self._own, strands, seams, self._loops)

    def _bounds(self) -> tuple[Bound, ...]:
        """The proved bounds; those of parts add up."""
        if not self._parts:
            return (Bound("strangers", len(greedy_strangers(self._instance)), "surface"),)
        certificate = conflict_certificate(self._left_out, self._parts)
        return (
            Bound("cover", sum(part.cover_bound for part in self._parts), "surface"),
            Bound(
                "hubs" if any(part.hubs for part in self._parts) else "conflicts",
                sum(part.surface_bound for part in self._parts),
                "surface",
                None if certificate is None else certificate.to_document(),
            ),
            Bound("crossings", sum(part.proved_for_surface for part in self._parts), "surface"),
            Bound("model", sum(part.bound for part in self._parts), "strands"),
        )

    def _report(self) -> None:
        if self._progress is None or not self._parts:
            return
        known = sum(part.known for part in self._parts)
        if self._start is not None:
            known = min(known, count_segments(division_of(*self._start)))
        self._progress(known, sum(part.bound for part in self._parts))
