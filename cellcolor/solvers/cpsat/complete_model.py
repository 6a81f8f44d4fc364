"""The complete model of an instance, in hand: to be extended, exported, or solved as it is."""

from __future__ import annotations

import importlib.metadata
from collections.abc import Collection
from math import ceil, isfinite

from ortools.sat.python import cp_model

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.dart_graph import complete_graph, enough_crossings
from cellcolor.solvers.cpsat.formulation import SectorModel
from cellcolor.solvers.cpsat.painting import Block, begun, canonical, division_of
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options, Start
from cellcolor.solvers.interruptible import Runner

MOST_LITERALS = 1_000_000
"""The most for the colors of sectors, of which 100,000 take 10 seconds and half a gigabyte to
build. The model has about 17 times as many constraints."""


class CompleteModel(SectorModel):
    """The formulation of a whole instance.

    Args:
        strands: of each live edge; 1 in the search space ``paper``.
        groups: the redundant groups of constraints; None for all of them.
        deadline: of building it.

    Raises:
        InputError: there is no such group.
        TooLarge: there are too many sectors, or strands of seams.
    """

    def __init__(
        self,
        instance: Instance,
        strands: int = 1,
        groups: Collection[str] | None = None,
        deadline: Deadline = NEVER,
    ) -> None:
        self.instance, self.strands = instance, strands
        self._each = dict.fromkeys(instance.live_edges, strands)
        graph = complete_graph(instance, self._each)
        super().__init__(graph, color_regions(instance), MOST_LITERALS, groups, deadline)
        self.hint(self._whole())

    def begin_with(self, start: Start) -> None:
        """Hint a division, in the place of what is hinted."""
        self.model.clear_hints()  # type: ignore[no-untyped-call]
        self.hint(begun(self.instance, self._each, start, self.sectors.graph))

    def read(self, solver: cp_model.CpSolver) -> tuple[Division, tuple[Seam, ...]]:
        """The division that a solver has found, and the seams that its darts refer to."""
        graph = self.sectors.graph
        painting = canonical(graph, self.painting(solver))
        return division_of(graph, painting, self.strands), graph.seams

    def _whole(self) -> list[list[Block]]:
        """Every cell painted whole, each in the color of its largest color region."""
        best: dict[int, tuple[int, int]] = {}
        for color, cells in self.regions:
            for cell in cells:
                best[cell] = max(best.get(cell, (0, 0)), (len(cells), -color))
        painting = [[Block(-best[cell.id][1], set())] for cell in self.instance.cells]
        return canonical(self.sectors.graph, painting)


class CompleteModelSolver:
    """Builds the complete model, solves it once, and does nothing else."""

    abilities = Abilities(search_spaces=("paper", "surface"), several_loops=True)

    version = f"OR-Tools {importlib.metadata.version('ortools')}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline."""
        if not instance.cells:
            return Answer((), (), ())
        try:
            built = CompleteModel(instance, options.strands, deadline=options.deadline)
        except OutOfTime:
            return Answer(None, (), ())
        runner = Runner(options)
        solver = runner.portfolio()

        def watch(segments: int) -> None:
            if progress is not None:
                progress(segments, 0)

        status = runner.solve(solver, built.model, watch)
        division: Division | None = None
        seams: tuple[Seam, ...] = ()
        if status in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            division, seams = built.read(solver)
        bounds = [Bound("cover", built.fewest_regions, "surface")]
        if isfinite(solver.best_objective_bound):
            bound = ceil(solver.best_objective_bound - 1e-6)
            if all(n <= options.strands for n in enough_crossings(instance).values()):
                bounds.append(Bound("crossings", bound, "surface"))
            bounds.append(Bound("model", bound, "strands"))
        return Answer(division, seams, tuple(bounds), (), built.size)
