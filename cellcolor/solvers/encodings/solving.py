"""Solves the encodings for CP-SAT and reads their answers; the formulations are elsewhere."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import defaultdict
from collections.abc import Callable, Iterable
from importlib.metadata import version
from math import ceil
from typing import ClassVar

from ortools.sat.python import cp_model

from cellcolor.data.bounds import Bound
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.bounds.hubs import best_grouping
from cellcolor.solvers.encodings.problem import Pair, Problem
from cellcolor.solvers.interface import Abilities, Answer, OnProgress, Options
from cellcolor.solvers.interruptible import make_portfolio, solve_interruptibly
from cellcolor.solvers.joined_chains import division_of_chains

STRATEGIES = "core", "default_lp"
"""CP-SAT's strategies for one or two workers. ``core`` raises the bound by unsatisfiable cores;
``default_lp`` finds divisions, since none is known at the start."""


class Encoding(ABC):
    """A model whose objective is the number of segments; each constraint group is a method."""

    joined: dict[tuple[int, int], cp_model.IntVar]
    """For each edge and color: the edge is joined in that color, and the join is counted."""
    root: dict[int, cp_model.IntVar]
    """Literals one of which is true for each tree of sub-cells, by cells or by darts."""
    alone: list[cp_model.IntVar]
    """For each cell: no join of it is counted, so it is a segment by itself."""

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        """Write the model."""
        self.problem, self.deadline = problem, deadline
        self.model = model = cp_model.CpModel()
        self.joined = {
            (edge, color): model.new_bool_var(f"joined_{edge}_{color}")
            for edge, colors in problem.colors.items()
            for color in sorted(colors)
        }
        self._variables()
        # These four make proofs quick. Every division with the fewest segments satisfies cover and
        # links; some such division satisfies homes and petals too.
        redundant = self._cover, self._most_links, self._homes, self._first_petal
        for group in (*self._groups(), *redundant):
            deadline.check()
            group()
        model.minimize(sum(self.root.values()) + sum(self.alone))

    @abstractmethod
    def _variables(self) -> None:
        """Make all other variables."""

    @abstractmethod
    def _groups(self) -> tuple[Callable[[], None], ...]:
        """The constraint groups, in the order in which they are called."""

    @abstractmethod
    def links(self) -> Iterable[tuple[Pair, cp_model.IntVar]]:
        """Literals of pairs of darts: the second one follows the first in their sub-cell."""

    @abstractmethod
    def _homes(self) -> None:
        """A segment that reaches the home of its color region has its root there."""

    @abstractmethod
    def _first_petal(self) -> None:
        """Among the petals around a sub-cell, only the first can be the root, unless it is a home.

        A petal, a cell with a single live dart, is never divided: a tree with its root in one petal
        can have it in any other one as well.
        """

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
            colors = [self.problem.colors_of(dart) for dart in self.problem.cells[cell]]
            self.model.add(sum(links) <= best_grouping(colors).links)


class Trees(Encoding):
    """A segment as a tree of sub-cells: in each but the root one dart leads up to the parent.

    This is what ``pointers`` and ``ranks`` share: chains of darts in one color that do not cross.
    """

    up: dict[int, cp_model.IntVar]
    """Per dart: the parent of its sub-cell lies across it."""

    @abstractmethod
    def _link(self, one: int, other: int) -> list[cp_model.IntVar]:
        """The literals that make neighbors of two darts in list order."""

    def _counted(self, dart: int) -> cp_model.LinearExpr:
        """1 if the dart's join is counted: its edge then has a child on one of its sides."""
        return self.up[dart] + self.up[-dart]

    def _one_color(self) -> None:
        """An edge is joined in one color at most. If it is, one side is the other's parent."""
        for edge, colors in self.problem.colors.items():
            self.model.add(sum(self.joined[edge, c] for c in sorted(colors)) == self._counted(edge))
            self.model.add_at_most_one(self.up[edge], self.up[-edge])

    def _one_chain(self) -> None:
        """A sub-cell is a chain: each dart has at most one neighbor after it and one before it."""
        after: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        before: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for one, other in self.problem.pairs():
            after[one] += self._link(one, other)
            before[other] += self._link(one, other)
        for links in (after, before):
            for dart, found in links.items():
                self.model.add(sum(found) <= self._counted(dart))

    def _equal_colors(self) -> None:
        """Neighbors in a sub-cell are joined in the same color."""
        for one, other in self.problem.pairs():
            for here, there in ((one, other), (other, one)):
                for color in sorted(self.problem.colors_of(here)):
                    same = self.joined.get((abs(there), color))
                    for link in self._link(one, other):
                        clause = [~link, ~self.joined[abs(here), color]]
                        self.model.add_bool_or(clause if same is None else [*clause, same])

    def _no_crossing(self) -> None:
        """Cutting paths do not cross, so neither do links.

        Take a dart and a later one. A link from before the first to the second passes over the
        first, so a link from the first to beyond the second crosses it. Two links of the first kind
        share their end, two of the second kind their start. So at most one of all these holds.
        """
        for cell in self.problem.cells:
            for place, dart in enumerate(cell):
                self.deadline.check()
                for there in range(place + 1, len(cell)):
                    over = [link for d in cell[:place] for link in self._link(d, cell[there])]
                    out = [link for d in cell[there + 1 :] for link in self._link(dart, d)]
                    if over and out:
                        self.model.add_at_most_one(over + out)

    def _homes(self) -> None:
        for cell in sorted(self.problem.homes):
            for dart in self.problem.cells[cell]:
                self.model.add(self.up[dart] == 0)

    def _first_petal(self) -> None:
        for one, other in self.problem.pairs():
            if self.problem.later_petal(one, other):
                for link in self._link(one, other):
                    self.model.add_implication(link, ~self.up[other])


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
