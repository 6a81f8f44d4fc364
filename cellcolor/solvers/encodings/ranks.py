"""Ranks: every tree of sub-cells has a root, and a number that grows from parent to child.

A segment is a connected set of sub-cells. Choose a spanning tree of each: the joins of its edges
are **counted**, others are not. A sub-cell is a chain of darts whose joins are counted; two
successive ones are **linked**. In a cell

    sub-cells = counted darts - links,

and every sub-cell but the root of its tree has one dart that leads **up** to its parent. So
sub-cells less darts that lead up are roots, and these are counted. Links have no direction here,
unlike in ``pointers``; a literal carried along its chain ensures that a sub-cell has one parent.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.encodings.problem import Pair, Problem
from cellcolor.solvers.encodings.solving import Encoding, EncodingSolver


class Ranks(Encoding):
    """The model; each constraint group is a method, in the order in which they are called."""

    def __init__(self, problem: Problem, deadline: Deadline) -> None:
        self.problem, self.deadline = problem, deadline
        self.model = model = cp_model.CpModel()
        # Per edge and color: the edge is joined in that color, and the join is counted.
        self.joined = {
            (edge, color): model.new_bool_var(f"joined_{edge}_{color}")
            for edge, colors in problem.colors.items()
            for color in sorted(colors)
        }
        # Per dart: the parent of its sub-cell lies across it.
        self.up = {dart: model.new_bool_var(f"up_{dart}") for dart in problem.darts}
        # Per two darts of a cell: the second comes next after the first in one sub-cell.
        self.link = {
            pair: model.new_bool_var("link_{}_{}".format(*pair)) for pair in problem.pairs()
        }
        # Per dart: it or a dart before it in its sub-cell leads up.
        self.met = {dart: model.new_bool_var(f"met_{dart}") for dart in problem.darts}
        # Per cell: its one sub-cell is the root of a tree; no join of it is counted.
        cells = range(len(problem.cells))
        self.root = {cell: model.new_bool_var(f"root_{cell}") for cell in cells}
        self.alone = [model.new_bool_var(f"alone_{cell}") for cell in cells]
        # Per dart: the same in all of a sub-cell, greater than its parent's.
        most = len(problem.colors)
        self.rank = {dart: model.new_int_var(0, most, f"rank_{dart}") for dart in problem.darts}
        self.links_of: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for (one, _other), literal in self.link.items():
            self.links_of[problem.cell_of[one]].append(literal)
        for group in (
            self._one_color,
            self._one_chain,
            self._equal_colors,
            self._no_crossing,
            self._one_parent,
            self._roots,
            self._no_circles,
            # Redundant: they are implied by there being few segments, and make proofs quick.
            self._cover,
            self._most_links,
            self._homes,
            self._first_petal,
        ):
            deadline.check()
            group()
        model.minimize(sum(self.root.values()) + sum(self.alone))

    def links(self) -> Iterator[tuple[Pair, cp_model.IntVar]]:
        """The links."""
        yield from self.link.items()

    def _counted(self, dart: int) -> cp_model.LinearExpr:
        """1 if the dart's join is counted: its edge then has a child on one of its sides."""
        return self.up[dart] + self.up[-dart]

    def _one_color(self) -> None:
        """An edge is joined in one color at most. If it is, one side is the other's parent."""
        for edge, colors in self.problem.colors.items():
            self.model.add(sum(self.joined[edge, c] for c in sorted(colors)) == self._counted(edge))
            self.model.add_at_most_one(self.up[edge], self.up[-edge])

    def _one_chain(self) -> None:
        """A sub-cell is a chain: each of its darts has one link to either side at most."""
        after: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        before: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for (one, other), literal in self.link.items():
            after[one].append(literal)
            before[other].append(literal)
        for links in (after, before):
            for dart, found in links.items():
                self.model.add(sum(found) <= self._counted(dart))

    def _equal_colors(self) -> None:
        """Linked darts are joined in one and the same color."""
        for (one, other), link in self.link.items():
            for here, there in ((one, other), (other, one)):
                for color in sorted(self.problem.colors_of(here)):
                    same = self.joined.get((abs(there), color))
                    clause = [~link, ~self.joined[abs(here), color]]
                    self.model.add_bool_or(clause if same is None else [*clause, same])

    def _no_crossing(self) -> None:
        """Cutting paths do not cross, so neither do links.

        Take a dart and a later one. A link that comes from before the first and ends at the second
        goes over the first; a link from the first to beyond the second would cross that. So at most
        one of all these is there: two of the first kind share their end, two of the second their
        start.
        """
        for cell in self.problem.cells:
            for place, dart in enumerate(cell):
                self.deadline.check()
                for there in range(place + 1, len(cell)):
                    before, beyond = cell[:place], cell[there + 1 :]
                    over = [
                        self.link[d, cell[there]] for d in before if (d, cell[there]) in self.link
                    ]
                    out = [self.link[dart, d] for d in beyond if (dart, d) in self.link]
                    if over and out:
                        self.model.add_at_most_one(over + out)

    def _one_parent(self) -> None:
        """A sub-cell has one dart at most that leads up: once it is met, no further one does."""
        for dart, literal in self.up.items():
            self.model.add_implication(literal, self.met[dart])
        for (one, other), link in self.link.items():
            self.model.add_bool_or([~link, ~self.met[one], self.met[other]])
            self.model.add_bool_or([~link, ~self.met[one], ~self.up[other]])

    def _roots(self) -> None:
        """Sub-cells without a parent are roots, and a cell with a root is undivided.

        docs/encodings.md explains why every segment has such a root. With it no dart of the cell
        leads up, and the equation says that the root is the cell's only sub-cell.
        """
        for number, cell in enumerate(self.problem.cells):
            alone, root = self.alone[number], self.root[number]
            subcells = sum(self._counted(dart) for dart in cell) - sum(self.links_of[number])
            self.model.add(subcells - sum(self.up[dart] for dart in cell) == root)
            self.model.add_bool_or([alone, *(self.up[s] for dart in cell for s in (dart, -dart))])
            self.model.add_at_most_one(alone, root)
            for dart in cell:
                self.model.add_implication(root, ~self.up[dart])
                self.model.add_implication(alone, ~self.up[dart])
                self.model.add_implication(alone, ~self.up[-dart])

    def _no_circles(self) -> None:
        """One rank for all of a sub-cell, higher by one or more than that of its parent."""
        for dart, literal in self.up.items():
            self.model.add(self.rank[dart] > self.rank[-dart]).only_enforce_if(literal)
        for (one, other), literal in self.link.items():
            self.model.add(self.rank[one] == self.rank[other]).only_enforce_if(literal)

    def _homes(self) -> None:
        """A segment that reaches the home of its color region has its root there."""
        for cell in sorted(self.problem.homes):
            for dart in self.problem.cells[cell]:
                self.model.add(self.up[dart] == 0)

    def _first_petal(self) -> None:
        """Among the petals around a sub-cell, only the first can be the root, unless it is a home.

        A petal, a cell with a single live dart, is never divided: a tree with its root in one petal
        can have it in any other one as well.
        """
        for (one, other), link in self.link.items():
            if self.problem.later_petal(one, other):
                self.model.add_implication(link, ~self.up[other])


class RanksSolver(EncodingSolver):
    """The encoding with ranks."""

    encoding = Ranks
