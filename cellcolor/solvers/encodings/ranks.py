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
from collections.abc import Callable, Iterator

from ortools.sat.python import cp_model

from cellcolor.solvers.encodings.problem import Pair
from cellcolor.solvers.encodings.solving import EncodingSolver, Trees


class Ranks(Trees):
    """The model with a number for each sub-cell."""

    def _variables(self) -> None:
        problem, model = self.problem, self.model
        self.up = {dart: model.new_bool_var(f"up_{dart}") for dart in problem.darts}
        # Per two darts of a cell: the second comes next after the first in one sub-cell.
        self.link = {
            pair: model.new_bool_var("link_{}_{}".format(*pair)) for pair in problem.pairs()
        }
        # Per dart: it or a dart before it in its sub-cell leads up.
        self.met = {dart: model.new_bool_var(f"met_{dart}") for dart in problem.darts}
        # Per cell: root, its one sub-cell is the root of a tree; alone, no join of it is counted.
        cells = range(len(problem.cells))
        self.root = {cell: model.new_bool_var(f"root_{cell}") for cell in cells}
        self.alone = [model.new_bool_var(f"alone_{cell}") for cell in cells]
        # Per dart: the same in all of a sub-cell, greater than its parent's.
        most = len(problem.colors)
        self.rank = {dart: model.new_int_var(0, most, f"rank_{dart}") for dart in problem.darts}
        self.links_of: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for (one, _other), literal in self.link.items():
            self.links_of[problem.cell_of[one]].append(literal)

    def _groups(self) -> tuple[Callable[[], None], ...]:
        return (
            self._one_color,
            self._one_chain,
            self._equal_colors,
            self._no_crossing,
            self._one_parent,
            self._roots,
            self._no_circles,
        )

    def links(self) -> Iterator[tuple[Pair, cp_model.IntVar]]:
        """The links."""
        yield from self.link.items()

    def _link(self, one: int, other: int) -> list[cp_model.IntVar]:
        return [self.link[one, other]] if (one, other) in self.link else []

    def _one_parent(self) -> None:
        """At most one dart of a sub-cell leads up: after the first, no later one does."""
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
        """All darts of a sub-cell have one rank, which is higher than that of its parent."""
        for dart, literal in self.up.items():
            self.model.add(self.rank[dart] > self.rank[-dart]).only_enforce_if(literal)
        for (one, other), literal in self.link.items():
            self.model.add(self.rank[one] == self.rank[other]).only_enforce_if(literal)


class RanksSolver(EncodingSolver):
    """The encoding with ranks."""

    encoding = Ranks
