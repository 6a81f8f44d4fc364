"""All divisions of one cell that keep rules 2 to 4 of a scheme (docs/semantics.md, section 3).

The sub-cells of a cell with several loops may interleave; the complete model decides, on that cell
alone, whether they can be drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import combinations

from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import Cell, Edge
from cellcolor.data.instance import Instance
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.solvers.cpsat.complete_model import CompleteModel
from cellcolor.solvers.cpsat.dart_graph import DartGraph
from cellcolor.solvers.cpsat.painting import Block
from cellcolor.solvers.interruptible import make_cp_solver
from cellcolor.union_find import UnionFind

ZERO = -1
"""Stands in place of a color for a dart in state 0."""

Blocks = tuple[tuple[int, tuple[int, ...]], ...]
"""The sub-cells of a cell: the color of each, and its darts in state 1."""


def divisions(
    graph: DartGraph,
    cell: int,
    known: Sequence[int | None],
    can_be_drawn: Callable[[int, Sequence[Block]], bool],
    deadline: Deadline,
) -> Iterator[Blocks]:
    """Every division of a cell in which its darts have the states that are known.

    Args:
        graph: the dart graph, loops apart.
        known: of each of its darts the color in which its edge is joined, ``ZERO`` if it is in
            state 0, None if that is open.
        can_be_drawn: whether blocks of a cell with several loops do not cross.
    """
    darts = graph.lists[cell]
    options = [
        [ZERO, *sorted(graph.darts[dart].colors)] if color is None else [color]
        for dart, color in zip(darts, known, strict=True)
    ]
    place_of = {dart: place for place, dart in enumerate(darts)}
    twins = [place_of.get(graph.darts[dart].twin) for dart in darts]
    one_loop = len(graph.loops[cell]) < 2
    for blocks in _blocks(darts, options, twins, one_loop, deadline):
        if not blocks:
            yield from (((color, ()),) for color in sorted(graph.colors[cell]))
        elif one_loop or (
            _kept_between_loops(graph.loops[cell], blocks)
            and can_be_drawn(cell, [Block(color, set(own)) for color, own in blocks])
        ):
            yield blocks


def _blocks(
    darts: Sequence[int],
    options: Sequence[Sequence[int]],
    twins: Sequence[int | None],
    one_loop: bool,
    deadline: Deadline,
) -> Iterator[Blocks]:
    """Divisions of a cell, decided dart by dart; no blocks if all are in state 0.

    A dart in state 1 goes to a block of its color, or begins a new one. On one loop blocks do not
    cross, so those that can still get darts form a stack: a dart completes the blocks above its
    own. On several loops all partitions by color are listed that keep the sizes of rule 2.
    """
    states: list[int] = []
    colors: list[int] = []
    members: list[list[int]] = []

    def decide(able: tuple[int, ...], last: int) -> Iterator[Blocks]:
        """Decide the next dart, which ``able`` blocks can get.

        Args:
            last: the block of the last dart in state 1, -1 for none.
        """
        place = len(states)
        if place == len(darts):
            if len(members) < 2 or (
                min(map(len, members)) > 1
                and (not one_loop or last == 0 or colors[last] != colors[0])
            ):
                yield tuple((c, tuple(m)) for c, m in zip(colors, members, strict=True))
            return
        deadline.check()
        twin = twins[place]
        for color in options[place] if twin is None or twin > place else [states[twin]]:
            states.append(color)
            if color == ZERO:
                yield from decide(able, last)
            else:
                other = not one_loop or last < 0 or colors[last] != color
                for level in reversed(range(len(able))):
                    block = able[level]
                    if colors[block] == color and (block == last or other):
                        members[block].append(darts[place])
                        yield from decide(able[: level + 1] if one_loop else able, block)
                        members[block].pop()
                    if one_loop and len(members[block]) == 1:
                        break  # no block beside others is complete with a single dart
                if other:
                    colors.append(color)
                    members.append([darts[place]])
                    yield from decide((*able, len(colors) - 1), len(colors) - 1)
                    colors.pop()
                    members.pop()
            states.pop()

    return decide((), -1)


def _kept_between_loops(loops: Sequence[Sequence[int]], blocks: Blocks) -> bool:
    """Rule 4 on each loop and between loops, and no two blocks that cross on a loop."""
    block_of = {dart: number for number, (_, own) in enumerate(blocks) for dart in own}
    for loop in loops:
        held = [block_of[dart] for dart in loop if dart in block_of]
        for one, other in zip(held, held[1:] + held[:1], strict=True):
            if one != other and blocks[one][0] == blocks[other][0]:
                return False
        if any(a == c != b == d for a, b, c, d in combinations(held, 4)):
            return False
    # Sub-cells that no chain of loops and sub-cells connects differ in color.
    connected: UnionFind[int] = UnionFind()
    for loop in loops:
        connected.union(*(block_of[dart] for dart in loop if dart in block_of))
    return all(
        blocks[one][0] != blocks[other][0] or connected[one] == connected[other]
        for one, other in combinations(range(len(blocks)), 2)
    )


class Planarity:
    """Decides for cells of one graph, loops apart, and remembers what it has decided."""

    def __init__(self, graph: DartGraph, deadline: Deadline) -> None:
        self._graph, self._deadline = graph, deadline
        self._known: dict[tuple[tuple[int, ...], ...], bool] = {}

    def can_be_drawn(self, cell: int, blocks: Sequence[Block]) -> bool:
        """Whether sub-cells, which do not cross on any one loop, do not cross at all.

        Loops and sub-cells that form a forest can always be drawn.

        Raises:
            TooLarge: the model that is to decide would be too large.
        """
        block_of = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
        loops = tuple(
            met
            for loop in self._graph.loops[cell]
            if (met := tuple(block_of[dart] for dart in loop if dart in block_of))
        )
        if _forest(loops):
            return True
        if loops not in self._known:
            self._known[loops] = _drawn_alone(loops, len(blocks), self._deadline)
        return self._known[loops]


def _drawn_alone(loops: Sequence[Sequence[int]], count: int, deadline: Deadline) -> bool:
    """Color a cell alone, with a color for each sub-cell, and a cell of it across each dart.

    The sub-cells can be drawn if each color gets by with one segment.
    """
    colors = tuple(range(count))
    places = [block for loop in loops for block in loop]
    dart = iter(range(1, len(places) + 1))
    cell = Cell(0, colors, tuple(tuple(next(dart) for _ in loop) for loop in loops))
    leaves = [Cell(n, (block,), ((-n,),)) for n, block in enumerate(places, start=1)]
    edges = tuple(Edge(n, 0, n) for n in range(1, len(places) + 1))
    alone = Instance("sub-cells", tuple(map(str, colors)), (cell, *leaves), edges)
    built = CompleteModel(alone, deadline=deadline)
    built.model.add(built.segments <= count)
    status = make_cp_solver(deadline, 1, 0).solve(built.model)
    if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE, cp_model.INFEASIBLE):
        raise OutOfTime("there was no time to draw the sub-cells of a cell")
    return status != cp_model.INFEASIBLE


def _forest(loops: Sequence[Sequence[int]]) -> bool:
    """Whether loops and the sub-cells that have darts on them make no circle."""
    connected: UnionFind[tuple[str, int]] = UnionFind()
    for number, loop in enumerate(loops):
        for block in set(loop):
            if connected["loop", number] == connected["block", block]:
                return False
            connected.union(("loop", number), ("block", block))
    return True
