"""The model of all optimal schemes: each of its solutions is a different scheme.

Everything in it is a function of the scheme, so that the search never meets one twice: the color
that a dart in state 0 has before and after it, and a certificate of the segments (breadth-first
distances from the segment's first dart). Rule 5 (docs/semantics.md, section 3), that no edge in
state 0 has to show one joinable color on both sides, is in the model only where a dart has no
choice what to show; conditions that depend on several runs of such darts are tested solution
by solution. So are those on blocks of several loops.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.errors import TooLarge
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.union_find import UnionFind

MOST_SCHEME_LITERALS = 20_000_000
"""Literals in the constraints that grow with the cube of a cell's darts. So many take some
gigabytes during the search; a larger model is not built."""


def check_size(graph: DartGraph, deadline: Deadline) -> None:
    """Reject a model that is too large, by the constraints over three darts of a cell.

    A link between two darts, d places apart in a cell of n, stands in about 2 d constraints that
    keep it from crossing others and in 2 n that want blocks of two darts; rule 4 looks at the
    darts between the two for each color that they share.
    """
    literals = sum(literals_on_loops(loops) for loops in graph.loops if len(loops) > 1)
    for cell in graph.lists:
        for place, one in enumerate(cell):
            deadline.check()
            for apart, other in enumerate(cell[place + 1 :], start=1):
                shared = len(graph.darts[one].colors & graph.darts[other].colors)
                literals += (2 + shared) * apart + 2 * len(cell) if shared else 0
            if literals > MOST_SCHEME_LITERALS:
                raise TooLarge(
                    f"The model of all schemes was not built: one cell has {len(cell)} darts."
                )


class SchemeModel:
    """Variables and constraints, by dart index."""

    def __init__(self, graph: DartGraph, segments: int, deadline: Deadline) -> None:
        self.graph = graph
        self._deadline = deadline
        self.model = model = cp_model.CpModel()
        darts = range(len(graph.darts))
        self.joined_in: dict[tuple[int, int], cp_model.IntVar] = {}
        self.joined: list[cp_model.IntVar] = [model.new_constant(0)] * len(graph.darts)
        for edge in graph.edges:
            twin = graph.darts[edge].twin
            self.joined[edge] = self.joined[twin] = model.new_bool_var("")
            literals = []
            for color in sorted(graph.darts[edge].colors):
                literal = model.new_bool_var("")
                self.joined_in[edge, color] = self.joined_in[twin, color] = literal
                literals.append(literal)
            model.add_exactly_one(~self.joined[edge], *literals)
        self.own = [
            {color: model.new_bool_var("") for color in sorted(colors)} for colors in graph.colors
        ]
        self.link: dict[tuple[int, int], cp_model.IntVar] = {}
        self._label = [model.new_int_var(0, dart, "") for dart in darts]
        self._distance = [model.new_int_var(0, len(graph.darts), "") for _ in darts]
        self._root = [model.new_bool_var("") for _ in darts]
        for number, loops in enumerate(graph.loops):
            cell = graph.lists[number]
            model.add_exactly_one(
                [*self.own[number].values(), self._any([self.joined[dart] for dart in cell])]
            )
            if len(loops) > 1:
                variables = self.joined, self.joined_in
                self.link |= same_blocks(model, graph, loops, variables, deadline)
            else:
                self._chains(number)
                self._successive(number)
        self._certain_zeros()
        self._certificate()
        # A cell without darts in state 1 is a segment of its own, in the one color it shows.
        alone = [literal for own in self.own for literal in own.values()]
        model.add(sum(self._root) + sum(alone) == segments)

    def painting(self, is_true: Callable[[cp_model.IntVar], bool]) -> Painting:
        """The painting that a solution describes, given which literals are true in it."""
        painting: Painting = []
        for number, cell in enumerate(self.graph.lists):
            block_of: dict[int, Block] = {}
            for place, dart in enumerate(cell):
                if not is_true(self.joined[dart]):
                    continue
                links = ((other, self.link.get((other, dart))) for other in cell[:place])
                before = next((o for o, link in links if link is not None and is_true(link)), None)
                if before is None:
                    colors = self.graph.darts[dart].colors
                    color = next(c for c in colors if is_true(self.joined_in[dart, c]))
                    block_of[dart] = Block(color, set())
                else:
                    block_of[dart] = block_of[before]
                block_of[dart].darts.add(dart)
            blocks = [block for dart, block in block_of.items() if dart == min(block.darts)]
            own = [color for color, literal in self.own[number].items() if is_true(literal)]
            painting.append(blocks or [Block(own[0], set())])
        return painting

    def _in(self, dart: int, color: int) -> list[cp_model.IntVar]:
        return [self.joined_in[dart, color]] if (dart, color) in self.joined_in else []

    def _chains(self, number: int) -> None:
        """Blocks are chains of links of one color that do not cross; rule 2 for their size."""
        model, cell = self.model, self.graph.lists[number]
        for place, one in enumerate(cell):
            self._deadline.check()
            for other in cell[place + 1 :]:
                shared = self.graph.darts[one].colors & self.graph.darts[other].colors
                if not shared:
                    continue
                link = self.link[one, other] = model.new_bool_var("")
                model.add_implication(link, self.joined[one])
                model.add_implication(link, self.joined[other])
                for dart, twin in ((one, other), (other, one)):
                    for color in sorted(self.graph.darts[dart].colors):
                        model.add_bool_or(
                            [~link, ~self.joined_in[dart, color], *self._in(twin, color)]
                        )
        for place, dart in enumerate(cell):
            self._deadline.check()
            before = [self.link[o, dart] for o in cell[:place] if (o, dart) in self.link]
            after = [self.link[dart, o] for o in cell[place + 1 :] if (dart, o) in self.link]
            model.add_at_most_one(before)
            model.add_at_most_one(after)
            for other in cell:
                if other != dart:
                    model.add_bool_or([~self.joined[dart], ~self.joined[other], *before, *after])
            for far in range(place + 1, len(cell)):
                over = [
                    self.link[o, cell[far]] for o in cell[:place] if (o, cell[far]) in self.link
                ]
                out = [self.link[dart, o] for o in cell[far + 1 :] if (dart, o) in self.link]
                model.add_at_most_one(over + out)

    def _successive(self, number: int) -> None:
        """Rule 4: successive darts in state 1 of one color are in one block."""
        model, cell = self.model, self.graph.lists[number]
        first, last = self._outermost(cell), self._outermost(cell[::-1])
        with_first = {dart: model.new_bool_var("") for dart in cell}
        for place, dart in enumerate(cell):
            self._deadline.check()
            model.add_implication(with_first[dart], self.joined[dart])
            model.add_implication(first[dart], with_first[dart])
            before = []
            for other in cell[:place]:
                if (other, dart) in self.link:
                    link = self.link[other, dart]
                    before.append(link)
                    model.add(with_first[other] == with_first[dart]).only_enforce_if(link)
            model.add_bool_or([~with_first[dart], first[dart], *before])
            for far in range(place + 1, len(cell)):
                other = cell[far]
                link_or_none = [self.link[dart, other]] if (dart, other) in self.link else []
                for color in self.graph.darts[dart].colors & self.graph.darts[other].colors:
                    both = [~self.joined_in[dart, color], ~self.joined_in[other, color]]
                    between = [self.joined[d] for d in cell[place + 1 : far]]
                    model.add_bool_or([*both, *between, *link_or_none])
                    model.add_bool_or([*both, ~first[dart], ~last[other], with_first[other]])

    def _outermost(self, cell: tuple[int, ...]) -> dict[int, cp_model.IntVar]:
        """Which dart is in state 1 with none in state 1 before it."""
        model = self.model
        found = {}
        for place, dart in enumerate(cell):
            literal = model.new_bool_var("")
            earlier = [self.joined[d] for d in cell[:place]]
            model.add_implication(literal, self.joined[dart])
            for other in earlier:
                model.add_implication(literal, ~other)
            model.add_bool_or([literal, ~self.joined[dart], *earlier])
            found[dart] = literal
        return found

    def _any(self, literals: list[cp_model.IntVar]) -> cp_model.IntVar:
        result = self.model.new_bool_var("")
        self.model.add_bool_or([~result, *literals])
        for literal in literals:
            self.model.add_implication(literal, result)
        return result

    def _certain_zeros(self) -> None:
        """Rule 5 where nothing is free: the same color before and after, on both sides."""
        before: dict[tuple[int, int], cp_model.IntVar] = {}
        after: dict[tuple[int, int], cp_model.IntVar] = {}
        for number, loops in enumerate(self.graph.loops):
            for loop in loops:
                self._seen(number, loop, before)
                self._seen(number, loop[::-1], after)
        for edge in self.graph.edges:
            twin = self.graph.darts[edge].twin
            for color in self.graph.darts[edge].colors:
                sides = [seen[d, color] for d in (edge, twin) for seen in (before, after)]
                self.model.add_bool_or([self.joined[edge], *(~literal for literal in sides)])

    def _seen(
        self, number: int, cell: tuple[int, ...], seen: dict[tuple[int, int], cp_model.IntVar]
    ) -> None:
        """The color of the nearest dart in state 1 behind each dart of a loop, or the cell's own.

        None where only other loops of the cell have darts in state 1.
        """
        model, own = self.model, self.own[number]
        for dart in cell:
            for color in own:
                seen[dart, color] = model.new_bool_var("")
        for place, dart in enumerate(cell):
            previous = cell[place - 1]
            for color, literal in own.items():
                here, there = seen[dart, color], seen[previous, color]
                model.add_implication(literal, here)
                model.add(here == there).only_enforce_if(~self.joined[previous])
                if joined := self._in(previous, color):
                    model.add(here == joined[0]).only_enforce_if(self.joined[previous])
                else:
                    model.add_implication(self.joined[previous], ~here)
            model.add_at_most_one(seen[dart, color] for color in own)
        joined_here = [self.joined[dart] for dart in cell]
        for dart in cell:
            for color, literal in own.items():
                model.add_bool_or([~seen[dart, color], literal, *joined_here])

    def _certificate(self) -> None:
        """Each segment has one root, its first dart, and distances from there."""
        model = self.model
        supports: list[list[cp_model.IntVar]] = [[root] for root in self._root]
        adjacent = dict(self.link)
        adjacent |= {(e, self.graph.darts[e].twin): self.joined[e] for e in self.graph.edges}
        for (one, other), literal in adjacent.items():
            model.add(self._label[one] == self._label[other]).only_enforce_if(literal)
            step = self._distance[one] - self._distance[other]
            model.add_linear_constraint(step, -1, 1).only_enforce_if(literal)
            for dart, sign in ((one, 1), (other, -1)):
                nearer = model.new_bool_var("")
                model.add_implication(nearer, literal)
                model.add(sign * step == 1).only_enforce_if(nearer)
                model.add(sign * step <= 0).only_enforce_if(literal, ~nearer)
                supports[dart].append(nearer)
        for dart, found in enumerate(supports):
            root, joined = self._root[dart], self.joined[dart]
            model.add_implication(root, joined)
            model.add(self._label[dart] == dart).only_enforce_if(root)
            model.add(self._distance[dart] == 0).only_enforce_if(root)
            if dart:
                model.add(self._label[dart] <= dart - 1).only_enforce_if(~root)
            model.add(self._label[dart] == 0).only_enforce_if(~joined)
            model.add(self._distance[dart] == 0).only_enforce_if(~joined)
            model.add_bool_or([~joined, *found])


Together = dict[tuple[int, int], cp_model.IntVar]
"""Per two darts of a cell, the lower first: they are in one block."""

SchemeVariables = tuple[list[cp_model.IntVar], dict[tuple[int, int], cp_model.IntVar]]
"""Which darts are in state 1, and per dart and color whether it is so in that color."""


def same_blocks(
    model: cp_model.CpModel,
    graph: DartGraph,
    loops: Sequence[Sequence[int]],
    variables: SchemeVariables,
    deadline: Deadline,
) -> Together:
    """Blocks of one color on several loops, with rules 2 and 4 as far as one loop tells.

    The constraints prevent crossings only loop by loop. Whether blocks cross between loops, and
    whether blocks of one color are connected, is tested on each solution.
    """
    joined, joined_in = variables
    cell = [dart for loop in loops for dart in loop]
    together: Together = {}
    for one, other in combinations(cell, 2):
        shared = graph.darts[one].colors & graph.darts[other].colors
        if not shared:
            continue
        literal = together[one, other] = model.new_bool_var("")
        model.add_implication(literal, joined[one])
        model.add_implication(literal, joined[other])
        for dart, neighbor in ((one, other), (other, one)):
            for color in sorted(graph.darts[dart].colors):
                allowed = [joined_in[neighbor, color]] if color in shared else []
                model.add_bool_or([~literal, ~joined_in[dart, color], *allowed])

    def of(one: int, other: int) -> list[cp_model.IntVar]:
        pair = min(one, other), max(one, other)
        return [together[pair]] if pair in together else []

    for one, other, third in combinations(cell, 3):
        deadline.check()
        for a, b, c in ((one, other, third), (other, third, one), (third, one, other)):
            if of(a, b) and of(b, c):
                model.add_bool_or([~of(a, b)[0], ~of(b, c)[0], *of(a, c)])
    for dart in cell:
        beside = [literal for other in cell if other != dart for literal in of(dart, other)]
        for other in cell:
            if other != dart:
                model.add_bool_or([~joined[dart], ~joined[other], *beside])
    for loop in loops:
        for a, b, c, d in combinations(loop, 4):
            if of(a, c) and of(b, d):
                model.add_bool_or([~of(a, c)[0], ~of(b, d)[0], *of(a, b)])
        for dart, other, between in _followers(loop):
            deadline.check()
            for color in sorted(graph.darts[dart].colors & graph.darts[other].colors):
                both = [~joined_in[dart, color], ~joined_in[other, color]]
                model.add_bool_or([*both, *(joined[d] for d in between), *of(dart, other)])
    return together


def _followers(loop: Sequence[int]) -> Iterator[tuple[int, int, Sequence[int]]]:
    """Every dart, every other one of its loop, and those that are met between the two."""
    for place, dart in enumerate(loop):
        following = [*loop[place + 1 :], *loop[:place]]
        for distance, other in enumerate(following):
            yield dart, other, following[:distance]


def literals_on_loops(loops: Sequence[Sequence[int]]) -> int:
    """About how many literals the constraints of ``same_blocks`` have."""
    count = sum(map(len, loops))
    fours = sum(len(loop) ** 4 // 8 for loop in loops)
    return 3 * count**3 // 2 + fours


def unconnected_differ(loops: Sequence[Sequence[int]], blocks: Sequence[Block]) -> bool:
    """Whether sub-cells that no chain of a cell's loops and sub-cells connects differ in color."""
    holder = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    connected: UnionFind[int] = UnionFind(range(len(blocks)))
    for loop in loops:
        connected.union(*(holder[dart] for dart in loop if dart in holder))
    return not any(
        blocks[one].color == blocks[other].color and connected[one] != connected[other]
        for one, other in combinations(range(len(blocks)), 2)
    )
