"""Solves the encodings for CP-SAT and reads their answers; the formulations are elsewhere."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from importlib.metadata import version
from math import ceil
from typing import ClassVar

from ortools.sat.python import cp_model

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.encodings.problem import Pair, Problem
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.interruptible import make_portfolio, solve_interruptibly
from cellcolor.solvers.joined_chains import division_of_chains

STRATEGIES = "core", "default_lp"
"""CP-SAT's strategies for one or two workers. ``core`` raises the bound by unsatisfiable cores;
``default_lp`` finds divisions, of which none is known here beforehand."""


class Encoding(ABC):
    """A model whose objective is the number of segments."""

    model: cp_model.CpModel
    joined: dict[tuple[int, int], cp_model.IntVar]
    """For each edge and color: the edge is joined in that color, and the join is counted."""

    @abstractmethod
    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        """Write the model.

        Raises:
            OutOfTime: the deadline came first.
        """

    @abstractmethod
    def links(self) -> Iterable[tuple[Pair, cp_model.IntVar]]:
        """Literals of pairs of darts: the second one follows the first in their sub-cell."""


class EncodingSolver:
    """Minimizes segments in the search space ``paper``; each cell may have one live loop."""

    abilities: ClassVar[Abilities] = Abilities()
    encoding: ClassVar[type[Encoding]]

    @property
    def version(self) -> str:
        """OR-Tools and its version."""
        return f"OR-Tools {version('ortools')}"

    def minimize(
        self, instance: Instance, options: Options, progress: OnProgress | None = None
    ) -> Answer:
        """A division with the fewest segments, or the best found before the deadline.

        Raises:
            InputError: a cell has several loops with live darts.
            TooLarge: the model would not fit into memory.
        """
        try:
            problem = Problem.of(instance, options.deadline)
            built = self.encoding(problem, options.deadline)
        except OutOfTime:
            return Answer(None, (), ())
        solver = make_portfolio(options.deadline, options.workers, options.seed, STRATEGIES)
        found = None if progress is None else lambda segments: progress(segments, 0)
        status, interrupt = solve_interruptibly(solver, built.model, found)
        if interrupt is not None and not isinstance(interrupt, OutOfTime):
            raise interrupt
        if status in (cp_model.INFEASIBLE, cp_model.MODEL_INVALID):
            raise AssertionError(f"{self.encoding.__name__}: every instance has a division")
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            return Answer(None, (), (Bound("model", 0, "strands"),))
        colors = {edge: c for (edge, c), on in built.joined.items() if solver.boolean_value(on)}
        after = dict(pair for pair, literal in built.links() if solver.boolean_value(literal))
        # The bound is a number of segments, so it may be rounded up.
        bound = ceil(solver.best_objective_bound - 1e-6)
        division = division_of_chains(instance, colors, after)
        return Answer(division, (), (Bound("model", bound, "strands"),))
