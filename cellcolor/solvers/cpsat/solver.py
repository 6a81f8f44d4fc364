"""The CP-SAT solver: a cover, local search, separating pairs, and the model.

Segments never reach from one part of the instance into another (``split``), so minima and bounds
of parts add up. Each step is done for every part that is not proved before the next step begins.
"""

from __future__ import annotations

import importlib.metadata
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from math import isfinite

from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import ModelSize, Seam, count_segments
from cellcolor.deadline import OutOfTime
from cellcolor.errors import InputError
from cellcolor.solvers.bounds.cover import color_regions, greedy_independent_set
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph, seam_places, split
from cellcolor.solvers.cpsat.optimal_schemes import OptimalSchemes
from cellcolor.solvers.cpsat.painting import Block, Painting, canonical, division_of, painting_of
from cellcolor.solvers.cpsat.part import Part, conflict_certificate
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options, Start
from cellcolor.solvers.interruptible import Runner

SHARES = {
    "exact": 1 / 4,
    "improve": 1 / 5,
    "separate": 1 / 2,
    "decide": 1 / 4,
    "model": 2 / 3,
    "turn": 1 / 4,
}
"""The share of the time that is left which each step gets."""

TURNS = 3
"""Local searches from different starts before the model."""

EFFORT, GROWTH = 0.5, 2.0
"""Deterministic seconds for a plan, and the factor by which they grow from turn to turn."""

RESERVES = 4
"""The search ends before the deadline by this multiple of the time to put a division together.
That time is needed once more for the answer, then by the checker, and for writing the file."""


class CpSatSolver:
    """Fewest segments by covers, local search, separating pairs, and the model of the coloring."""

    abilities = Abilities(
        search_spaces=("paper", "surface"),
        several_loops=True,
        optimal_schemes=True,
        schemes_of_several_loops=True,
        start=True,
    )

    version = f"OR-Tools {importlib.metadata.version('ortools')}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline."""
        if not instance.cells:
            return Answer((), (), ())
        search = _Search(instance, options, progress)
        with suppress(OutOfTime):
            search.run()
        return search.answer()

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> OptimalSchemes:
        """Every scheme with the fewest segments, once."""
        return OptimalSchemes(instance, options, segments)


class _Search:
    """The best division of the whole instance so far, put together from its parts."""

    def __init__(self, instance: Instance, options: Options, progress: OnProgress | None) -> None:
        self._instance, self._options, self._progress = instance, options, progress
        self._places = seam_places(instance)
        self._own = tuple(frozenset(cell.colors) for cell in instance.cells)
        self._start: tuple[DartGraph, Painting] | None = None
        self._parts: list[Part] = []
        begun = time.monotonic()
        self._put_together()
        self._deadline = options.deadline.earlier(RESERVES * (time.monotonic() - begun))
        self._runner = Runner(replace(options, deadline=self._deadline))

    def run(self) -> None:
        """Solve until every part is proved, or there is no time left.

        A set cover is the first bound, and a first division. Trees and hubs are solved exactly.
        Local search improves the division. Separating pairs raise the bound, and each plan that
        respects them is a start of local search. Plans that start nothing better are decided by
        the model of their few colors. Then the complete model is solved, hinted and bounded by
        what is known. What is still open is improved in turns until the deadline.

        Raises:
            OutOfTime: the deadline, or an interrupt.
        """
        if self._options.start is not None:
            self._begin_with(self._options.start)
        self._deadline.check()
        options = replace(self._options, deadline=self._deadline)
        for part in self._deadline.watch(split(self._instance)):
            self._parts.append(Part(*part, options, self._runner, self._report))
        self._report()
        self._each(Part.cover, 1.0)
        self._each(Part.solve_exactly, SHARES["exact"])
        self._each(partial(Part.improve, turn=0), SHARES["improve"])
        self._each(partial(Part.separate, effort=EFFORT), SHARES["separate"])
        for turn in range(1, TURNS):
            self._each(partial(Part.improve, turn=turn), SHARES["improve"])
        self._each(partial(Part.separate, effort=EFFORT, decide=True), SHARES["decide"])
        self._each(Part.solve_model, SHARES["model"])
        turn = TURNS
        while isfinite(self._deadline.moment) and any(not part.done for part in self._parts):
            self._deadline.check()
            self._each(partial(Part.improve, turn=turn), SHARES["turn"])
            separate = partial(Part.separate, effort=EFFORT * GROWTH**turn, decide=True)
            self._each(separate, SHARES["turn"])
            turn += 1

    def answer(self) -> Answer:
        """The best division, in the strands that were asked for, and the proved bounds."""
        graph, painting = self._put_together()
        division = division_of(graph, painting, self._options.strands)
        if self._start is not None:
            start = division_of(*self._start, self._options.strands)
            if count_segments(start) < count_segments(division):
                graph, division = self._start[0], start
        notes = tuple(sorted({note for part in self._parts for note in part.notes}))
        sizes = [part.model_size for part in self._parts if part.model_size is not None]
        whole = ModelSize(sum(s.variables for s in sizes), sum(s.constraints for s in sizes))
        return Answer(division, graph.seams, self._bounds(), notes, whole if sizes else None)

    def _each(self, step: Callable[..., None], share: float) -> None:
        """One step of each open part, in a share of the time that is left.

        Easy parts come first and leave most of their time to the others.
        """
        deadline = self._deadline.share(share)
        left = [part for part in self._parts if not part.done]
        for number, part in enumerate(left):
            self._deadline.check()
            try:
                step(part, deadline=deadline.share(1 / (len(left) - number)))
            except OutOfTime as error:
                if isinstance(error, KeyboardInterrupt):
                    raise

    def _begin_with(self, start: Start) -> None:
        places = [replace(seam, strands=0) for seam in start.seams]
        if places != list(self._places):
            raise InputError(None, "seams", "lie in other places than this solver puts them")
        graph = self._whole_graph(start.seams)
        self._start = graph, canonical(graph, painting_of(graph, start.division))

    def _put_together(self) -> tuple[DartGraph, Painting]:
        """The best divisions of all parts as one; without parts every cell is painted whole."""
        found: dict[int, list[tuple[int, list[Strand]]]] = {}
        widths = {seam.id: 0 for seam in self._places}
        for part in self._parts:
            graph, painting = part.best
            # Seams have other ids in the part, in the same order.
            own_cells = set(part.cells)
            ids = [seam.id for seam in self._places if seam.cell in own_cells]
            widths |= {seam: own.strands for seam, own in zip(ids, graph.seams, strict=True)}
            whole = {own.id: seam for seam, own in zip(ids, graph.seams, strict=True)}
            whole |= {-own: -seam for own, seam in whole.items()}
            names = [(whole.get(dart, dart), strand) for (dart, strand), *_ in graph.darts]
            for cell, blocks in zip(part.cells, painting, strict=True):
                found[cell] = [(b.color, [names[dart] for dart in b.darts]) for b in blocks]
        seams = [replace(seam, strands=widths[seam.id]) for seam in self._places]
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
        return dart_graph(self._instance, strands, seams)

    def _bounds(self) -> tuple[Bound, ...]:
        """The proved bounds of the number of segments; those of parts add up.

        A kind is named only where it raised the bound of some part.
        """
        if not self._parts:
            apart = greedy_independent_set(color_regions(self._instance))
            return (Bound("strangers", len(apart), "surface"),)
        certificate = conflict_certificate(self._parts)
        document = None if certificate is None else certificate.to_document()
        by = {part.bound_kind for part in self._parts}
        separated = sum(part.surface_bound for part in self._parts)
        bounds = [
            Bound("cover", sum(part.cover_bound for part in self._parts), "surface"),
            Bound("conflicts", separated, "surface", document),
        ]
        surface = sum(part.proved_for_surface for part in self._parts)
        bound = sum(part.bound for part in self._parts)
        if "model" in by:
            bounds += [Bound("crossings", surface, "surface"), Bound("model", bound, "strands")]
        elif "exact" in by:
            bounds += [Bound("exact", surface, "surface"), Bound("exact", bound, "strands")]
        return tuple(bounds)

    def _report(self) -> None:
        if self._progress is None or not self._parts:
            return
        known = sum(part.known for part in self._parts)
        if self._start is not None:
            known = min(known, count_segments(division_of(*self._start)))
        self._progress(known, sum(part.bound for part in self._parts))
