"""The search for the fewest segments of one part: bounds, plans, routes, and the full model."""

from __future__ import annotations

from collections.abc import Callable

from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import set_cover
from cellcolor.solvers.bounds.hubs import hub_bound
from cellcolor.solvers.cpsat.hubs.division import divide_hubs
from cellcolor.solvers.cpsat.improving import Improving
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.model_search import ModelSearch
from cellcolor.solvers.cpsat.part_state import PartState
from cellcolor.solvers.cpsat.parts import ConnectedPart
from cellcolor.solvers.cpsat.planning import Planning
from cellcolor.solvers.interface import Options

FEW_DARTS = 10
"""The live darts of a cell up to which planning comes before counting links."""


class PartSearch(PartState):
    """A part and the stages of its search, which the solver puts in order.

    Attributes:
        planning: plans, and divisions by routing them.
        improving: better divisions by other routes and windows.
        models: the full model.
    """

    def __init__(
        self, part: ConnectedPart, options: Options, runner: Runner, report: Callable[[], None]
    ) -> None:
        super().__init__(part, options, runner, report)
        self.planning = Planning(self)
        self.improving = Improving(self)
        self.models = ModelSearch(self)

    def cover(self, deadline: Deadline) -> None:
        """The first bound, and a division that follows from a smallest cover."""
        found = set_cover(self.instance, None, deadline)
        self.cover_bound = max(self.bound, found.bound)
        self.planned = found.regions
        self.raise_to(found.bound, for_surface=True)
        color_of = {cell: color for color, cells in found.regions for cell in cells}
        whole: Painting = [[Block(color_of[c.id], set())] for c in self.instance.cells]
        self.offer(self.best[0], whole)

    def count_links(self, deadline: Deadline, *, before_plans: bool) -> None:
        """A bound by what fits side by side in cells with many edges, and a matching division.

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
            self.raise_to(found.value, for_surface=True)
            self.hubs = found
        if found.hubs:
            whole = {cell: color for color, cells in self.planned for cell in cells}
            self.offer(*divide_hubs(self.connected, found.hubs, whole, self.options.seed, deadline))
