"""Pointers: every tree of sub-cells is hung up at a root, and every dart points the way to it.

A segment is a connected set of sub-cells. Choose a spanning tree of each: the joins of its edges
are **counted**, others are not. Then there are as many segments as trees. Each dart whose join is
counted has one pointer: **up**, across its edge to the parent of its sub-cell; **forward** or
**backward** along its sub-cell, to the next of its darts in cyclic order; or none, at the **root**
of the tree. Pointers without a cycle make a spanning forest, and its roots are counted. Ranks that
fall along them rule out cycles, as the order of cities does in Miller, Tucker and Zemlin's model.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ortools.sat.python import cp_model

from cellcolor.solvers.encodings.problem import Pair
from cellcolor.solvers.encodings.solving import EncodingSolver, Trees


class Pointers(Trees):
    """The model with a pointer for each dart."""

    def _variables(self) -> None:
        problem, model = self.problem, self.model
        self.up = {dart: model.new_bool_var(f"up_{dart}") for dart in problem.darts}
        # Per two darts of a cell: they are neighbours in one sub-cell, and the first points at the
        # second (forward) or the second at the first (backward).
        pairs = list(problem.pairs())
        self.forward = {pair: model.new_bool_var("forward_{}_{}".format(*pair)) for pair in pairs}
        self.backward = {pair: model.new_bool_var("backward_{}_{}".format(*pair)) for pair in pairs}
        # Per dart: it is the root of its tree, and points nowhere.
        self.root = {dart: model.new_bool_var(f"root_{dart}") for dart in problem.darts}
        self.alone = [model.new_bool_var(f"alone_{cell}") for cell in range(len(problem.cells))]
        # Per dart: falls along every pointer, strictly across edges (``_no_circles``).
        most = len(problem.colors)
        self.rank = {dart: model.new_int_var(0, most, f"rank_{dart}") for dart in problem.darts}

    def _groups(self) -> tuple[Callable[[], None], ...]:
        return (
            self._one_color,
            self._one_pointer,
            self._one_chain,
            self._equal_colors,
            self._no_crossing,
            self._roots,
            self._no_circles,
        )

    def links(self) -> Iterator[tuple[Pair, cp_model.IntVar]]:
        """Both pointers of each pair."""
        yield from self.forward.items()
        yield from self.backward.items()

    def _link(self, one: int, other: int) -> list[cp_model.IntVar]:
        pair = (one, other)
        return [self.forward[pair], self.backward[pair]] if pair in self.forward else []

    def _one_pointer(self) -> None:
        """A dart has one pointer or is a root if its join is counted, and neither if not."""
        ways = {dart: [self.up[dart], self.root[dart]] for dart in self.problem.darts}
        for one, other in self.forward:
            ways[one].append(self.forward[one, other])
            ways[other].append(self.backward[one, other])
        for dart, found in ways.items():
            self.model.add(sum(found) == self._counted(dart))

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


class PointersSolver(EncodingSolver):
    """The encoding with pointers."""

    encoding = Pointers
