"""Solves the encodings for CP-SAT and reads their answers; the formulations are elsewhere."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Iterable
from importlib.metadata import version
from math import ceil
from typing import ClassVar

from ortools.sat.python import cp_model

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.hubs import most_links
from cellcolor.solvers.encodings.problem import Pair, Problem
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.interruptible import make_portfolio, solve_interruptibly
from cellcolor.solvers.joined_chains import division_of_chains

STRATEGIES = "core", "default_lp"
"""CP-SAT's strategies for one or two workers. ``core`` raises the bound by unsatisfiable cores;
``default_lp`` finds divisions, of which none is known here beforehand."""


class Encoding(ABC):
    """A model whose objective is the number of segments."""

    problem: Problem
    model: cp_model.CpModel
    joined: dict[tuple[int, int], cp_model.IntVar]
    """For each edge and color: the edge is joined in that color, and the join is counted."""
    root: dict[int, cp_model.IntVar]
    """Literals one of which is true for each tree of sub-cells, by cells or by darts."""
    alone: list[cp_model.IntVar]
    """For each cell: no join of it is counted, so it is a segment by itself."""

    @abstractmethod
    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        """Write the model."""

    @abstractmethod
    def links(self) -> Iterable[tuple[Pair, cp_model.IntVar]]:
        """Literals of pairs of darts: the second one follows the first in their sub-cell."""

    # Redundant: these two are implied by there being few segments, and make proofs quick.

    def _cover(self) -> None:
        """Each color region in use holds a root, and each cell touches one in use or is alone.

        This is the bound by set cover (docs/bounds.md), which the search can now reason with.
        """
        problem = self.problem
        used = [self.model.new_bool_var(f"used_{n}") for n in range(len(problem.regions))]
        for (edge, color), literal in self.joined.items():
            region = problem.region_of[color, problem.cell_of[edge]]
            self.model.add_implication(literal, used[region])
        for number, colors in enumerate(problem.cell_colors):
            touched = [used[problem.region_of[color, number]] for color in sorted(colors)]
            self.model.add_bool_or([self.alone[number], *touched])
        self.model.add(sum(self.root.values()) >= sum(used))

    def _most_links(self) -> None:
        """No cell has more links than can be drawn in it between darts of common colors."""
        links_of: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for (one, _), link in self.links():
            links_of[self.problem.cell_of[one]].append(link)
        for cell, links in links_of.items():
            darts = self.problem.cells[cell]
            self.model.add(sum(links) <= most_links([self.problem.colors_of(d) for d in darts]))


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
