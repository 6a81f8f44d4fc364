"""Pointers: every tree of sub-cells is hung up at a root, and every dart points the way to it.

A segment is a connected set of sub-cells. Choose a spanning tree of each: the joins of its edges
are **counted**, others are not. Then there are as many segments as trees. Each dart whose join is
counted has one pointer: **up**, across its edge to the parent of its sub-cell; **forward** or
**backward** along its sub-cell, to the next of its darts in cyclic order; or none, at the **root**
of the tree. Pointers without a cycle make a forest, and its roots are counted.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.encodings.problem import Pair, Problem
from cellcolor.solvers.encodings.solving import Encoding, EncodingSolver


class Pointers(Encoding):
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
        # Per two darts of a cell: they are neighbours in one sub-cell, and the first points at the
        # second (forward) or the second at the first (backward).
        pairs = list(problem.pairs())
        self.forward = {pair: model.new_bool_var("forward_{}_{}".format(*pair)) for pair in pairs}
        self.backward = {pair: model.new_bool_var("backward_{}_{}".format(*pair)) for pair in pairs}
        # Per dart: it is the root of its tree, and points nowhere.
        self.root = {dart: model.new_bool_var(f"root_{dart}") for dart in problem.darts}
        # Per cell: no join of it is counted, so it is a tree by itself.
        self.alone = [model.new_bool_var(f"alone_{cell}") for cell in range(len(problem.cells))]
        # Per dart: falls along every pointer, strictly across edges.
        most = len(problem.colors)
        self.rank = {dart: model.new_int_var(0, most, f"rank_{dart}") for dart in problem.darts}
        for group in (
            self._one_color,
            self._one_pointer,
            self._one_chain,
            self._equal_colors,
            self._no_crossing,
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
        """Both pointers of each pair."""
        yield from self.forward.items()
        yield from self.backward.items()

    def _link(self, one: int, other: int) -> list[cp_model.IntVar]:
        """The literals that make neighbours of two darts in list order."""
        pair = (one, other)
        return [self.forward[pair], self.backward[pair]] if pair in self.forward else []

    def _counted(self, dart: int) -> cp_model.LinearExpr:
        """1 if the dart's join is counted: its edge then has a child on one of its sides."""
        return self.up[dart] + self.up[-dart]

    def _one_color(self) -> None:
        """An edge is joined in one color at most. If it is, one side is the other's parent."""
        for edge, colors in self.problem.colors.items():
            self.model.add(sum(self.joined[edge, c] for c in sorted(colors)) == self._counted(edge))
            self.model.add_at_most_one(self.up[edge], self.up[-edge])

    def _one_pointer(self) -> None:
        """A dart has one pointer or is a root if its join is counted, and neither if not."""
        ways = {dart: [self.up[dart], self.root[dart]] for dart in self.problem.darts}
        for one, other in self.forward:
            ways[one].append(self.forward[one, other])
            ways[other].append(self.backward[one, other])
        for dart, found in ways.items():
            self.model.add(sum(found) == self._counted(dart))

    def _one_chain(self) -> None:
        """A sub-cell is a chain: each of its darts has one neighbour after it and one before it."""
        after: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        before: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for one, other in self.forward:
            after[one] += self._link(one, other)
            before[other] += self._link(one, other)
        for links in (after, before):
            for dart, found in links.items():
                self.model.add(sum(found) <= self._counted(dart))

    def _equal_colors(self) -> None:
        """Neighbours in a sub-cell are joined in one and the same color."""
        for one, other in self.forward:
            for here, there in ((one, other), (other, one)):
                for color in sorted(self.problem.colors_of(here)):
                    same = self.joined.get((abs(there), color))
                    for link in self._link(one, other):
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
                    over = [link for d in cell[:place] for link in self._link(d, cell[there])]
                    out = [link for d in cell[there + 1 :] for link in self._link(dart, d)]
                    if over and out:
                        self.model.add_at_most_one(over + out)

    def _roots(self) -> None:
        """A root is the first counted dart of an undivided cell, which every segment has.

        docs/encodings.md explains why it has one. In an undivided cell that is the root all other
        darts lead to children: none points up.
        """
        model = self.model
        for number, cell in enumerate(self.problem.cells):
            alone = self.alone[number]
            model.add_bool_or([alone, *(self.up[s] for dart in cell for s in (dart, -dart))])
            for dart in cell:
                model.add_implication(alone, ~self.up[dart])
                model.add_implication(alone, ~self.up[-dart])
            for place, dart in enumerate(cell):
                for other in cell:
                    model.add_implication(self.root[dart], ~self.up[other])
                for earlier in cell[:place]:
                    model.add_implication(self.root[dart], ~self.up[-earlier])

    def _no_circles(self) -> None:
        """Ranks fall along pointers, strictly across edges."""
        for dart, literal in self.up.items():
            self.model.add(self.rank[dart] > self.rank[-dart]).only_enforce_if(literal)
        for (one, other), forward in self.forward.items():
            self.model.add(self.rank[one] >= self.rank[other]).only_enforce_if(forward)
            backward = self.backward[one, other]
            self.model.add(self.rank[other] >= self.rank[one]).only_enforce_if(backward)

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
        for one, other in self.forward:
            if self.problem.later_petal(one, other):
                for link in self._link(one, other):
                    self.model.add_implication(link, ~self.up[other])


class PointersSolver(EncodingSolver):
    """The encoding with pointers."""

    encoding = Pointers
