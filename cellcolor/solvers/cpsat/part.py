"""A part of the instance: its best division so far, what is proved of it, and the steps to more.

A part is what live edges connect. Each step takes a deadline, and raises ``OutOfTime``
when that comes first; what it has found by then is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import combinations, product
from math import ceil, isfinite
from random import Random

from ortools.sat.python import cp_model

from cellcolor.data.bounds import CertifiedCrossing, CertifiedPart, CertifiedParts
from cellcolor.data.instance import Instance
from cellcolor.data.solution import ModelSize
from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import (
    Region,
    color_regions,
    greedy_independent_set,
    set_cover,
)
from cellcolor.solvers.cpsat.dart_graph import (
    DartGraph,
    complete_graph,
    enough_crossings,
    narrow_graph,
    restricted,
    strands_of_seams,
)
from cellcolor.solvers.cpsat.exact_shapes import exact_minimum, painting_of_areas
from cellcolor.solvers.cpsat.formulation import SectorModel
from cellcolor.solvers.cpsat.local_search import recolor
from cellcolor.solvers.cpsat.painting import Block, Painting, canonical, moved, segments_of
from cellcolor.solvers.cpsat.segment_plans import Planner, Undecided
from cellcolor.solvers.interface import Options
from cellcolor.solvers.interruptible import Runner

SEARCH_STRANDS, FIRST_STRANDS = 2, 4
"""The most strands of a seam in local search, and in the model that comes before the complete one:
more would make of a cell with many loops a list of many darts."""

MOST_RINGS = 3
"""Rings of sectors in local search, one more from turn to turn. More leave more room."""

FEW_MOVES, FIRST_MOVES, MOVES = 5, 30, 300
"""Moves of local search in vain, for each segment, before nothing better is expected: from a start
of which there are many, from the best division in the first turn, and later. On most surfaces the
first plan ends the search, so the first turn does not last long."""

LEVELS = (1, 0.1), (2, 0.2), (0, 0.7)
"""How much of a linear relaxation plans are made with, and the share of the effort. Plans of many
segments are ruled out by a full relaxation, by a small one or by none, hardly ever by all."""

DECIDING = 4
"""How much more effort than a plan it may take to decide whether a division follows it."""

MOST_LITERALS = 100_000
"""A larger model takes longer to build than local search takes to find more."""

MOST_CONFLICTS = 2_000
"""With more of them a certificate would be large, and searching it slow."""


class Part:
    """The best division of a part so far, and its proved bounds.

    Args:
        report: called whenever the best division or the bound has changed.

    Attributes:
        cells: the cell of the whole instance that each cell of the part is.
        best: the best division, on its dart graph; it has as many segments as ``segments``.
        bound: no division in the search space has fewer segments.
        surface_bound: no division of the surface has fewer.
        bound_kind: what proved ``bound``.
        cover_bound: the size of a smallest cover, or what is proved of it.
        model_size: how large the complete model is, if it was solved.
        notes: models that were not built, and why, a sentence each.
    """

    def __init__(
        self,
        instance: Instance,
        cells: list[int],
        options: Options,
        runner: Runner,
        report: Callable[[], None],
    ) -> None:
        self.instance, self.cells = instance, cells
        self._options, self._runner, self._report = options, runner, report
        self._enough = enough_crossings(instance)
        # Of each live edge as many strands as were asked for and can be needed.
        self._strands = {
            edge: int(min(options.strands, enough)) for edge, enough in self._enough.items()
        }
        self._narrow = narrow_graph(instance, SEARCH_STRANDS)
        self.regions = color_regions(instance)
        self.bound = self.surface_bound = len(greedy_independent_set(self.regions))
        self.bound_kind = "strangers"
        self.cover_bound = self.bound
        self.planner: Planner | None = None
        self.model_size: ModelSize | None = None
        self.notes: list[str] = []
        self._planned: Sequence[Region] = self.regions
        self._running: int | None = None
        self.best = self._whole([min(cell.colors) for cell in instance.cells])
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
        """A smallest set cover: the first bound, and a division with every cell painted whole."""
        found = set_cover(self.regions, deadline)
        self.cover_bound = max(self.bound, found.bound)
        self._planned = found.regions
        self._raise_to(found.bound, "cover", for_surface=True)
        self._keep(*self._covered(found.regions))

    def solve_exactly(self, deadline: Deadline) -> None:
        """The minimum of a part whose shape allows a recursion (``exact_shapes``)."""
        found = exact_minimum(self.instance, deadline)
        if found is None:
            return
        segments, areas = found
        self._keep(self._narrow, painting_of_areas(self._narrow, areas))
        if max(self._strands.values(), default=1) == 1:
            self._raise_to(segments, "exact", for_surface=False)

    def improve(self, turn: int, deadline: Deadline) -> None:
        """Local search from cells painted whole, then from the best division.

        What it finds differs from start to start, so the regions of the last cover or plan come in
        another order each time.
        """
        rng = Random(self._options.seed + turn)
        rings = 1 + turn % MOST_RINGS
        start = self._covered(rng.sample(self._planned, len(self._planned)))
        self._recolor(*start, rng, deadline, FEW_MOVES, rings)
        self._recolor(*self.best, rng, deadline, MOVES if turn else FIRST_MOVES, rings)

    def separate(self, effort: float, deadline: Deadline, *, decide: bool = False) -> None:
        """Plan segments that respect separating pairs, each plan a start of local search.

        Where there is no plan, the bound rises. It ends with a plan in which no two segments are
        known to cross, unless it is decided that no division follows it.

        Args:
            effort: deterministic seconds for a plan.
            decide: whether such plans are decided by the model of their few colors.
        """
        if self.planner is None:
            self.planner = Planner(self.instance, self.regions, self.cover_bound, self._planned)

        def solve(model: cp_model.CpModel) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
            for level, share in LEVELS:
                solver = self._runner.single(share * effort, deadline)
                solver.parameters.linearization_level = level
                status = self._runner.solve(solver, model)
                if status != cp_model.UNKNOWN:
                    break
            return solver, status

        while not self.done:
            deadline.check()
            try:
                plan = self.planner.plan(self.bound, solve)
            except Undecided:
                return
            if plan is None:
                refuted = self.planner.refuted(self.bound)
                kind = "exact" if refuted else "conflicts"
                self._raise_to(self.bound + 1, kind, for_surface=not refuted)
                continue
            self._planned = [region for region, _ in plan]
            start = self._covered([(region[0], cells) for region, cells in plan])
            self._keep(*start)
            if not self.done:
                self._recolor(*start, Random(self._options.seed), deadline, FEW_MOVES)
            if self.done:
                return
            if self.planner.find_separations(plan, deadline):
                continue
            if not decide or not self._decide(DECIDING * effort, deadline):
                return

    def solve_model(self, deadline: Deadline) -> None:
        """The complete model, hinted with the best division and bounded by what is proved.

        Where fewer strands may do, the smaller model with those comes first: it proves nothing, but
        may have a division that meets the bound.
        """
        for complete in self._stages:
            if not self.done:
                self._minimize(deadline if complete else deadline.share(1 / 4), complete=complete)

    def certified(self) -> CertifiedPart:
        """What shows that no division of the surface has fewer segments than ``surface_bound``."""

        def cells(merged_cell: Iterable[int]) -> tuple[int, ...]:
            return tuple(sorted(self.cells[cell] for cell in merged_cell))

        # A part that a smallest cover proves needs nothing of what was planned.
        planner = self.planner if self.surface_bound > self.cover_bound else None
        conflicts = [
            CertifiedCrossing(
                (one[0], other[0]),
                (cells(separation.ends[0]), cells(separation.ends[1])),
                (cells(near), cells(far)),
            )
            for one, other, separation in ([] if planner is None else planner.separations)
            for group, further in combinations(separation.groups, 2)
            for near, far in product(group, further)
        ]
        return CertifiedPart(self.surface_bound, self._hardest(conflicts), tuple(conflicts))

    def _hardest(self, conflicts: Sequence[CertifiedCrossing]) -> tuple[int, ...]:
        """One cell of each kind, without those that are touched wherever another one is.

        Two cells are of one kind if they lie in the same color regions and the same ends of
        conflicts. A cell of none of these can be touched by whatever touches a cell that has no
        other regions.
        """
        regions: dict[int, set[int]] = {cell: set() for cell in self.cells}
        for number, (_, own) in enumerate(self.regions):
            for cell in own:
                regions[self.cells[cell]].add(number)
        ends: dict[int, set[tuple[int, int]]] = {cell: set() for cell in self.cells}
        for number, conflict in enumerate(conflicts):
            for end, area in enumerate((*conflict.one, *conflict.other)):
                for cell in area:
                    ends[cell].add((number, end))
        first: dict[tuple[frozenset[int], frozenset[tuple[int, int]]], int] = {}
        for cell in sorted(self.cells):
            first.setdefault((frozenset(regions[cell]), frozenset(ends[cell])), cell)
        hard = (
            cell for (own, at), cell in first.items() if at or not any(o < own for o, _ in first)
        )
        return tuple(sorted(hard))

    def _decide(self, effort: float, deadline: Deadline) -> bool:
        """Whether it is decided if a division in the last plan's regions alone meets the bound.

        It is the complete model in the few colors that the plan leaves, without objective.
        """
        assert self.planner is not None
        regions = self.planner.regions_in_use
        allowed = {(color, cell) for color, cells in regions for cell in cells}
        for complete in self._stages:
            try:
                graph = self._graph(complete=complete)
                few = restricted(graph, allowed)
                built = SectorModel(few, regions, MOST_LITERALS, deadline=deadline)
            except TooLarge:
                return False
            built.model.add(built.segments <= self.bound)
            built.model.clear_objective()  # type: ignore[no-untyped-call]
            solver = self._runner.single(effort, deadline)
            solver.parameters.linearization_level = 0
            status = self._runner.solve(solver, built.model)
            if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
                painting = moved(few, canonical(few, built.painting(solver)), graph)
                self._keep(graph, canonical(graph, painting))
                return True
            if status != cp_model.INFEASIBLE:
                return False
        self.planner.refute(self.bound)
        return True

    def _minimize(self, deadline: Deadline, *, complete: bool) -> None:
        try:
            graph = self._graph(complete=complete)
            built = SectorModel(graph, self.regions, MOST_LITERALS, deadline=deadline)
        except TooLarge as error:
            self.notes.append(str(error))
            return
        built.model.add(built.segments >= self.bound)
        built.hint(canonical(graph, moved(*self.best, graph)))
        solver = self._runner.portfolio(deadline)
        if complete:
            solver.best_bound_callback = self._proved
        status = self._runner.solve(solver, built.model, self._watch)
        self._watch(None)
        if complete and isfinite(solver.best_objective_bound):
            self.model_size = built.size
            self._proved(solver.best_objective_bound)
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            self._keep(graph, canonical(graph, built.painting(solver)))

    def _proved(self, bound: float) -> None:
        self._raise_to(ceil(bound - 1e-6), "model", for_surface=False)

    @property
    def _stages(self) -> tuple[bool, ...]:
        """Whether models are built on the complete graph: at once, or after a narrow one."""
        seams = strands_of_seams(self.instance, self._strands)
        once = max(self._strands.values(), default=1) == 1
        return (True,) if once and max(seams, default=0) <= FIRST_STRANDS else (False, True)

    def _graph(self, *, complete: bool) -> DartGraph:
        """The part's darts with all strands ever needed, or with few."""
        if complete:
            return complete_graph(self.instance, self._strands)
        return narrow_graph(self.instance, FIRST_STRANDS)

    def _covered(self, regions: Sequence[Region]) -> tuple[DartGraph, Painting]:
        """Every cell painted whole in the color of the last region that has it."""
        color_of = {cell: color for color, cells in regions for cell in cells}
        return self._whole([color_of[cell.id] for cell in self.instance.cells])

    def _whole(self, colors: Sequence[int]) -> tuple[DartGraph, Painting]:
        """Every cell painted whole."""
        return self._narrow, canonical(self._narrow, [[Block(color, set())] for color in colors])

    def _recolor(
        self,
        graph: DartGraph,
        painting: Painting,
        rng: Random,
        deadline: Deadline,
        moves: int,
        rings: int = 1,
    ) -> None:
        """What local search makes of a canonical painting, kept if it is the best so far."""
        regions, enough = self.regions, self.bound
        for better in recolor(graph, regions, painting, rng, enough, deadline, moves, rings):
            self._keep(graph, better)
            if self.done:
                return

    def _keep(self, graph: DartGraph, painting: Painting) -> None:
        """A canonical painting, which is kept if it is the best so far."""
        segments = len(segments_of(graph, painting))
        if segments < self.segments:
            self.segments, self.best = segments, (graph, painting)
            self._report()

    def _raise_to(self, bound: int, kind: str, *, for_surface: bool) -> None:
        """A bound that is proved, in the search space alone or for any division of the surface."""
        if bound > self.bound:
            self.bound, self.bound_kind = bound, kind
            self._report()
        if for_surface:
            self.surface_bound = max(self.surface_bound, bound)

    def _watch(self, segments: int | None) -> None:
        """What the running model has found so far, None when it has ended."""
        self._running = segments
        if segments is not None:
            self._report()


def conflict_certificate(parts: Sequence[Part]) -> CertifiedParts | None:
    """With what a checker verifies without a solver that bounds add up; None if too large."""
    found = tuple(part.certified() for part in parts)
    if sum(len(part.conflicts) for part in found) > MOST_CONFLICTS:
        return None
    return CertifiedParts(parts=found)
