"""All optimal schemes: counted and listed, or else found one by one.

Every scheme is a solution of CP-SAT's model (``scheme_model``), but so are some other divisions.
Conditions that concern more than one dart are tested on each solution.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Mapping, Sequence
from contextlib import closing
from hashlib import blake2b
from math import isfinite
from queue import SimpleQueue
from random import Random
from threading import Semaphore, Thread

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.errors import CellcolorError, InputError, TooLarge
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.cpsat.model.painting import (
    Block,
    Painting,
    canonical,
    division_of,
    moved,
    painting_of,
)
from cellcolor.solvers.cpsat.model.seams import Drawings
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.schemes.cell_divisions import Blocks
from cellcolor.solvers.cpsat.schemes.frontier import Frontier
from cellcolor.solvers.cpsat.schemes.scheme_model import SchemeModel, check_size, unconnected_differ
from cellcolor.solvers.cpsat.schemes.zero_darts import zeros_can_differ
from cellcolor.solvers.interface import Options
from cellcolor.union_find import UnionFind

_AHEAD = 100
"""The most schemes found but not yet taken; then the search pauses."""
_COUNTING = 1 / 4
"""Share of the time that is left for counting; the search needs the rest if that is given up."""
_NEARBY = 0.3
"""Seconds for all the schemes around a known one."""
_KNOWN = 1000
"""Schemes around which others are looked for."""
_NO_MORE = object()
_READING = 5e-6
"""Seconds a constraint that CP-SAT takes to read a model, before it first looks at the clock."""


class OptimalSchemes(Iterator[Division]):
    """Every scheme with the fewest segments, each once (semantics, section 3).

    Dynamic programming over the cells (``frontier``) counts and lists them where it has few enough
    fronts. Else CP-SAT searches in a thread that is never far ahead of the consumer. While that
    finds nothing, schemes are looked for that differ from a known one in a few cells.

    Args:
        options: deadline, seed, and a division to start from.
        segments: the minimum.

    Raises:
        InputError: the search space is ``surface``, for which schemes are not defined.
        OutOfTime: the deadline came first.
        TooLarge: the model would not fit into memory.
        CellcolorError: CP-SAT considered the model invalid.
    """

    def __init__(self, instance: Instance, options: Options, segments: int) -> None:
        self._search = _Search(instance, options, segments)
        self._found = self._search.all()

    @property
    def count(self) -> int | None:
        """How many there are; None as long as that is not known."""
        return self._search.count

    def __next__(self) -> Division:
        return next(self._found)

    def close(self) -> None:
        """End the search."""
        self._found.close()


class _Search:
    """The search of :class:`OptimalSchemes`. It does not hold them: to drop them ends it."""

    def __init__(self, instance: Instance, options: Options, segments: int) -> None:
        self.options = options
        self.count: int | None = None
        self._graph: DartGraph
        self._drawings: Drawings
        self._instance, self._segments = instance, segments

    def all(self) -> Generator[Division, None, None]:
        instance, options = self._instance, self.options
        if options.search_space != "paper":
            message = "schemes are defined in search space 'paper' only"
            raise InputError(None, "search_space", message)
        if not instance.cells:
            self.count = 1
            yield ()
            return
        runner = Runner(options)

        def solve(
            small: cp_model.CpModel,
        ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
            solver = runner.single()
            return solver, runner.solve(solver, small)

        colors = [frozenset(cell.colors) for cell in instance.cells]
        once = dict.fromkeys(instance.live_edges, 1)
        graph = self._graph = dart_graph(instance, colors, once, None)
        self._drawings = Drawings(graph, solve)
        start = self._start()
        if start is not None:
            yield division_of(graph, start)
        try:
            frontier = self._counted(options.deadline.share(_COUNTING))
        except (OutOfTime, TooLarge) as error:
            if isinstance(error, KeyboardInterrupt):
                raise
            options.deadline.check()
        else:
            self.count = frontier.count
            for painting in frontier.paintings():
                options.deadline.check()
                if painting != start:
                    yield division_of(graph, painting)
            return
        check_size(graph, options.deadline)
        model = SchemeModel(graph, self._segments, options.deadline)
        seen = set() if start is None else {_key(division_of(graph, start))}
        with closing(_paintings(model, options, self._nearby(start))) as paintings:
            for painting in paintings:
                division = division_of(graph, painting)
                if (key := _key(division)) not in seen and self._is_scheme(painting):
                    seen.add(key)
                    yield division
        self.count = len(seen)

    def _is_scheme(self, painting: Painting) -> bool:
        """Whether a painting with the fewest segments keeps the rules that the model leaves out."""
        graph = self._graph
        return (
            all(map(unconnected_differ, graph.loops, painting))
            and zeros_can_differ(graph, painting, self.options.deadline)
            and self._drawings.possible(painting)
        )

    def _start(self) -> Painting | None:
        """The scheme of the division to start from."""
        start, graph = self.options.start, self._graph
        if start is None:
            return None
        strands = dict.fromkeys(self._instance.live_edges, 1)
        seamed = dart_graph(self._instance, graph.colors, strands, start.seams)
        whole = [_unseamed(seamed, blocks) for blocks in painting_of(seamed, start.division)]
        settled = canonical(graph, moved(seamed, whole, graph))
        return settled if self._is_scheme(settled) else None

    def _counted(self, deadline: Deadline, given: Mapping[int, Blocks] | None = None) -> Frontier:
        regions = color_regions(self._instance)
        draw = self._drawings.possible_in
        return Frontier(self._graph, regions, self._segments, draw, deadline, given)

    def _nearby(self, start: Painting | None) -> Iterator[Painting | None]:
        """Schemes that differ from a known one in a few cells only; None after each try."""
        if start is None:
            return
        graph, rng, known = self._graph, Random(self.options.seed), [start]
        around = [
            sorted({graph.darts[graph.darts[dart].twin].cell for dart in own})
            for own in graph.lists
        ]
        size = 2
        while True:
            free = [rng.randrange(len(around))]
            for cell in free:
                beside = [other for other in around[cell] if other not in free]
                free += rng.sample(beside, len(beside))
                if len(free) >= size:
                    break
            given = {
                cell: tuple((block.color, tuple(sorted(block.darts))) for block in blocks)
                for cell, blocks in enumerate(rng.choice(known))
                if cell not in free[:size]
            }
            try:
                deadline = Deadline.after(min(_NEARBY, self.options.deadline.left))
                yield from self._new(self._counted(deadline, given), known, rng)
                size = min(size + 1, len(around))
            except (OutOfTime, TooLarge) as error:
                if isinstance(error, KeyboardInterrupt):
                    raise
                size = max(size - 2, 1)
            yield None

    def _new(self, frontier: Frontier, known: list[Painting], rng: Random) -> Iterator[Painting]:
        """The schemes around a known one; a few of them are known from now on."""
        for painting in frontier.paintings():
            if len(known) < _KNOWN:
                known.append(painting)
            elif rng.random() < 0.01:
                known[rng.randrange(_KNOWN)] = painting
            yield painting


def _unseamed(graph: DartGraph, blocks: Sequence[Block]) -> list[Block]:
    """A cell's sub-cells on the surface: seams neither divide them nor have darts."""
    seams = {seam.id for seam in graph.seams}
    holder = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    whole: UnionFind[int] = UnionFind(range(len(blocks)))
    virtual = {dart for dart in holder if abs(graph.darts[dart].name[0]) in seams}
    for dart in virtual:
        if graph.darts[dart].twin in virtual:
            whole.union(holder[dart], holder[graph.darts[dart].twin])
    return [
        Block(
            blocks[min(parts)].color,
            {dart for part in parts for dart in blocks[part].darts if dart not in virtual},
        )
        for parts in whole.sets()
    ]


def _key(division: Division) -> bytes:
    """What tells schemes apart, in 16 bytes."""
    blocks = [sorted((s.color, sorted(s.darts)) for s in cell.subcells) for cell in division]
    return blake2b(repr(blocks).encode(), digest_size=16).digest()


def _paintings(
    model: SchemeModel, options: Options, beside: Iterator[Painting | None]
) -> Generator[Painting, None, None]:
    """The paintings of all solutions of the model as they are found, and while none is, others.

    Raises:
        OutOfTime: the deadline came first.
        CellcolorError: CP-SAT considered the model invalid.
    """
    solver = cp_model.CpSolver()
    solver.parameters.enumerate_all_solutions = True
    solver.parameters.num_workers = 1
    solver.parameters.random_seed = options.seed
    solver.parameters.catch_sigint_signal = False
    if isfinite(options.deadline.moment):
        solver.parameters.max_time_in_seconds = options.deadline.left
        if options.deadline.left < _READING * len(model.model.proto.constraints):
            raise OutOfTime("the time would run out while CP-SAT reads the model of all schemes")
    collector = _Collector(model)
    found = collector.found

    def search() -> None:
        try:
            found.put(solver.solve(model.model, collector))
        except Exception as error:
            found.put(error)  # or whoever takes the schemes would wait for ever

    thread = Thread(target=search)
    thread.start()
    try:
        while True:
            if found.empty() and (other := next(beside, _NO_MORE)) is not _NO_MORE:
                options.deadline.check()
                if isinstance(other, list):
                    yield other
                continue
            if not isinstance(painting := found.get(), list):
                break
            options.deadline.check()
            collector.room.release()
            yield painting
    finally:
        collector.stop()
        while thread.is_alive():  # a stop that comes before the search does is lost
            solver.stop_search()
            thread.join(0.1)
    if isinstance(painting, Exception):
        raise painting
    if painting == cp_model.MODEL_INVALID:
        raise CellcolorError("CP-SAT says that the model of all schemes is not valid")
    if painting not in (cp_model.OPTIMAL, cp_model.INFEASIBLE):
        raise OutOfTime("the time limit ended the enumeration of schemes")


class _Collector(cp_model.CpSolverSolutionCallback):
    """Puts each solution's painting into a queue.

    Attributes:
        found: the paintings, and after the last one the solver's status, or why it broke down.
        room: to be released for each painting that was taken.
    """

    def __init__(self, model: SchemeModel) -> None:
        super().__init__()
        self._model = model
        self._over = False
        self.found: SimpleQueue[Painting | cp_model.CpSolverStatus | Exception] = SimpleQueue()
        self.room = Semaphore(_AHEAD)

    def stop(self) -> None:
        """End the search, though nobody takes what it has found."""
        self._over = True
        self.room.release()

    def on_solution_callback(self) -> None:
        self.room.acquire()
        if self._over:
            self.room.release()
            self.stop_search()
            return
        self.found.put(self._model.painting(self.boolean_value))
