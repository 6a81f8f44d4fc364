"""All optimal schemes: the solutions of a model, found in a thread and tested one by one.

Every scheme is a solution of the model (``scheme_model``), but so are some other divisions.
Conditions that concern more than one dart are tested on each solution.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import closing
from math import isfinite
from queue import SimpleQueue
from threading import Semaphore, Thread

from ortools.sat.python import cp_model

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division
from cellcolor.deadline import OutOfTime
from cellcolor.errors import CellcolorError, InputError
from cellcolor.solvers.cpsat.model.painting import Painting, division_of
from cellcolor.solvers.cpsat.model.seams import SeamWriter
from cellcolor.solvers.cpsat.model_runs import Runner
from cellcolor.solvers.cpsat.schemes.scheme_model import SchemeModel, check_size, unconnected_differ
from cellcolor.solvers.cpsat.schemes.zero_darts import zeros_can_differ
from cellcolor.solvers.interface import Options

_AHEAD = 100
"""Schemes that are found ahead of whoever takes them. With so many waiting the search pauses."""
_READING = 5e-6
"""Seconds a constraint that CP-SAT takes to read a model, before it first looks at the clock."""


def optimal_schemes(instance: Instance, options: Options, segments: int) -> Iterator[Division]:
    """Every scheme with the fewest segments, each once (semantics, section 3).

    The search runs in a thread that is never far ahead of the consumer.

    Args:
        instance: the topological graph.
        options: deadline and seed.
        segments: the minimum.

    Raises:
        InputError: the search space is ``surface``, for which schemes are not defined.
        OutOfTime: the deadline came first.
        TooLarge: the model would not fit into memory.
        CellcolorError: CP-SAT considered the model invalid.
    """
    if options.search_space != "paper":
        raise InputError(None, "search_space", "schemes are defined in search space 'paper' only")
    if not instance.cells:
        yield ()
        return
    runner = Runner(options)

    def solve(
        small: cp_model.CpModel,
    ) -> tuple[cp_model.CpSolver, cp_model.CpSolverStatus]:
        solver = runner.single()
        return solver, runner.solve(solver, small)

    writer = SeamWriter(instance, dict.fromkeys((e.id for e in instance.edges), 1), solve)
    graph = writer.graph
    check_size(graph, options.deadline)
    model = SchemeModel(graph, segments, options.deadline)
    with closing(_paintings(model, options)) as paintings:
        for painting in paintings:
            if (
                unconnected_differ(graph, painting)
                and zeros_can_differ(graph, painting, options.deadline)
                and writer.can_be_drawn(painting)
            ):
                yield division_of(graph, painting)


def _paintings(model: SchemeModel, options: Options) -> Generator[Painting, None, None]:
    """The paintings of all solutions of the model, as they are found.

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
        while isinstance(painting := found.get(), list):
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
