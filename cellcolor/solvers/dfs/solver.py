"""The depth-first searches as solvers (:class:`cellcolor.solvers.interface.Solver`)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import DartName
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam, number_segments
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.dfs.graph import Graph
from cellcolor.solvers.dfs.search import CoverSearch, DepthFirstSearch, Painting
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options

_Blocks = dict[int, list[tuple[int, list[DartName]]]]
"""Color and darts of the sub-cells of each cell."""


class ReferenceSolver:
    """The paper's depth-first enumerative solver (sections IV and V), counting segments.

    It is meant to be read beside the paper, and to judge other solvers on small instances.
    """

    abilities = Abilities(
        search_spaces=("paper", "surface"), several_loops=True, optimal_schemes=True
    )
    search: type[DepthFirstSearch] = DepthFirstSearch
    bound_before: str | None = None
    """The kind of the bound that is known before the search and holds for any division."""

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """The best division that the time limit allowed."""
        parts = self._parts(instance, options)
        before = sum(part.bound for part in parts)

        def report() -> None:
            if progress is not None:
                best = [part.cost for part in parts if part.cost is not None]
                total = sum(best) if len(best) == len(parts) else None
                progress(total, sum(part.bound for part in parts))

        report()
        try:
            for part in parts:
                for _ in part.improve():
                    report()
                if options.search_space == "paper" and part.cost is not None:
                    part.bound = part.cost  # the search was complete
                    report()
        except OutOfTime:
            pass
        bounds = [Bound("search", sum(part.bound for part in parts), "strands")]
        if self.bound_before is not None:
            bounds.insert(0, Bound(self.bound_before, before, "surface"))
        if any(part.cost is None for part in parts):
            return Answer(None, (), tuple(bounds))
        blocks = {cell: found for part in parts for cell, found in part.blocks.items()}
        seams = sorted((s for part in parts for s in part.seams), key=lambda seam: seam.id)
        return Answer(_division(instance, blocks), tuple(seams), tuple(bounds))

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        """Every scheme with the fewest segments, once; cells have one live loop.

        Raises:
            ValueError: ``segments`` is not the minimum.
        """
        parts = self._parts(instance, options)
        for part in parts:
            for _ in part.improve():
                pass
        if (minimum := sum(part.cost or 0 for part in parts)) != segments:
            raise ValueError(f"the minimum is {minimum} segments, not {segments}")
        # Parts that no live edge connects are painted independently: one after the other, too.
        trail: list[Iterator[_Blocks]] = [iter([{}])]
        while trail:
            options.deadline.check()
            blocks = next(trail[-1], None)
            if blocks is None:
                trail.pop()
            elif len(trail) <= len(parts):
                trail.append(parts[len(trail) - 1].optimal_after(blocks))
            else:
                yield _division(instance, blocks)

    def _parts(self, instance: Instance, options: Options) -> list[_Part]:
        graph = Graph(instance, options.strands)
        return [_Part(self.search, graph, cells, options.deadline) for cells in graph.parts()]


class CoverReferenceSolver(ReferenceSolver):
    """The same search with a bound from a set cover, for instances that take it too long."""

    search = CoverSearch
    bound_before = "cover"


class _Part:
    """The minimum of one connected part of the graph.

    Attributes:
        cost: the number of segments of the best division so far, None when there is none.
        bound: no division has fewer.
        blocks: the best division; its darts refer to ``seams``.
    """

    def __init__(
        self, search: type[DepthFirstSearch], graph: Graph, cells: Sequence[int], deadline: Deadline
    ) -> None:
        self._kind, self._graph, self._cells, self._deadline = search, graph, cells, deadline
        self.cost: int | None = None
        self.blocks: _Blocks = {}
        self.seams: list[Seam] = []
        try:
            self.bound = self._search(0)[0].least(Painting())
        except OutOfTime as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            self.bound = 1

    def improve(self) -> Iterator[None]:
        """Search until the minimum is found; yields whenever there is a better division.

        Seams get one strand more each time until they have enough of them or the bound is met.
        """
        strands = (n for cell in self._cells for n in self._graph.sufficient_seam_strands(cell))
        for seam_strands in range(max(strands, default=0) + 1):
            search, seams = self._search(seam_strands)
            if self.cost is not None:
                search.budget = self.cost - 1
            for painting in search.paintings():
                self.cost = painting.cost
                search.budget = self.cost - 1
                self.blocks, self.seams = _named(search, painting), seams
                yield
            if self.cost == self.bound:
                return

    def optimal_after(self, blocks: _Blocks) -> Iterator[_Blocks]:
        """Every painting with the minimum, beside those of other parts."""
        search, _ = self._search(0)
        search.budget = self.cost or 0
        for painting in search.paintings():
            yield blocks | _named(search, painting)

    def _search(self, seam_strands: int) -> tuple[DepthFirstSearch, list[Seam]]:
        built = [self._graph.cell(cell, seam_strands) for cell in self._cells]
        cells = [cell for cell, _ in built]
        search = self._kind(self._graph, cells, self._deadline)
        return search, [seam for _, seams in built for seam in seams]


def _named(search: DepthFirstSearch, painting: Painting) -> _Blocks:
    return {
        cell.id: [(color, [cell.darts[i] for i in darts]) for color, darts in scheme.subcells]
        for cell, scheme in zip(search.cells, painting.schemes, strict=True)
    }


def _division(instance: Instance, blocks: _Blocks) -> Division:
    return number_segments([blocks[cell.id] for cell in instance.cells])
