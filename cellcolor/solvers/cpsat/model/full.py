"""The CP-SAT model of the whole problem: size, construction, hint and result.

A painting is a division with a color for each sub-cell, and a **block** is a sub-cell of it. Before
the model is solved it gets a known painting as a hint. Afterwards the painting is read from it.
The callers solve it.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from ortools.sat.python import cp_model

from cellcolor.data.solution import Seam
from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.constraints import (
    DEFINING,
    REDUNDANT,
    Group,
    Variables,
    fixed_roots,
    make_variables,
)
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting

MANY_DARTS = 300
"""In a cell with more darts than this, terms are not counted one by one. Any two of its darts are
then taken to have a color in common, so that the number is too large rather than too small."""

LARGEST_MODEL = 1e6
"""The most terms of a model that is built. With 8 workers OR-Tools takes up to 2.2 kB for each."""

SECONDS_A_TERM = 4e-6
"""What building a model takes in Python: 1.3 to 2 microseconds a term, and twice that on a
processor that has other work. It cannot be interrupted, so it is not begun where there is no time
to end it."""


@dataclass(frozen=True, slots=True)
class Model:
    """A model with its variables.

    Attributes:
        model: the model.
        variables: its variables.
        fixed_roots: cells in which their segment has its root.
        segments: how many segments there are, which is minimized.
    """

    model: cp_model.CpModel
    variables: Variables
    fixed_roots: set[int]
    segments: cp_model.LinearExprT


def model_size(graph: DartGraph) -> float:
    """About how many terms the constraints of a model have, without building it.

    Nearly all of them are in ``no_crossing``. Two darts of a cell with a common color have a link
    of two literals, and each of these stands in two constraints for every dart between the two.
    The other constraints add a few terms for each two darts of a cell.
    """
    total = 0.0
    for cell in graph.lists:
        count = len(cell)
        total += 2 * count**2
        if count > MANY_DARTS:
            total += 2 / 3 * count**3
            continue
        colors = [graph.darts[dart].colors for dart in cell]
        for place, one in enumerate(colors):
            for far in range(place + 1, count):
                if not one.isdisjoint(colors[far]):
                    # First the terms of ``no_crossing``, then those of other constraints.
                    total += 4 * (far - place - 1) + 8 * len(one)
    return total


def seams_size(seams: Sequence[Seam]) -> float:
    """About how many terms a model has for its seams alone, before its graph is made.

    Each strand of a seam gives its cell two darts, and any two of them have a color in common. The
    widths of seams double from loop to loop, so they are cut off before a number overflows.
    """
    widths: dict[int, int] = {}
    for seam in seams:
        widths[seam.cell] = widths.get(seam.cell, 0) + seam.strands
    return sum(2 / 3 * (2 * min(width, 10**6)) ** 3 for width in widths.values())


def not_built(size: float) -> str:
    """The sentence that says that a model of so many terms was not built."""
    return f"A model of {size:.1g} terms was not built; {LARGEST_MODEL:.1g} are the most."


def full_model(
    graph: DartGraph,
    regions: Sequence[Region],
    groups: Sequence[Group] = DEFINING + REDUNDANT,
    deadline: Deadline = NEVER,
    model: cp_model.CpModel | None = None,
) -> Model:
    """The model that minimizes the number of segments.

    Args:
        regions: the color regions of the instance, for the set-cover constraint.
        groups: the functions that add its constraints.
        model: to add all this to; None for a new one.
    """
    model = cp_model.CpModel() if model is None else model
    variables = make_variables(model, graph)
    for group in groups:
        deadline.check()
        group(model, graph, variables, regions)
    segments = sum(variables.root) + sum(variables.alone)
    model.minimize(segments)
    return Model(model, variables, fixed_roots(graph, regions), segments)


def read_painting(graph: DartGraph, v: Variables, solver: cp_model.CpSolver) -> Painting:
    """The painting that a solved model has found.

    A cell without darts in state 1 is painted in its first color. Darts are in state 1 only where
    the model counts a join. Edges whose join would close a cycle of sub-cells are left unjoined.
    """
    color_of: dict[int, int] = {}
    for (edge, color), literal in v.joined.items():
        if solver.boolean_value(literal):
            color_of[edge] = color_of[graph.darts[edge].twin] = color
    painting: Painting = []
    for number, cell in enumerate(graph.lists):
        block_of: dict[int, Block] = {}
        for place, dart in enumerate(cell):
            if dart not in color_of:
                continue
            linked = (
                other
                for other in cell[:place]
                if any(solver.boolean_value(link) for link in v.links(other, dart))
            )
            before = next(linked, None)
            block_of[dart] = Block(color_of[dart], set()) if before is None else block_of[before]
            block_of[dart].darts.add(dart)
        blocks = [b for d, b in block_of.items() if d == min(b.darts)]
        painting.append(blocks or [Block(min(graph.colors[number]), set())])
    return painting


def add_hint(built: Model, graph: DartGraph, painting: Painting) -> None:
    """Hint a model with a whole painting: its joins, pointers, roots and ranks.

    The joins of the painting are thinned out to a forest, one tree for each segment. A root has to
    be in an undivided cell. If some segment has none, there is no hint, since a partial hint
    would mislead the search.
    """
    forest = _forest(graph, painting, built.fixed_roots)
    if forest is None:
        return
    model, v = built.model, built.variables
    ones: set[int] = set()

    def choose(literal: cp_model.IntVar) -> None:
        ones.add(literal.index)

    # The darts of the forest's joins: the block of each, and whether its parent lies across.
    counted: dict[int, tuple[Block, bool]] = {}
    for child, dart_up in forest.dart_up.items():
        if dart_up is None:
            continue
        own = forest.blocks[child]
        choose(v.up[dart_up])
        twin = graph.darts[dart_up].twin
        choose(v.joined[min(dart_up, twin), own.color])
        counted[dart_up] = (own, True)
        counted[twin] = (forest.blocks[forest.block_of[twin]], False)
    for number, cell in enumerate(graph.lists):
        if not any(dart in counted for dart in cell):
            choose(v.alone[number])
        for block in painting[number]:
            chain = [d for d in cell if d in counted and counted[d][0] is block]
            goal = next((place for place, d in enumerate(chain) if counted[d][1]), 0)
            if chain and not counted[chain[goal]][1]:
                choose(v.root[chain[0]])
            for place in range(1, len(chain)):
                pair = (chain[place - 1], chain[place])
                choose((v.forward if place <= goal else v.backward)[pair])
    for literals in (
        v.joined.values(),
        v.up,
        v.forward.values(),
        v.backward.values(),
        v.root,
        v.alone,
    ):
        for literal in literals:
            model.add_hint(literal, literal.index in ones)
    for dart, rank in enumerate(v.rank):
        depth = forest.depth[forest.block_of[dart]] if dart in counted else 0
        model.add_hint(rank, depth)


@dataclass(slots=True)
class _Forest:
    """Joins that connect the blocks of each segment as a tree. Blocks are given by their index.

    Attributes:
        blocks: all blocks of a painting.
        block_of: the block of each dart in state 1.
        dart_up: per block, in breadth-first order, its own dart across which its parent lies; None
            for a root.
        depth: per block, how many joins lead from it to its root.
    """

    blocks: list[Block]
    block_of: dict[int, int]
    dart_up: dict[int, int | None]
    depth: dict[int, int]


def _forest(graph: DartGraph, painting: Painting, fixed: set[int]) -> _Forest | None:
    """A forest with its roots in undivided cells, None if a segment has no such cell.

    Args:
        fixed: cells that have to have the roots of their segments.
    """
    blocks = [block for cell in painting for block in cell]
    block_of = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    forest = _Forest(blocks, block_of, {}, {})
    undivided = [len(cell) == 1 for cell in painting for _ in cell]
    at_fixed = [number in fixed for number, cell in enumerate(painting) for _ in cell]
    # A root is where it is fixed, else in a cell with several darts if there is one. For of several
    # cells with one dart around a sub-cell only the first may be a root (``first_petal``).
    order = sorted(
        (number for number in range(len(blocks)) if undivided[number]),
        key=lambda number: (
            not at_fixed[number],
            len(blocks[number].darts) == 1,
            min(blocks[number].darts, default=0),
        ),
    )
    for root in order:
        if root in forest.dart_up:
            continue
        forest.dart_up[root], forest.depth[root] = None, 0
        queue = deque([root])
        while queue:
            number = queue.popleft()
            for dart in sorted(blocks[number].darts):
                twin = graph.darts[dart].twin
                child = block_of[twin]
                if child not in forest.dart_up:
                    forest.dart_up[child] = twin
                    forest.depth[child] = forest.depth[number] + 1
                    queue.append(child)
    return forest if len(forest.dart_up) == len(blocks) else None
