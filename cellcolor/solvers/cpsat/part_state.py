"""What is known about a part: its best division, and its proved bounds.

A part is what live edges connect (``parts``). A strand is one of the parallel corridors by which
segments may cross an edge, or a seam between two loops of a cell (docs/semantics.md, sections 4
and 5).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property

from cellcolor.data.solution import Seam
from cellcolor.deadline import Deadline
from cellcolor.solvers.bounds.cover import Region, color_regions, greedy_strangers
from cellcolor.solvers.bounds.hubs import HubBound
from cellcolor.solvers.bounds.reductions import enough_crossings
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph, widened
from cellcolor.solvers.cpsat.model.full import model_size
from cellcolor.solvers.cpsat.model.painting import Block, Painting, canonical, segments_of
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.parts import ConnectedPart
from cellcolor.solvers.cpsat.routes.recoloring import recolor
from cellcolor.solvers.interface import Options

FEW_STRANDS = 2
"""Strands of a seam in the first models. More would only be needed if their result did not meet the
lower bound."""

LARGE_MODEL = 200_000
"""Terms of a part's model; a larger part is first improved by local search."""


class PartState:
    """The best division of a part so far, and its proved bounds.

    Attributes:
        connected: the part itself, with its seams and loops.
        instance: the part's, in the colors that are left of each cell.
        cells: the cell of the whole instance that each cell of the part is.
        colors: of each cell of the part.
        options: of the whole search.
        runner: runs models, until the deadline or an interrupt.
        once: one strand of each live edge, as in the paper.
        segments: of the best division.
        bound: no division in the search space has fewer segments.
        surface_bound: no division of the surface has fewer.
        best: the best division, on its dart graph.
        cover_bound: the size of a smallest cover, or what is proved of it.
        planned: the colors and cells of the segments that were planned last, first of a cover.
        hubs: what counting links in hubs proves; None unless that is more than all before it.
    """

    def __init__(
        self, part: ConnectedPart, options: Options, runner: Runner, report: Callable[[], None]
    ) -> None:
        self.connected = part
        self.instance = part.instance
        self.cells = part.cells
        self.colors = tuple(frozenset(cell.colors) for cell in part.instance.cells)
        self.options = options
        self.runner = runner
        self._report = report
        self._enough = enough_crossings(part.instance, self.colors)
        self.once = dict.fromkeys(self._enough, 1)
        self.bound = self.surface_bound = len(greedy_strangers(part.instance))
        self.cover_bound = self.bound
        self.planned: Sequence[Region] = ()
        self.hubs: HubBound | None = None
        self._running: int | None = None
        graph = self.narrow_graph()
        whole: Painting = [[Block(min(own), set())] for own in self.colors]
        self.best = graph, canonical(graph, whole)
        self.segments = len(segments_of(*self.best))

    @cached_property
    def regions(self) -> list[Region]:
        """The color regions: for each color the sets of cells that it connects."""
        return color_regions(self.instance)

    @property
    def done(self) -> bool:
        """Whether the best division is proved, or there is no time left."""
        return self.segments == self.bound or self.runner.over

    @property
    def known(self) -> int:
        """Segments of the best division, that of a model that is still running included."""
        return self.segments if self._running is None else min(self.segments, self._running)

    @property
    def proved_for_surface(self) -> int:
        """No division of the surface has fewer segments.

        Where more corridors across an edge are never needed, the bound is one for the surface.
        """
        wide = all(enough <= self.options.strands for enough in self._enough.values())
        return self.bound if wide else self.surface_bound

    @property
    def widest(self) -> dict[int, int]:
        """As many strands of each live edge as were asked for and can be needed."""
        most = self.options.strands
        return {edge: int(min(most, enough)) for edge, enough in self._enough.items()}

    @property
    def large(self) -> bool:
        """Whether it is improved by local search before a model of the whole is thought of."""
        return model_size(self.best[0]) >= LARGE_MODEL

    def narrow_graph(self) -> DartGraph:
        """The part's darts with one strand of each edge, and few of each seam."""
        seams = self.seams(self.once, FEW_STRANDS)
        return dart_graph(self.instance, self.colors, self.once, seams, self.connected.loops)

    def seams(self, strands: dict[int, int], most: int | None) -> tuple[Seam, ...]:
        """The part's seams, as wide as can be needed beside such strands.

        Args:
            strands: of each live edge.
            most: strands of a seam; None for no limit.
        """
        part = self.connected
        return widened(self.instance, self.colors, strands, part.loops, part.seams, most)

    def offer(self, graph: DartGraph, painting: Painting) -> None:
        """A painting, which is kept if it is the best so far."""
        self.keep(graph, canonical(graph, painting))

    def keep(self, graph: DartGraph, painting: Painting) -> None:
        """The same for a canonical one."""
        segments = len(segments_of(graph, painting))
        if segments < self.segments:
            self.segments, self.best = segments, (graph, painting)
            self._report()

    def keep_all(self, graph: DartGraph, better: Iterable[Painting]) -> None:
        """Better and better canonical paintings, until the best is proved or there is no time."""
        for painting in better:
            self.keep(graph, painting)
            if self.done:
                return

    def recolor(
        self,
        graph: DartGraph,
        painting: Painting,
        seed: int,
        deadline: Deadline,
        moves: int,
        *,
        whole_first: bool = False,
    ) -> None:
        """What local search makes of a canonical painting, kept if it is the best so far.

        Args:
            graph: the part's.
            painting: where to begin.
            seed: of the choice of moves.
            moves: in vain, for each segment.
            whole_first: whether to begin with cells that are painted whole.
        """
        for rings in (0, 1) if whole_first else (1,):
            for better in recolor(graph, painting, seed, self.bound, deadline, moves, rings):
                painting = better
                self.keep(graph, painting)
                if self.done:
                    return

    def raise_to(self, bound: int, *, for_surface: bool) -> None:
        """A bound that is proved, in the search space alone or for any division of the surface."""
        if bound > self.bound:
            self.bound = bound
            self._report()
        if for_surface and bound > self.surface_bound:
            self.surface_bound = bound
            self.hubs = None

    def watch(self, segments: int | None) -> None:
        """What the running model has found so far, None when it has ended.

        Its division is offered only then, but how many segments that has is known at once.
        """
        self._running = segments
        if segments is not None:
            self._report()
