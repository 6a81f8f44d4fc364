"""Ranks: every tree of sub-cells has a root, and a number that grows from parent to child.

A segment is a connected set of sub-cells. Choose a spanning tree of each: the joins of its edges
are **counted**, others are not. A sub-cell is a chain of darts whose joins are counted; two
successive ones are **linked**. In a cell

    sub-cells = counted darts - links,

and every sub-cell but the root of its tree has one dart that leads **up** to its parent. So
sub-cells less darts that lead up are roots, and these are counted. A literal carried along its
chain ensures that a sub-cell has one parent.

Of what was tried this is the quickest: Choco's own `tree` over pointers needs the search without
learning, which proves far less.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from cellcolor.data.instance import Instance
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import Region, color_regions
from cellcolor.solvers.bounds.grouping import best_grouping
from cellcolor.solvers.joined_chains import only_loops

if TYPE_CHECKING:
    from pychoco.variables.boolvar import BoolVar
    from pychoco.variables.intvar import IntVar

Pair = tuple[int, int]
"""Two darts of one cell, in the order of its list."""

LARGEST_MODEL = 6e5
"""The most terms of a model that is built; the solver may take kilobytes for each."""

MANY_DARTS = 300
"""A cell with more darts makes a model too large; its pairs of darts are not even counted."""


@dataclass(frozen=True)
class Problem:
    """The live graph. A dart is a signed edge; ``-dart`` is the other side of the edge.

    Attributes:
        cells: the live darts of each cell in cyclic order.
        colors: the joinable colors of each live edge.
        cell_colors: the available colors of each cell.
        regions: the color regions; no segment reaches beyond one.
    """

    cells: tuple[tuple[int, ...], ...]
    colors: Mapping[int, frozenset[int]]
    cell_colors: tuple[frozenset[int], ...]
    regions: tuple[Region, ...]

    @classmethod
    def of(cls, instance: Instance) -> Problem:
        """The live graph of an instance.

        Raises:
            InputError: a cell has several loops with live darts.
            TooLarge: a model would not fit into memory.
        """
        loops = only_loops(instance)
        colors = {edge: frozenset(instance.joinable(edge)) for edge in instance.live_edges}
        own = tuple(frozenset(cell.colors) for cell in instance.cells)
        problem = cls(tuple(loops), colors, own, tuple(color_regions(instance)))
        if problem.size > LARGEST_MODEL:
            raise TooLarge(f"a model of more than {LARGEST_MODEL:.1g} terms is not built")
        return problem

    @cached_property
    def darts(self) -> tuple[int, ...]:
        """All live darts, cell by cell."""
        return tuple(dart for cell in self.cells for dart in cell)

    @cached_property
    def cell_of(self) -> dict[int, int]:
        """The cell of each dart."""
        return {dart: number for number, cell in enumerate(self.cells) for dart in cell}

    def colors_of(self, dart: int) -> frozenset[int]:
        """The joinable colors of a dart's edge."""
        return self.colors[abs(dart)]

    def pairs(self) -> Iterator[Pair]:
        """All pairs of darts that can be in one sub-cell, with both joins counted.

        They need a common color. They cannot be the two sides of one edge: that join would lead
        from the sub-cell back to itself, and such joins are not counted.
        """
        for cell in self.cells:
            for place, one in enumerate(cell):
                for other in cell[place + 1 :]:
                    common = not self.colors_of(one).isdisjoint(self.colors_of(other))
                    if common and one != -other:
                        yield one, other

    @cached_property
    def region_of(self) -> dict[tuple[int, int], int]:
        """The number of the region of each (color, cell)."""
        return {(c, cell): n for n, (c, cells) in enumerate(self.regions) for cell in cells}

    @cached_property
    def homes(self) -> frozenset[int]:
        """For each color region the cell with most darts among those of that color alone.

        A cell with one color is never divided, so its segment may have its root there.
        """
        found = set()
        for color, cells in self.regions:
            only = [cell for cell in sorted(cells) if self.cell_colors[cell] == {color}]
            if only:
                found.add(max(only, key=lambda cell: len(self.cells[cell])))
        return frozenset(found)

    def later_leaf(self, one: int, other: int) -> bool:
        """Whether both darts lead to leaf cells, and linked, the second leaf cell need not be the
        root.

        A leaf cell is a cell with a single live dart. A segment that can have its root in one of
        two leaf cells can have it in the other, so the first one suffices, unless the second is a
        home.
        """
        first, second = (self.cell_of[-dart] for dart in (one, other))
        leaves = len(self.cells[first]) == len(self.cells[second]) == 1
        return leaves and second not in self.homes

    @property
    def size(self) -> float:
        """About how many terms a model has; most are in the constraints that prevent crossing."""
        if any(len(cell) > MANY_DARTS for cell in self.cells):
            return math.inf  # far too many
        place = {dart: number for cell in self.cells for number, dart in enumerate(cell)}
        return sum(4.0 * (place[other] - place[one]) + 8 for one, other in self.pairs())


class Ranks:
    """The model; each constraint group is a method, in the order in which they are called.

    Attributes:
        variables: how many it has.
        constraints: how many, a clause counted as one.
    """

    def __init__(self, problem: Problem, fewest: int) -> None:
        """Write the model; ``fewest`` is a lower bound of the number of segments."""
        from pychoco.model import Model

        self.problem = problem
        self.variables = self.constraints = 0
        # Lazy clause generation: what the search learns from a failure is kept as a clause.
        self.model = model = Model("coloring", lcg=True)
        cells = range(len(problem.cells))
        # Per edge and color: the edge is joined in that color, and the join is counted.
        self.joined = {
            (edge, color): self._bool(f"joined_{edge}_{color}")
            for edge, colors in problem.colors.items()
            for color in sorted(colors)
        }
        # Per edge: its join is counted. Per dart: the parent of its sub-cell lies across it.
        self.counted = {edge: self._bool(f"counted_{edge}") for edge in problem.colors}
        self.up = {dart: self._bool(f"up_{dart}") for dart in problem.darts}
        # Per two darts of a cell: the second comes next after the first in one sub-cell.
        self.link = {(i, j): self._bool(f"link_{i}_{j}") for i, j in problem.pairs()}
        # Per dart: it or a dart before it in its sub-cell leads up.
        self.met = {dart: self._bool(f"met_{dart}") for dart in problem.darts}
        # Per cell: its one sub-cell is the root of a tree; no join of it is counted.
        self.root = [self._bool(f"root_{cell}") for cell in cells]
        self.alone = [self._bool(f"alone_{cell}") for cell in cells]
        # Per dart: the same in all of a sub-cell, greater than its parent's.
        most = len(problem.colors)
        self.rank = {dart: self._int(0, most, f"rank_{dart}") for dart in problem.darts}
        self.links_of: dict[int, list[BoolVar]] = defaultdict(list)
        for (one, _other), literal in self.link.items():
            self.links_of[problem.cell_of[one]].append(literal)
        self.linked: dict[int, IntVar] = {}
        self.segments = self._int(fewest, len(problem.cells), "segments")
        for group in (
            self._one_color,
            self._one_chain,
            self._linked,
            self._no_crossing,
            self._roots,
            self._no_circles,
            self._cover,
            self._most_links,
            self._homes,
            self._hubs,
        ):
            group()
        self._post(model.sum(self.root + self.alone, "=", self.segments))
        model.set_objective(self.segments, maximize=False)

    def solutions(self, seconds: float) -> Iterator[dict[str, Any]]:
        """Better and better solutions, and last whether the best is proved; within a time limit.

        Choco's own search for models with learning is left as it is.
        """
        solver = self.model.get_solver()
        # Every cell alone, a division that is always there, to begin with.
        for literal in (*self.counted.values(), *self.up.values(), *self.link.values(), *self.root):
            solver.add_hint(literal, 0)  # type: ignore[no-untyped-call]
        for literal in self.alone:
            solver.add_hint(literal, 1)  # type: ignore[no-untyped-call]
        if math.isfinite(seconds):
            solver.limit_time(f"{max(seconds, 0.001):.3f}s")
        while solver.solve():
            yield {
                "segments": self.segments.get_value(),
                "colors": [key for key, literal in self.joined.items() if literal.get_value()],
                "after": [pair for pair, literal in self.link.items() if literal.get_value()],
            }
        yield {"proved": solver.get_search_state() == "TERMINATED"}

    def _bool(self, name: str) -> Any:
        self.variables += 1
        return self.model.boolvar(name=name)

    def _int(self, least: int, most: int, name: str) -> Any:
        self.variables += 1
        return self.model.intvar(least, most, name)

    def _post(self, constraint: Any) -> None:
        self.constraints += 1
        constraint.post()

    def _clause(self, some: Iterable[BoolVar], all_of: Iterable[BoolVar] = ()) -> None:
        """Some of these are true if all of those are."""
        self.constraints += 1
        self.model.add_clauses(list(some), list(all_of))

    def _one_color(self) -> None:
        """An edge is joined in one color at most. If it is, one side is the other's parent."""
        for edge, colors in self.problem.colors.items():
            joined = [self.joined[edge, color] for color in sorted(colors)]
            self._post(self.model.sum(joined, "=", self.counted[edge]))
            self._post(self.model.sum([self.up[edge], self.up[-edge]], "=", self.counted[edge]))

    def _one_chain(self) -> None:
        """A sub-cell is a chain: each dart has at most one neighbor after it and one before it."""
        after: dict[int, list[BoolVar]] = defaultdict(list)
        before: dict[int, list[BoolVar]] = defaultdict(list)
        for (one, other), literal in self.link.items():
            after[one].append(literal)
            before[other].append(literal)
        for links in (after, before):
            for dart, found in links.items():
                self._post(self.model.sum(found, "<=", self.counted[abs(dart)]))

    def _linked(self) -> None:
        """Linked darts have one color, and one parent; of petals only the first may be a root."""
        for (one, other), link in self.link.items():
            for here, there in ((one, other), (other, one)):
                for color in sorted(self.problem.colors_of(here)):
                    same = self.joined.get((abs(there), color))
                    some = [] if same is None else [same]
                    self._clause(some, [link, self.joined[abs(here), color]])
            self._clause([self.met[other]], [link, self.met[one]])
            self._clause([], [link, self.met[one], self.up[other]])
            if self.problem.later_leaf(one, other):
                self._clause([], [link, self.up[other]])
        for dart, literal in self.up.items():
            self._clause([self.met[dart]], [literal])

    def _no_crossing(self) -> None:
        """Cutting paths do not cross, so neither do links.

        Take a dart and a later one. A link from before the first to the second passes over the
        first, so a link from the first to beyond the second crosses it. Two links of the first kind
        share their end, two of the second kind their start. So at most one of all these holds.
        """
        for cell in self.problem.cells:
            for place, dart in enumerate(cell):
                for there in range(place + 1, len(cell)):
                    ends = ((before, cell[there]) for before in cell[:place])
                    starts = ((dart, beyond) for beyond in cell[there + 1 :])
                    over = [self.link[pair] for pair in ends if pair in self.link]
                    out = [self.link[pair] for pair in starts if pair in self.link]
                    if over and out:
                        self._post(self.model.sum(over + out, "<=", 1))

    def _roots(self) -> None:
        """Sub-cells without a parent are roots, and a cell with a root is undivided.

        docs/formulation.md explains why every segment has such a root. With it no dart of the cell
        leads up, and the equation says that the root is the cell's only sub-cell.
        """
        for number, cell in enumerate(self.problem.cells):
            alone, root = self.alone[number], self.root[number]
            counted = [self.counted[abs(dart)] for dart in cell]
            ups = [self.up[dart] for dart in cell]
            taken = [*self.links_of.get(number, ()), *ups, root]
            signs = [1] * len(counted) + [-1] * len(taken)
            self._post(self.model.scalar([*counted, *taken], signs, "=", 0))
            self._clause([alone, *counted])
            self._clause([], [alone, root])
            for literal in counted:
                self._clause([], [alone, literal])
            for literal in ups:
                self._clause([], [root, literal])

    def _no_circles(self) -> None:
        """All darts of a sub-cell have one rank, which is higher than that of its parent."""
        for dart, literal in self.up.items():
            above = self.model.arithm(self.rank[dart], ">", self.rank[-dart])
            above.implied_by(literal)
        for (one, other), literal in self.link.items():
            self.model.arithm(self.rank[one], "=", self.rank[other]).implied_by(literal)

    def _cover(self) -> None:
        """Each color region in use holds a root, and each cell touches one in use or is alone."""
        problem = self.problem
        used = [self._bool(f"used_{n}") for n in range(len(problem.regions))]
        for (edge, color), literal in self.joined.items():
            self._clause([used[problem.region_of[color, problem.cell_of[edge]]]], [literal])
        for number, colors in enumerate(problem.cell_colors):
            touched = [used[problem.region_of[color, number]] for color in sorted(colors)]
            self._clause([self.alone[number], *touched])
        signs = [1] * len(self.root) + [-1] * len(used)
        self._post(self.model.scalar([*self.root, *used], signs, ">=", 0))

    def _most_links(self) -> None:
        """A number for the links of each cell, which has that bound in other sums as well."""
        for cell, links in self.links_of.items():
            colors = [self.problem.colors_of(dart) for dart in self.problem.cells[cell]]
            most = len(colors) - len(best_grouping(colors))
            self.linked[cell] = self._int(0, most, f"links_{cell}")
            self._post(self.model.sum(links, "=", self.linked[cell]))

    def _homes(self) -> None:
        """A segment that reaches the home of its color region has its root there."""
        for cell in sorted(self.problem.homes):
            for dart in self.problem.cells[cell]:
                self._clause([], [self.up[dart]])

    def _hubs(self) -> None:
        """The segments once more, in one sum whose bounds say something about hubs.

        A cell has alone + counted - links - 1 sub-cells beyond the first, 0 or more. Summed up over
        all cells, segments = cells + those further sub-cells - joins. Let no two of some cells, the
        hubs, be neighbors. Each join at a hub appears twice in the sum, once for the hub's darts
        and once as a join, and drops out: what is left of a hub is alone - links - 1. CP-SAT finds
        this in its linear relaxation; Choco looks at one constraint at a time.
        """
        problem = self.problem
        hubs: set[int] = set()
        for cell in sorted(range(len(problem.cells)), key=lambda cell: -len(problem.cells[cell])):
            around = {problem.cell_of[-dart] for dart in problem.cells[cell]}
            if around and hubs.isdisjoint(around) and cell not in around:
                hubs.add(cell)
        plus: list[IntVar] = []
        minus: list[IntVar] = [self.segments]
        for cell, darts in enumerate(problem.cells):
            if cell in hubs:
                plus.append(self.alone[cell])
                minus += [self.linked[cell]] if cell in self.linked else []
            elif darts:
                further = self._int(0, len(darts), f"further_{cell}")
                counted = [self.counted[abs(dart)] for dart in darts]
                taken = [*self.links_of.get(cell, ()), further]
                signs = [1] * (1 + len(counted)) + [-1] * len(taken)
                self._post(self.model.scalar([self.alone[cell], *counted, *taken], signs, "=", 1))
                plus.append(further)
        for edge, literal in self.counted.items():
            if hubs.isdisjoint((problem.cell_of[edge], problem.cell_of[-edge])):
                minus.append(literal)
        signs = [1] * len(plus) + [-1] * len(minus)
        self._post(self.model.scalar([*plus, *minus], signs, "=", len(hubs) - len(problem.cells)))
