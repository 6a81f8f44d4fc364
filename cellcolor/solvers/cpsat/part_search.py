"""The stages of the search for the fewest segments of one part (docs/solver.md, "Search")."""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import set_cover
from cellcolor.solvers.bounds.hubs import hub_bound
from cellcolor.solvers.cpsat.exact_shapes import exact_minimum
from cellcolor.solvers.cpsat.hub_division import divide_hubs
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.model_search import ModelSearch
from cellcolor.solvers.cpsat.part_state import PartState
from cellcolor.solvers.cpsat.parts import ConnectedPart
from cellcolor.solvers.cpsat.planning import Planning
from cellcolor.solvers.cpsat.routes.dropping import FRUITLESS, drop_segments
from cellcolor.solvers.cpsat.routes.recoloring import FEW_MOVES
from cellcolor.solvers.cpsat.windows import improve
from cellcolor.solvers.interface import Options

FEW_DARTS = 10
"""The live darts of a cell up to which planning comes before counting links."""

LITTLE = 2
"""Segments by which plans can be expected to raise a bound."""

WIDE_GAP, SHARE_OF_ROUTES = 2, 1 / 4
"""Segments above the bound from which other routes are tried before models; and what part of the
time that is left one kind of them gets before the other has its turn."""

SHARE_OF_PLANS = 1 / 2
"""What part of the time that is then left plans get in such a turn."""

MORE_TRIES = 10
"""Segments left out in vain for each segment, once other routes have their turns."""

MOVES = 1_000
"""Moves of local search in vain for each segment, before nothing better is expected."""

TURNS = 2
"""Turns of both kinds in a row without a better division before models are tried all the same."""

WINDOW_EFFORT = 0.1
"""Deterministic seconds for the model of a window."""


class PartSearch(PartState):
    """A part and the stages of its search, which the solver puts in order.

    Attributes:
        planning: plans, and divisions by routing them.
        models: the full model.
    """

    def __init__(
        self, part: ConnectedPart, options: Options, runner: Runner, report: Callable[[], None]
    ) -> None:
        super().__init__(part, options, runner, report)
        self.planning = Planning(self)
        self.models = ModelSearch(self)
        self._turns = self._exact = 0
        self._whole = self.best

    def cover(self, deadline: Deadline) -> None:
        """The first bound, and a division that follows from a smallest cover."""
        found = set_cover(self.instance, None, deadline, self.costs)
        self.cover_bound = max(self.bound, found.bound)
        self.planned = found.regions
        self.raise_to(found.bound, for_surface=True)
        color_of = {cell: color for color, cells in found.regions for cell in cells}
        whole: Painting = [[Block(color_of[c.id], set())] for c in self.instance.cells]
        self.offer(self.best[0], whole)
        self._whole = self.best[0], canonical(self.best[0], whole)

    def count_links(self, deadline: Deadline) -> None:
        """A bound by what fits side by side in cells with many edges, and a matching division."""
        found = hub_bound(self.instance, deadline)
        if found.value > self.surface_bound:
            self.raise_to(found.value, for_surface=True)
            self.hubs = found
        if found.hubs:
            whole = {cell: color for color, cells in self.planned for cell in cells}
            self.offer(*divide_hubs(self.connected, found.hubs, whole, self.options.seed, deadline))

    def count_many_links(self, deadline: Deadline) -> None:
        """The same before plans, where a cell has more than ``FEW_DARTS`` live darts.

        In other parts plans are quick, and their conflicts have four areas that can be drawn.
        """
        if self.instance.most_live_darts > FEW_DARTS:
            self.count_links(deadline)

    def count_few_links(self, deadline: Deadline) -> None:
        """After plans, where that was not done before them."""
        if self.instance.most_live_darts <= FEW_DARTS:
            self.count_links(deadline)

    def solve_exactly(self, deadline: Deadline) -> None:
        """The minimum of a part whose shape allows a recursion (``exact_shapes``).

        If little is missing, plans come first: what they prove holds for any division of the
        surface, and has a certificate.
        """
        found = exact_minimum(self.connected, deadline)
        if found is None:
            return
        graph = self.narrow_graph()
        self.offer(graph, found.painting(graph))
        if max(self.widest.values(), default=1) == 1:
            self._exact = found.segments
            if self._exact > self.bound + LITTLE:
                self.count_few_links(deadline)
                self.believe_exact(deadline)

    def believe_exact(self, _deadline: Deadline) -> None:
        """Take the minimum as the bound."""
        self.raise_to(self._exact, for_surface=False)

    def drop(self, deadline: Deadline) -> None:
        """Better divisions by leaving out a segment and rerouting all others.

        Around hubs the model works better, for divisions and for the bound.
        """
        if self.hubs is None and not self.large:
            self._drop(self.options.seed, deadline, FRUITLESS)

    def recolor_large(self, deadline: Deadline) -> None:
        """Better divisions of a large part by local search.

        On small parts other routes and windows find as much or more.
        """
        if self.large:
            self.recolor(*self.best, self.options.seed, deadline, MOVES)

    def begin_large(self, deadline: Deadline) -> None:
        """A few moves before plans, so that plans can be compared with a good division."""
        if self.large:
            self.recolor(*self.best, self.options.seed, deadline, FEW_MOVES)

    def begin_again(self, seed: int, deadline: Deadline) -> None:
        """A few moves from the cells painted whole, as the cover has them."""
        self.recolor(*self._whole, seed, deadline, FEW_MOVES, whole_first=True)

    def narrow_gap(self, deadline: Deadline) -> None:
        """Take turns, where more is missing than a model is likely to close."""
        in_vain = 0
        while in_vain < TURNS and self.hubs is None and self.segments - self.bound >= WIDE_GAP:
            before, bound = self.segments, self.bound
            self._take_turns(deadline)
            closer = self.segments < before or self.bound > bound
            in_vain = 0 if closer else in_vain + 1

    def improve_on(self, deadline: Deadline) -> None:
        """Take turns as long as there is time."""
        while isfinite(deadline.moment) and not self.done:
            self._take_turns(deadline)

    def _take_turns(self, deadline: Deadline) -> None:
        """Local search on a large part; on others segments left out, then windows. New seeds.

        Local search begins again from whole cells, then goes on from the best division, since what
        it finds differs from start to start. Then plans, with more effort each time.
        """
        deadline.check()
        self._turns += 1
        seed = self.options.seed + self._turns
        if self.large:
            self.begin_again(seed, deadline.share(SHARE_OF_ROUTES))
            self.recolor(*self.best, seed, deadline.share(SHARE_OF_ROUTES), MOVES)
        else:
            self._drop(seed, deadline.share(SHARE_OF_ROUTES), MORE_TRIES)
            graph, painting = self.best
            self.keep_all(
                graph,
                improve(
                    graph,
                    painting,
                    self._solve_window,
                    seed,
                    deadline.share(SHARE_OF_ROUTES),
                    self.costs,
                ),
            )
        if not self.done:
            self.insist(deadline.share(SHARE_OF_PLANS))

    def insist(self, deadline: Deadline) -> None:
        """Plans with more effort, until their share of the time is over."""
        try:
            self.planning.insist(deadline)
        except OutOfTime as error:
            if isinstance(error, KeyboardInterrupt):
                raise

    def _drop(self, seed: int, deadline: Deadline, tries: float) -> None:
        graph, painting = self.best
        self.keep_all(graph, drop_segments(graph, painting, self.regions, seed, deadline, tries))

    def _solve_window(
        self, model: cp_model.CpModel, seed: int
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = self.runner.single(WINDOW_EFFORT, seed)
        return solver, self.runner.solve(solver, model)
