"""The stages of the search for the fewest segments of one part (docs/solver.md, "Search").

``solver`` runs them in their order, each for all parts that are not proved yet, and hands every
stage its share of the time. A stage that runs out of it keeps what it has found.
"""

from __future__ import annotations

from collections.abc import Callable
from math import isfinite

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
from cellcolor.solvers.cpsat.planning import WIDE_GAP, Planning
from cellcolor.solvers.cpsat.routes.recoloring import FEW_MOVES
from cellcolor.solvers.interface import Options

FEW_DARTS = 10
"""Up to so many live darts in every cell, plans come before counting links."""

LITTLE = 2
"""The most segments by which plans are likely to raise a bound."""

SHARE_OF_ROUTES, SHARE_OF_PLANS = 1 / 4, 1 / 2
"""Of the time that is left in such a turn: the share of each way to improve the division, and then
that of plans."""

TURNS = 2
"""Turns in a row that may bring nothing before models are tried all the same."""

EFFORTS, MOST_EFFORT = 3, 100.0
"""How often plans are decided with more effort before the model of the whole, and the deterministic
seconds for a plan after which it is that model's turn."""

MOVES, MOVES_OF_SMALL = 1_000, 100
"""Moves of local search in vain, for each segment, before nothing better is expected. On a small
part plans and models soon find as much."""


class PartSearch(PartState):
    """A part and the stages of its search.

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
        self._turns = 0  # that were taken
        self._exact = 0  # the minimum, where it is known and not believed yet
        self._whole = self.best  # every cell painted whole

    def cover(self, deadline: Deadline) -> None:
        """A smallest set cover: the first bound, and a division with every cell painted whole."""
        found = set_cover(self.instance, None, deadline)
        self.cover_bound = max(self.bound, found.bound)
        self.planned = found.regions
        self.raise_to(found.bound, for_surface=True)
        color_of = {cell: color for color, cells in found.regions for cell in cells}
        whole: Painting = [[Block(color_of[c.id], set())] for c in self.instance.cells]
        self.offer(self.best[0], whole)
        self._whole = self.best[0], canonical(self.best[0], whole)

    def count_links(self, deadline: Deadline) -> None:
        """The bound by counting links around hubs, and the division made of what was counted."""
        found = hub_bound(self.instance, deadline)
        if found.value > self.surface_bound:
            self.raise_to(found.value, for_surface=True)
            self.hubs = found
        if found.hubs:
            whole = {cell: color for color, cells in self.planned for cell in cells}
            self.offer(*divide_hubs(self.connected, found.hubs, whole, self.options.seed, deadline))

    def count_many_links(self, deadline: Deadline) -> None:
        """Count links before plans, where a cell has more than ``FEW_DARTS`` live darts.

        In other parts plans are quick, and the conflicts that they find can be drawn.
        """
        if self.instance.most_live_darts > FEW_DARTS:
            self.count_links(deadline)

    def count_few_links(self, deadline: Deadline) -> None:
        """Count links after plans, where that was not done before them."""
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
                self.accept_exact(deadline)

    def accept_exact(self, _deadline: Deadline) -> None:
        """Take the minimum that ``solve_exactly`` found as the bound; it has no certificate."""
        self.raise_to(self._exact, for_surface=False)

    def recolor_best(self, deadline: Deadline) -> None:
        """Better divisions by local search.

        Around hubs the model of a small part works better, for divisions and for the bound.
        """
        if self.large or self.hubs is None:
            moves = MOVES if self.large else MOVES_OF_SMALL
            self.recolor(*self.best, self.options.seed, deadline, moves)

    def begin_large(self, deadline: Deadline) -> None:
        """A few moves before plans, so that plans can be compared with a good division."""
        if self.large:
            self.recolor(*self.best, self.options.seed, deadline, FEW_MOVES)

    def begin_again(self, seed: int, deadline: Deadline) -> None:
        """A few moves from the cells painted whole, as the cover has them."""
        self.recolor(*self._whole, seed, deadline, FEW_MOVES, whole_first=True)

    def plan_in_detail(self, deadline: Deadline) -> None:
        """Plans that say what segments avoid, too; on a small part they are decided one by one."""
        if self.large:
            self.planning.avoid(deadline)
        else:
            self.planning.decide(self.models.draw, deadline)

    def decide_plans(self, deadline: Deadline) -> None:
        """Plans of a small part, with more and more effort."""
        for _ in range(0 if self.large else EFFORTS):
            if not self.done and self.planning.effort < MOST_EFFORT:
                self.planning.decide(self.models.draw, deadline)

    def narrow_gap(self, deadline: Deadline) -> None:
        """Take turns while the gap is wide, until some in a row bring nothing."""
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
        """Improve the division with a new seed, then plan with more effort than before.

        Local search begins again from whole cells, then from the best division, since what it finds
        differs from start to start.
        """
        deadline.check()
        self._turns += 1
        seed = self.options.seed + self._turns
        self.begin_again(seed, deadline.share(SHARE_OF_ROUTES))
        self.recolor(*self.best, seed, deadline.share(SHARE_OF_ROUTES), MOVES)
        if not self.done:
            self.plan_harder(deadline.share(SHARE_OF_PLANS))

    def plan_harder(self, deadline: Deadline) -> None:
        """Plans with more effort, until their share of the time is over."""
        try:
            if self.large:
                self.planning.insist(deadline)
            else:
                self.planning.decide(self.models.draw, deadline)
        except OutOfTime as error:
            if isinstance(error, KeyboardInterrupt):
                raise
