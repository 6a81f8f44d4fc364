"""The reference solver as a :class:`cellcolor.solvers.interface.Solver`."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import islice
from typing import TypeVar

from cellcolor.data.bounds import Bound
from cellcolor.data.cells_and_edges import Cell, DartName
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam, number_segments
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import InputError
from cellcolor.solvers.dfs.cell_schemes import CellScheme
from cellcolor.solvers.dfs.graph import GraphCell, Graphs
from cellcolor.solvers.dfs.search import Search
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options

_T = TypeVar("_T")
_Blocks = list[tuple[int, list[DartName]]]
_Repeatable = Callable[[], Iterator[_T]]

_KEPT = 200_000
"""The most painted cells that are kept, all schemes of all parts of the graph together, while the
schemes of different parts are combined; they take some hundred megabytes at most."""


class ReferenceSolver:
    """The paper's depth-first enumerative solver (sections IV and V), counting segments.

    It is meant to be read beside the paper and to judge faster solvers on small instances.
    """

    abilities = Abilities(
        search_spaces=("paper", "surface"),
        several_loops=True,
        optimal_schemes=True,
    )

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """The best division that the time limit allowed.

        In the search space ``surface`` it has the fewest segments that ``options.strands``
        corridors across each edge allow, and the lower bound is one that any division obeys.
        """
        graphs = Graphs(instance, options.strands)
        parts = [_Part(graphs, cells, options.deadline) for cells in graphs.parts()]
        covers = sum(part.bound for part in parts)

        def report() -> None:
            if progress is not None:
                best = [part.segments for part in parts if part.segments is not None]
                total = sum(best) if len(best) == len(parts) else None
                progress(total, sum(part.bound for part in parts))

        report()
        try:
            for part in parts:
                for _ in part.improve():
                    report()
                if options.search_space == "paper" and part.segments is not None:
                    part.bound = part.segments  # the search was complete
                    report()
        except OutOfTime:
            pass
        bounds = (
            Bound("cover", covers, "surface"),
            Bound("search", sum(part.bound for part in parts), "strands"),
        )
        if any(part.segments is None for part in parts):
            return Answer(None, (), bounds)
        blocks = {cell: found for part in parts for cell, found in part.blocks.items()}
        seams = sorted((s for part in parts for s in part.seams), key=lambda seam: seam.id)
        return Answer(_division(instance, blocks), tuple(seams), bounds)

    def optimal_schemes(
        self, instance: Instance, options: Options, segments: int
    ) -> Iterator[Division]:
        """Every scheme with the given minimum, once.

        Raises:
            InputError: a cell has several live loops, or edges have strands: schemes are defined
                for neither.
            ValueError: ``segments`` is not the minimum.
        """
        if options.search_space != "paper" or options.strands != 1:
            raise InputError(
                None, "search_space", "optimal schemes are defined in the search space 'paper' only"
            )
        graphs = Graphs(instance, 1)
        for cell in graphs.cells_with_several_loops():
            raise InputError(
                None,
                f"cells[{cell}].loops",
                f"cell {cell} has several loops with live darts: optimal schemes are defined "
                "for cells with one",
            )
        return self._schemes(instance, graphs, options.deadline, segments)

    def _schemes(
        self, instance: Instance, graphs: Graphs, deadline: Deadline, segments: int
    ) -> Iterator[Division]:
        minima = []
        parts = graphs.parts()
        for cells in parts:
            part = _Part(graphs, cells, deadline)
            for _ in part.improve():
                pass
            minima.append(part.segments or 0)
        if sum(minima) != segments:
            raise ValueError(f"the minimum is {sum(minima)} segments, not {segments}")

        def of_part(cells: list[Cell], budget: int) -> Iterator[dict[int, _Blocks]]:
            graph = [graphs.cell(cell, 0)[0] for cell in cells]
            search = Search(graph, graphs.region, deadline)
            search.budget = budget
            for _, schemes in search.paintings():
                yield _named(graph, schemes)

        # Parts of the graph that no live edge connects are painted independently.
        streams, room = [], _KEPT
        for cells, budget in zip(parts, minima, strict=True):
            stream, used = _repeatable(partial(of_part, cells, budget), room // len(cells))
            streams.append(stream)
            room -= used * len(cells)
        for combined in _combinations(streams):
            deadline.check()
            blocks: dict[int, _Blocks] = {}
            for one in combined:
                blocks |= one
            yield _division(instance, blocks)


class _Part:
    """The minimum of one connected part of the graph.

    Attributes:
        segments: of the best division so far, None when there is none.
        bound: no division has fewer.
        blocks: the best division: color and darts of the sub-cells of each cell.
        seams: what its darts refer to.
    """

    def __init__(self, graphs: Graphs, cells: list[Cell], deadline: Deadline) -> None:
        self._graphs = graphs
        self._cells = cells
        self._deadline = deadline
        self.segments: int | None = None
        self.blocks: dict[int, _Blocks] = {}
        self.seams: list[Seam] = []
        several = {cell.id for cell in cells}.intersection(graphs.cells_with_several_loops())
        strands = (most for cell in several for most in graphs.sufficient_seam_strands(cell))
        self._enough = max(strands, default=0)
        self.bound = self._search(0)[1].bound

    def improve(self) -> Iterator[None]:
        """Search until the minimum is found; yields whenever there is a better division.

        Seams get one strand more each time until they have enough of them or the bound is met.

        Raises:
            OutOfTime: the deadline has passed.
        """
        for seam_strands in range(self._enough + 1):
            graph, search, seams = self._search(seam_strands)
            search.budget = sum(len(cell.colors) + len(cell.darts) for cell in graph)
            if self.segments is not None:
                search.budget = self.segments - 1
            for segments, schemes in search.paintings():
                search.budget = segments - 1
                self.segments = segments
                self.blocks = _named(graph, schemes)
                self.seams = seams
                yield
            if self.segments == self.bound:
                return

    def _search(self, seam_strands: int) -> tuple[list[GraphCell], Search, list[Seam]]:
        built = [self._graphs.cell(cell, seam_strands) for cell in self._cells]
        graph = [cell for cell, _ in built]
        search = Search(graph, self._graphs.region, self._deadline)
        return graph, search, [seam for _, seams in built for seam in seams]


def _repeatable(stream: Callable[[], Iterator[_T]], most: int) -> tuple[_Repeatable[_T], int]:
    """A stream to be read many times, and how many items are kept for that.

    Up to ``most`` items are kept in memory; a stream that has more is made again each time.
    """
    first = list(islice(stream(), most + 1))
    if len(first) > most:
        return stream, 0
    return first.__iter__, len(first)


def _combinations(streams: Sequence[_Repeatable[_T]]) -> Iterator[tuple[_T, ...]]:
    """One item of each stream in all ways, as :func:`itertools.product`, which keeps them all."""
    if not streams:
        yield ()
        return
    chosen: list[_T] = []
    running = [streams[0]()]
    while running:
        del chosen[len(running) - 1 :]
        try:
            chosen.append(next(running[-1]))
        except StopIteration:
            running.pop()
            continue
        if len(running) == len(streams):
            yield tuple(chosen)
        else:
            running.append(streams[len(running)]())


def _named(graph: Sequence[GraphCell], schemes: Iterable[CellScheme]) -> dict[int, _Blocks]:
    return {
        cell.id: [(color, [cell.darts[i] for i in darts]) for color, darts in scheme.subcells]
        for cell, scheme in zip(graph, schemes, strict=True)
    }


def _division(instance: Instance, blocks: dict[int, _Blocks]) -> Division:
    return number_segments([blocks[cell.id] for cell in instance.cells])
