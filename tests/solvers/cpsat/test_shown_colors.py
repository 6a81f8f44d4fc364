"""Rule 5 cell after cell, beside the checker, which looks at whole divisions."""

from __future__ import annotations

import random
from collections.abc import Mapping

import holes
import rooms
from hypothesis import assume, given
from hypothesis import strategies as st

from cellcolor.checker.scheme_rules import on_loops, unavoidable_join_on_loops
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER
from cellcolor.solvers.cpsat.cell_divisions import ZERO, Blocks, divisions
from cellcolor.solvers.cpsat.dart_graph import DartGraph, dart_graph
from cellcolor.solvers.cpsat.painting import Block, division_of
from cellcolor.solvers.cpsat.shown_colors import Choices, choices_with, shown_in_cell
from examples import examples

RED, BLUE = 0, 1


def loops_apart(instance: Instance) -> DartGraph:
    return dart_graph(instance, dict.fromkeys(instance.live_edges, 1), None)


def some_choice_is_left(graph: DartGraph, blocks_of: Mapping[int, Blocks]) -> bool:
    """Whether one is when the cells have been painted one after the other."""
    left = frozenset({Choices((), frozenset())})
    zeros: list[int] = []
    painted: set[int] = set()
    for cell, blocks in blocks_of.items():
        painted.add(cell)
        joined = {dart for own in blocks_of.values() for _, darts in own for dart in darts}
        open_darts = [
            number
            for number, dart in enumerate(graph.darts)
            if dart.cell in painted and graph.darts[dart.twin].cell not in painted
        ]
        before = [(dict(zip(zeros, shown, strict=True)), clauses) for shown, clauses in left]
        ways = shown_in_cell(graph.loops[cell], blocks)
        left = choices_with(graph, before, cell, ways, open_darts)
        zeros = [dart for dart in open_darts if dart not in joined]
    return bool(left)


@examples(100)
@given(seed=st.integers(0, 10**6), darts=st.integers(4, 7), loops=st.integers(1, 3))
def test_choices_cell_by_cell_as_for_all_cells_at_once(seed: int, darts: int, loops: int) -> None:
    """Cells are divided at random, in any order."""
    instance, rng = holes.holed(seed, darts, loops, colors=3), random.Random(seed)
    graph = loops_apart(instance)
    state: dict[int, int] = {}
    blocks_of: dict[int, Blocks] = {}
    for cell in rng.sample(range(len(graph.lists)), len(graph.lists)):
        for dart in graph.lists[cell]:
            color = rng.choice([ZERO, *sorted(graph.darts[dart].colors)])
            state[dart] = state.get(graph.darts[dart].twin, color)
        known = [state[dart] for dart in graph.lists[cell]]
        every = list(divisions(graph, cell, known, lambda *_: True, NEVER))
        assume(every)
        blocks_of[cell] = rng.choice(every)
    painting = [[Block(c, set(own)) for c, own in blocks_of[n]] for n in range(len(blocks_of))]
    cells = on_loops(instance, division_of(graph, painting), (), 1)
    stuck = unavoidable_join_on_loops(cells, lambda own: frozenset(instance.joinable(own[0])))
    assert some_choice_is_left(graph, blocks_of) == (stuck is None)


def test_zeros_on_different_loops_are_free_of_each_other() -> None:
    """Dart 3, the last of one loop, has to show red, and dart 4, the first of the other, blue."""
    colors = RED, BLUE, BLUE, RED, RED, BLUE
    graph = loops_apart(
        rooms.graph(((RED, BLUE), (1, 2, 3), (4, 5, 6)), *rooms.petal_cells(*colors))
    )
    number = {dart.name[0]: n for n, dart in enumerate(graph.darts)}
    blocks_of: dict[int, Blocks] = {
        0: ((RED, (number[1], number[5])), (BLUE, (number[2], number[6])))
    }
    for dart, color in enumerate(colors, start=1):
        blocks_of[dart] = ((color, () if dart in (3, 4) else (number[-dart],)),)
    assert some_choice_is_left(graph, blocks_of)
