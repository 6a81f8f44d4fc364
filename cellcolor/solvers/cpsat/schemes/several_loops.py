"""The rules of a scheme for a cell with several loops (docs/semantics.md, section 3)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import combinations

from ortools.sat.python import cp_model

from cellcolor.deadline import Deadline
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.union_find import UnionFind

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


def unconnected_differ(graph: DartGraph, painting: Painting) -> bool:
    """Whether sub-cells that no chain of loops and sub-cells connects have different colors."""
    return all(
        len(loops) < 2 or _differ(loops, blocks)
        for loops, blocks in zip(graph.loops, painting, strict=True)
    )


def _differ(loops: Sequence[Sequence[int]], blocks: Sequence[Block]) -> bool:
    holder = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    connected: UnionFind[int] = UnionFind(range(len(blocks)))
    for loop in loops:
        connected.union(*(holder[dart] for dart in loop if dart in holder))
    return not any(
        blocks[one].color == blocks[other].color and connected[one] != connected[other]
        for one, other in combinations(range(len(blocks)), 2)
    )
