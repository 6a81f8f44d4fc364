"""The full model: build it, hint it, solve it, read the painting off it."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from ortools.sat.python import cp_model

from cellcolor.data.solution import Seam
from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.constraints import DEFINING, REDUNDANT, Group, fixed_roots
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.solvers.cpsat.model.variables import Variables, make_variables

__all__ = [
    "LARGEST_MODEL",
    "Model",
    "add_hint",
    "fewest_subcells",
    "full_model",
    "model_size",
    "read_painting",
    "seams_size",
    "too_large",
]

MANY_DARTS = 300
"""Darts of a cell beyond which its terms are not counted one by one: then any two of its darts are
taken to have a color in common, which gives a number that is too large rather than too small."""

LARGEST_MODEL = 1e6
"""Terms of a model that is built: with 8 workers OR-Tools takes up to 2.2 kB for each."""


@dataclass(frozen=True, slots=True)
class Model:
    """A model with its variables.

    Attributes:
        model: the model.
        variables: its variables.
        fixed_roots: cells that are the root of their segment in it.
    """

    model: cp_model.CpModel
    variables: Variables
    fixed_roots: set[int]


def model_size(graph: DartGraph) -> float:
    """About how many terms the constraints of a model have, without building it.

    Nearly all are in ``no_crossing``: two literals for each three darts of a cell, as far as
    darts have a common color; then in ``roots``, with some for each two.
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
                    # Two literals, twice for each dart between the two.
                    total += 4 * (far - place - 1) + 8 * len(one)
    return total


def seams_size(seams: Sequence[Seam]) -> float:
    """About how many terms a model has for its seams alone, told before its graph is made.

    All darts of a cell's seams have all of its colors in common.
    """
    widths: dict[int, int] = {}
    for seam in seams:
        widths[seam.cell] = widths.get(seam.cell, 0) + seam.strands
    return sum(2 / 3 * (2 * min(width, 10**6)) ** 3 for width in widths.values())


def too_large(size: float) -> str:
    """The sentence that says that a model of so many terms was not built."""
    return f"A model of {size:.1g} terms was not built; {LARGEST_MODEL:.1g} are the most."


def full_model(
    graph: DartGraph,
    regions: Sequence[Region],
    groups: Sequence[Group] = DEFINING + REDUNDANT,
    deadline: Deadline = NEVER,
) -> Model:
    """The model of fewest segments.

    Args:
        graph: the dart graph.
        regions: the color regions of the instance, for the set-cover constraint.
        groups: the constraint groups.
        deadline: when to stop.

    Raises:
        OutOfTime: the deadline came first.
    """
    model = cp_model.CpModel()
    variables = make_variables(model, graph)
    for group in groups:
        deadline.check()
        group(model, graph, variables, regions)
    model.minimize(sum(variables.root) + sum(variables.alone))
    return Model(model, variables, fixed_roots(graph, regions))


def fewest_subcells(
    model: cp_model.CpModel,
    graph: DartGraph,
    v: Variables,
    alone: Sequence[cp_model.IntVar],
    segments: int,
    more: Sequence[cp_model.IntVar] = (),
) -> None:
    """Turn a model into one of fewest sub-cells, with so many segments.

    Sub-cells are the segments and the joins of their trees. What a seam parts is one sub-cell on
    the surface, so joins across seams do not count.

    Args:
        model: the model.
        graph: its dart graph.
        v: its variables.
        alone: per cell, whether it has no dart in state 1.
        segments: how many there have to be.
        more: what else counts like a sub-cell.
    """
    seams = {seam.id for seam in graph.seams}
    joins = [
        literal
        for (edge, _), literal in v.joined.items()
        if abs(graph.darts[edge].name[0]) not in seams
    ]
    model.add(sum(v.root) + sum(alone) == segments)
    model.add(sum(joins) >= len(alone) - segments)
    model.minimize(sum([*joins, *more]))


def read_painting(graph: DartGraph, v: Variables, solver: cp_model.CpSolver) -> Painting:
    """The sub-cells of a solved model; its counted joins only."""
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
    """Hint a whole painting: every variable that its forest of joins fixes.

    A segment in which every cell is divided has no root that the model allows; then nothing is
    hinted, since half a hint only misleads.
    """
    forest = _forest(graph, painting, built.fixed_roots)
    if forest is None:
        return
    model, v = built.model, built.variables
    ones: set[int] = set()

    def choose(literal: cp_model.IntVar) -> None:
        ones.add(literal.index)

    counted: dict[int, tuple[Block, bool]] = {}
    for child, parent in forest.parent.items():
        holder = forest.blocks[child]
        if parent is None:
            continue
        choose(v.up[parent])
        twin = graph.darts[parent].twin
        choose(v.joined[min(parent, twin), holder.color])
        counted[parent] = (holder, True)
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
    """A spanning forest of the sub-cells under joined edges.

    Attributes:
        blocks: all sub-cells.
        block_of: the sub-cell of each dart in state 1.
        parent: per sub-cell, in breadth-first order, the dart across which its parent lies.
        depth: per sub-cell, pointers across edges from it to its root.
    """

    blocks: list[Block]
    block_of: dict[int, int]
    parent: dict[int, int | None]
    depth: dict[int, int]


def _forest(graph: DartGraph, painting: Painting, fixed: set[int]) -> _Forest | None:
    blocks = [block for cell in painting for block in cell]
    block_of = {dart: number for number, block in enumerate(blocks) for dart in block.darts}
    forest = _Forest(blocks, block_of, {}, {})
    undivided = [len(cell) == 1 for cell in painting for _ in cell]
    at_fixed = [number in fixed for number, cell in enumerate(painting) for _ in cell]
    # Where the root is fixed, there; else at a cell with many darts: a cell with one dart may be a
    # root only if it is the first of its kind.
    order = sorted(
        (number for number in range(len(blocks)) if undivided[number]),
        key=lambda number: (
            not at_fixed[number],
            len(blocks[number].darts) == 1,
            min(blocks[number].darts, default=0),
        ),
    )
    for root in order:
        if root in forest.parent:
            continue
        forest.parent[root], forest.depth[root] = None, 0
        queue = deque([root])
        while queue:
            number = queue.popleft()
            for dart in sorted(blocks[number].darts):
                twin = graph.darts[dart].twin
                child = block_of[twin]
                if child not in forest.parent:
                    forest.parent[child] = twin
                    forest.depth[child] = forest.depth[number] + 1
                    queue.append(child)
    return forest if len(forest.parent) == len(blocks) else None
