"""What the encodings have in common: what is given, how it is solved, how the answer is read.

Nothing here is a formulation. ``Problem`` is the instance as a model sees it: each cell with the
cyclic list of its live darts, dominated colors dropped. An ``Encoding`` is a model of it with two
things to read off a solution: the color of each joined edge, and the pairs of darts that are
linked, neighbours within one sub-cell. The division is made of these.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import version
from math import ceil
from typing import ClassVar

from ortools.sat.python import cp_model

from cellcolor.data.bound import Bound
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, number_segments
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.errors import InputError, TooLarge
from cellcolor.solvers.bounds.cover import Region, color_regions
from cellcolor.solvers.bounds.domination import drop_dominated, left_out
from cellcolor.solvers.interface import PORTFOLIO, Abilities, Answer, OnProgress, Options
from cellcolor.solvers.interruptible import make_cp_solver, solve_interruptibly
from cellcolor.union_find import UnionFind

__all__ = ["Encoding", "EncodingSolver", "Pair", "Problem", "division"]

Pair = tuple[int, int]
"""Two darts of one cell, the one that comes first in its list first."""

LARGEST_MODEL = 1e6
"""The most terms of a model that is built; OR-Tools takes some kilobytes for each."""


@dataclass(frozen=True)
class Problem:
    """The live graph. A dart is a signed edge, ``-dart`` the other side of the edge.

    Attributes:
        cells: of each cell the live darts in cyclic order, the cell on the left.
        colors: the joinable colors of each live edge, dominated ones left out.
        cell_colors: those of each cell, likewise.
        regions: the color regions: what a segment in one color can reach at most.
    """

    cells: tuple[tuple[int, ...], ...]
    colors: Mapping[int, frozenset[int]]
    cell_colors: tuple[frozenset[int], ...]
    regions: tuple[Region, ...]

    @classmethod
    def of(cls, instance: Instance, deadline: Deadline = NEVER) -> Problem:
        """The live graph of an instance.

        Raises:
            InputError: a cell has several loops with live darts.
            OutOfTime: the deadline came first.
        """
        for cell, loops in enumerate(instance.live_loops):
            if len(loops) > 1:
                where = f"cells[{cell}].loops"
                raise InputError(
                    None, where, f"the model knows one live loop, here are {len(loops)}"
                )
        allowed = drop_dominated(instance, left_out(instance, deadline))
        deadline.check()
        colors = {}
        for edge in instance.edges:
            joinable = instance.joinable(edge.id)
            if joinable and (left := allowed[edge.left] & allowed[edge.right] & set(joinable)):
                colors[edge.id] = left
        cells = tuple(
            tuple(dart for loop in loops for dart in loop if abs(dart) in colors)
            for loops in instance.live_loops
        )
        return cls(cells, colors, allowed, tuple(color_regions(instance, allowed)))

    @cached_property
    def darts(self) -> tuple[int, ...]:
        """All live darts, cell by cell."""
        return tuple(dart for cell in self.cells for dart in cell)

    @cached_property
    def cell_of(self) -> dict[int, int]:
        """The cell of each dart."""
        return {dart: number for number, cell in enumerate(self.cells) for dart in cell}

    def colors_of(self, dart: int) -> frozenset[int]:
        """The colors in which a dart's edge can be joined."""
        return self.colors[abs(dart)]

    def may_link(self, one: int, other: int) -> bool:
        """Whether two darts of a cell can be in one sub-cell, and both joins be counted.

        They need a common color. If they were the two sides of one edge, the join would lead from
        the sub-cell back to itself.
        """
        return one != -other and not self.colors_of(one).isdisjoint(self.colors_of(other))

    def pairs(self) -> Iterator[Pair]:
        """All pairs of darts that may be linked."""
        for cell in self.cells:
            for place, one in enumerate(cell):
                for other in cell[place + 1 :]:
                    if self.may_link(one, other):
                        yield one, other

    @cached_property
    def region_of(self) -> dict[tuple[int, int], int]:
        """The number of the region that a cell lies in with a color, by (color, cell)."""
        return {(c, cell): n for n, (c, cells) in enumerate(self.regions) for cell in cells}

    @cached_property
    def homes(self) -> frozenset[int]:
        """For each color region a cell that has no other color, if there is one; with many darts.

        Such a cell is never divided, so the segment that it belongs to may have its root there.
        """
        found = set()
        for color, cells in self.regions:
            only = [cell for cell in sorted(cells) if self.cell_colors[cell] == {color}]
            if only:
                found.add(max(only, key=lambda cell: len(self.cells[cell])))
        return frozenset(found)

    def later_petal(self, one: int, other: int) -> bool:
        """Whether two darts lead to petals, and the second need not be a root if they are linked.

        A petal is a cell with a single live dart. A home may have to be a root.
        """
        first, second = (self.cell_of[-dart] for dart in (one, other))
        petals = len(self.cells[first]) == len(self.cells[second]) == 1
        return petals and second not in self.homes

    @property
    def size(self) -> float:
        """About how many terms a model has; most are in the constraints against crossing."""
        place = {dart: number for cell in self.cells for number, dart in enumerate(cell)}
        return sum(4.0 * (place[other] - place[one]) + 8 for one, other in self.pairs())


class Encoding(ABC):
    """A model whose objective is the number of segments."""

    model: cp_model.CpModel
    joined: dict[tuple[int, int], cp_model.IntVar]
    """Per edge and color: the edge is joined in that color, and the join is counted."""

    @abstractmethod
    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        """Write the model.

        Raises:
            OutOfTime: the deadline came first.
        """

    @abstractmethod
    def links(self) -> Iterable[tuple[Pair, cp_model.IntVar]]:
        """Literals that say that two darts are in one sub-cell, enough to connect each of them."""


class EncodingSolver:
    """Fewest segments in the search space ``paper``, for cells with one live loop each."""

    abilities: ClassVar[Abilities] = Abilities()
    encoding: ClassVar[type[Encoding]]

    @property
    def version(self) -> str:
        """Of OR-Tools."""
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
            if problem.size > LARGEST_MODEL:
                size, most = f"{problem.size:.1g}", f"{LARGEST_MODEL:.1g}"
                raise TooLarge(f"a model of {size} terms is not built; {most} are the most")
            built = self.encoding(problem, options.deadline)
        except OutOfTime:
            return Answer(None, (), ())
        solver = make_cp_solver(options.deadline, options.workers or PORTFOLIO, options.seed)
        found = None if progress is None else lambda segments: progress(segments, 0)
        status, interrupt = solve_interruptibly(solver, built.model, found)
        if interrupt is not None and not isinstance(interrupt, OutOfTime):
            raise interrupt
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            return Answer(None, (), (Bound("model", 0, "strands"),))
        colors = {edge: c for (edge, c), on in built.joined.items() if solver.boolean_value(on)}
        links = [pair for pair, literal in built.links() if solver.boolean_value(literal)]
        # The bound is a number of segments, so it may be rounded up.
        bound = ceil(solver.best_objective_bound - 1e-6)
        return Answer(division(instance, colors, links), (), (Bound("model", bound, "strands"),))


def division(instance: Instance, colors: Mapping[int, int], links: Iterable[Pair]) -> Division:
    """The division that counted joins and links make.

    A model counts joins that make trees of sub-cells. In a division every edge is joined that has
    one joinable color on both sides (docs/semantics.md, section 3, rule 5). So each dart that is
    not counted is given to the sub-cell before it in cyclic order, and its edge is joined if the
    sub-cell across it then has the same, joinable color. That makes no segment more.

    Args:
        instance: the topological graph.
        colors: of each edge whose join is counted.
        links: pairs of darts that lie in one sub-cell.
    """
    together: UnionFind[int] = UnionFind()
    for one, other in links:
        together.union(one, other)
    holder: dict[int, tuple[int, int]] = {}  # per live dart the sub-cell's name and color
    for cell, loops in zip(instance.cells, instance.live_loops, strict=True):
        live = [dart for loop in loops for dart in loop]
        counted = [(together[dart], colors[abs(dart)]) for dart in live if abs(dart) in colors]
        own = counted[-1] if counted else (0, cell.colors[0])
        for dart in live:
            if abs(dart) in colors:
                own = together[dart], colors[abs(dart)]
            holder[dart] = own
    blocks: list[list[tuple[int, list[int]]]] = []
    for cell, loops in zip(instance.cells, instance.live_loops, strict=True):
        found: dict[tuple[int, int], list[int]] = {}
        for dart in (dart for loop in loops for dart in loop):
            color = holder[dart][1]
            if holder[-dart][1] == color and color in instance.joinable(dart):
                found.setdefault(holder[dart], []).append(dart)
        blocks.append([(own[1], darts) for own, darts in found.items()] or [(cell.colors[0], [])])
    return number_segments(blocks)
