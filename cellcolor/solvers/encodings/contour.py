"""Contour circuit: the outline of a tree of sub-cells is one closed tour of its darts.

A segment is a connected set of sub-cells. Choose a spanning tree of each: the joins of its edges
are **counted**, others are not. Walk round the tree with its sub-cells on the left: arrived in a
sub-cell at dart i, walk along its border to its **next** dart j whose join is counted, across, and
so on. The tour comes by every counted dart once, and there is one tour for each tree. So no ranks
are needed: CP-SAT's circuit constraint sees to the tours, and counts them. Were the joins to have a
circle, its tour would fall into two, inside and outside, which only costs more.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence

from ortools.sat.python import cp_model

from cellcolor.solvers.encodings.problem import Pair
from cellcolor.solvers.encodings.solving import Encoding, EncodingSolver


class Contour(Encoding):
    """The model with a tour around each tree."""

    def _variables(self) -> None:
        problem, model = self.problem, self.model
        # Per edge: its join is not counted, the tours leave it out.
        self.idle = {edge: model.new_bool_var(f"idle_{edge}") for edge in problem.colors}
        # Per two darts of a cell, in either order: in one sub-cell the second is next after the
        # first. From the last dart of a sub-cell this closes its circle, to the first or to the
        # dart itself.
        self.next = {
            (i, j): model.new_bool_var(f"next_{i}_{j}")
            for one, other in problem.pairs()
            for i, j in ((one, other), (other, one))
        }
        for dart in problem.darts:
            self.next[dart, dart] = model.new_bool_var(f"next_{dart}_{dart}")
        # Per dart: a tour begins (ends) there, at the first (last) dart of a root.
        self.first = {dart: model.new_bool_var(f"first_{dart}") for dart in problem.darts}
        self.last = {dart: model.new_bool_var(f"last_{dart}") for dart in problem.darts}
        # Per cell: its one sub-cell is the root of a tree; no join of it is counted.
        cells = range(len(problem.cells))
        self.root = {cell: model.new_bool_var(f"root_{cell}") for cell in cells}
        self.alone = [model.new_bool_var(f"alone_{cell}") for cell in cells]

    def _groups(self) -> tuple[Callable[[], None], ...]:
        return (
            self._one_color,
            self._tours,
            self._roots,
            self._equal_colors,
            self._no_crossing,
        )

    def links(self) -> Iterator[tuple[Pair, cp_model.IntVar]]:
        """What leads on along a sub-cell; where its circle closes nothing new is connected."""
        place = self._places()
        return (((i, j), arc) for (i, j), arc in self.next.items() if place[i] < place[j])

    def _places(self) -> dict[int, int]:
        """The place of each dart in the list of its cell."""
        return {dart: place for cell in self.problem.cells for place, dart in enumerate(cell)}

    def _one_color(self) -> None:
        """An edge is joined in one color, or idle."""
        for edge, colors in self.problem.colors.items():
            joined = [self.joined[edge, color] for color in sorted(colors)]
            self.model.add_exactly_one([self.idle[edge], *joined])

    def _tours(self) -> None:
        """One walk for each tree, that comes by every counted dart.

        The nodes are the darts, node i standing for "just arrived at dart i, in its cell". If j is
        next, the walk crosses there and arrives at -j. A loop at a node leaves it out. The depot,
        node 0, is where all walks begin and end: each at its root, which has no arc from its last
        dart to its first. One more node has a tour of its own that is always there: CP-SAT's
        presolve calls a depot that no tour visits infeasible, and all joins may be idle.
        """
        node = {dart: number for number, dart in enumerate(self.problem.darts, start=1)}
        arcs = [(node[i], node[-j], arc) for (i, j), arc in self.next.items()]
        for dart, number in node.items():
            arcs.append((number, number, self.idle[abs(dart)]))
            arcs.append((0, node[-dart], self.first[dart]))
            arcs.append((number, 0, self.last[dart]))
        spare, always = len(node) + 1, self.model.new_constant(1)
        arcs += [(0, spare, always), (spare, 0, always)]
        self.model.add_multiple_circuit(arcs)

    def _roots(self) -> None:
        """A root is an undivided cell, which every segment has (docs/encodings.md).

        Every sub-cell closes its circle once, from its last dart to its first, but for a root. So
        nothing closes in the cell of a root: then there is no other sub-cell.
        """
        place = self._places()
        closing: dict[int, list[cp_model.IntVar]] = defaultdict(list)
        for (i, j), arc in self.next.items():
            if place[i] >= place[j]:
                closing[self.problem.cell_of[i]].append(arc)
        for number, cell in enumerate(self.problem.cells):
            root, alone = self.root[number], self.alone[number]
            for ends in (self.first, self.last):
                self.model.add(sum(ends[dart] for dart in cell) == root)
            for arc in closing[number]:
                self.model.add_implication(root, ~arc)
            # Alone: all darts are idle; else there is a sub-cell, hence a root or a closed circle.
            self.model.add_bool_or([alone, *(~self.idle[abs(dart)] for dart in cell)])
            self.model.add_bool_or([alone, root, *closing[number]])
            self.model.add_at_most_one(alone, root)
            for dart in cell:
                self.model.add_implication(alone, self.idle[abs(dart)])

    def _equal_colors(self) -> None:
        """Successive darts of a sub-cell are joined in one and the same color."""
        for (i, j), arc in self.next.items():
            if i == j:
                continue
            for here, there in ((i, j), (j, i)):
                for color in sorted(self.problem.colors_of(here)):
                    same = self.joined.get((abs(there), color))
                    clause = [~arc, ~self.joined[abs(here), color]]
                    self.model.add_bool_or(clause if same is None else [*clause, same])

    def _no_crossing(self) -> None:
        """Cutting paths do not cross, so neither do arcs; all walks turn the same way.

        Call an arc a step if it leads on in the list, else a return. Let a be a dart and b a later
        one. Of each of these sets at most one arc is there. Any two of a set share an end, or they
        cross, or a sub-cell would go on beyond the dart that closes it, or before the one where it
        closes:

        1. steps to b from before a; and steps from a to b or beyond;
        2. steps from a beyond b; and returns from b to a or before;
        3. steps to b from before a; and returns to a from b or beyond;
        4. returns from b to a or before; and returns to a from beyond b, also with a for b.
        """
        for cell in self.problem.cells:
            for here in range(len(cell)):
                self.deadline.check()
                self._at_most_one(
                    self._arcs([cell[here]], cell[: here + 1]),
                    self._arcs(cell[here + 1 :], [cell[here]]),
                )
                for there in range(here + 1, len(cell)):
                    one, other = cell[here], cell[there]
                    before, upto, beyond = cell[:here], cell[: here + 1], cell[there + 1 :]
                    for some, rest in (
                        (self._arcs(before, [other]), self._arcs([one], [other, *beyond])),
                        (self._arcs([one], beyond), self._arcs([other], upto)),
                        (self._arcs(before, [other]), self._arcs([other, *beyond], [one])),
                        (self._arcs([other], upto), self._arcs(beyond, [one])),
                    ):
                        self._at_most_one(some, rest)

    def _arcs(self, tails: Sequence[int], heads: Sequence[int]) -> list[cp_model.IntVar]:
        return [self.next[i, j] for i in tails for j in heads if (i, j) in self.next]

    def _at_most_one(self, some: list[cp_model.IntVar], rest: list[cp_model.IntVar]) -> None:
        if some and rest:
            self.model.add_at_most_one(some + rest)

    def _homes(self) -> None:
        for cell in sorted(self.problem.homes):
            self.model.add_exactly_one(self.root[cell], self.alone[cell])

    def _first_petal(self) -> None:
        for (i, j), arc in self.links():
            if self.problem.later_petal(i, j):
                self.model.add_implication(arc, ~self.root[self.problem.cell_of[-j]])


class ContourSolver(EncodingSolver):
    """The encoding with a contour circuit."""

    encoding = Contour
