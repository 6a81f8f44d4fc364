"""A model of the divisions in which no cutting path connects two loops of a cell.

In such a division the loops and sub-cells of a cell form a forest (docs/encodings/fewest-cuts.md).
So each loop can be divided on its own, like a cell with one loop. A **bridge**
says that a sub-cell on one loop and a sub-cell on another are the same sub-cell. Bridges need not
be drawn: as long as those of a cell make no cycle of its loops, they can always be drawn without
crossing. So the model needs no seams.

With ``groups`` the model is a relaxation of all divisions: it also has divisions that cannot be
drawn, and only its bound is of use.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, permutations

from ortools.sat.python import cp_model

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.cpsat.model.constraints import (
    DEFINING,
    REDUNDANT,
    Variables,
    first_petal,
    make_variables,
)
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph
from cellcolor.solvers.cpsat.model.full import fewest_subcells, read_painting
from cellcolor.solvers.cpsat.model.painting import Block, Painting
from cellcolor.union_find import UnionFind

GROUPS = tuple(group for group in (*DEFINING, *REDUNDANT) if group is not first_petal)
"""Constraint groups of the model. ``first_petal`` does not hold here: it takes a loop with a single
live dart for a whole cell, and such a loop may be bridged to others."""


@dataclass(frozen=True, slots=True)
class Apart:
    """An instance in which each live loop of some cells has become a cell of its own.

    Attributes:
        instance: that instance.
        origin: for each of its cells, the original cell.
    """

    instance: Instance
    origin: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ApartModel:
    """A model with its variables."""

    model: cp_model.CpModel
    variables: Variables


def loops_apart(instance: Instance, cells: Collection[int]) -> Apart:
    """Make each live loop of the given cells a cell of its own, without its dead darts."""
    found: list[Cell] = []
    origin: list[int] = []
    side: dict[int, int] = {}
    for cell in instance.cells:
        loops = [(loop,) for loop in instance.live_loops[cell.id]]
        for own in loops if cell.id in cells else [cell.loops]:
            side |= {dart: len(found) for loop in own for dart in loop}
            found.append(Cell(len(found), cell.colors, own))
            origin.append(cell.id)
    edges = tuple(
        replace(
            edge,
            left=side.get(edge.id, -1),
            right=side.get(-edge.id, -1),
            colors=instance.joinable(edge.id),
        )
        for edge in instance.edges
        if edge.id in side or -edge.id in side
    )
    return Apart(Instance(instance.name, instance.colors, tuple(found), edges), tuple(origin))


def build_apart(
    apart: Apart, graph: DartGraph, regions: Sequence[Region], segments: int, *, groups: bool
) -> ApartModel:
    """The model: among divisions with a number of segments, the fewest sub-cells.

    Args:
        apart: the instance with loops apart.
        regions: color regions of the original instance.
        segments: how many segments a division has to have; the fewest there are.
        groups: whether cutting paths may connect loops. Loops so connected form a group, which
            costs one cutting path for each loop beyond its first; within a group bridges may make
            cycles. Then the model has every division, and also some that cannot be drawn, whose
            sub-cells would cross between the loops of a group.
    """
    model = cp_model.CpModel()
    variables = make_variables(model, graph)
    parts: dict[int, list[int]] = defaultdict(list)
    for number, cell in enumerate(apart.origin):
        parts[cell].append(number)
    for loops in parts.values():
        for one, other in permutations(loops, 2):
            for dart in graph.lists[one]:
                for target in graph.lists[other]:
                    if graph.darts[dart].colors & graph.darts[target].colors:
                        variables.bridges[dart, target] = model.new_bool_var("")
    own = [(c, frozenset(n for cell in cells for n in parts[cell])) for c, cells in regions]
    for group in GROUPS:
        group(model, graph, variables, own)
    alone, connected = [], []
    for loops in parts.values():
        alone.append(_alone(model, variables, loops))
        _undivided_roots(model, graph, variables, loops)
        own_groups = _groups_of_loops(model, loops, groups)
        connected += own_groups.others
        _forest_of_loops(model, graph, variables, loops, own_groups)
    _no_circles_of_bridges(model, variables)
    fewest_subcells(model, graph, variables, alone, segments, connected)
    return ApartModel(model, variables)


def _alone(model: cp_model.CpModel, v: Variables, loops: Sequence[int]) -> cp_model.IntVar:
    """A literal: the original cell has no dart in state 1 on any loop, so it is a segment."""
    if len(loops) == 1:
        return v.alone[loops[0]]
    alone = model.new_bool_var("")
    model.add_bool_or([alone, *(~v.alone[loop] for loop in loops)])
    for loop in loops:
        model.add_implication(alone, v.alone[loop])
    return alone


def _undivided_roots(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, loops: Sequence[int]
) -> None:
    """A root is in an undivided cell, so no dart of that cell points across its edge.

    All other sub-cells on the cell's loops are then bridged, directly or not, to the root's.
    """
    if len(loops) == 1:
        return
    darts = [dart for loop in loops for dart in graph.lists[loop]]
    model.add_at_most_one(v.root[dart] for dart in darts)
    for dart in darts:
        for other in darts:
            model.add_implication(v.root[dart], ~v.up[other])


@dataclass(frozen=True, slots=True)
class _Groups:
    """Groups of a cell's loops that cutting paths connect.

    Attributes:
        same: for two loops in ascending order: they are in one group. Empty if all are apart.
        others: for each loop: it is not the first one of its group.
    """

    same: dict[tuple[int, int], cp_model.IntVar]
    others: list[cp_model.IntVar]


def _groups_of_loops(model: cp_model.CpModel, loops: Sequence[int], groups: bool) -> _Groups:
    """Every loop has a leader: the first loop of its group."""
    if not groups:
        return _Groups({}, [])
    leader = {
        (loop, first): model.new_bool_var("") for loop in loops for first in loops if first <= loop
    }
    for loop in loops:
        model.add_exactly_one(leader[loop, first] for first in loops if first <= loop)
    same = {}
    for one, other in combinations(sorted(loops), 2):
        same[one, other] = model.new_bool_var("")
        shared = []
        for first in (first for first in loops if first <= one):
            both = model.new_bool_var("")
            model.add_bool_and(leader[one, first], leader[other, first]).only_enforce_if(both)
            model.add_bool_or([both, ~leader[one, first], ~leader[other, first]])
            shared.append(both)
        model.add(sum(shared) == same[one, other])
        model.add_implication(leader[other, one], leader[one, one])
    others = [model.new_bool_var("") for _ in loops]
    for loop, literal in zip(loops, others, strict=True):
        model.add_exactly_one(leader[loop, loop], literal)
    return _Groups(same, others)


def _forest_of_loops(
    model: cp_model.CpModel,
    graph: DartGraph,
    v: Variables,
    loops: Sequence[int],
    groups: _Groups,
) -> None:
    """At most one bridge between two groups of loops, and no cycle of groups.

    A loop has a height, the same in all of its group. Two loops with a bridge between their groups
    are oriented towards the lower height, and at most one leaves each group. That makes a forest.
    """
    bridged: dict[tuple[int, int], list[cp_model.IntVar]] = defaultdict(list)
    for (dart, target), literal in v.bridges.items():
        one, other = sorted((graph.darts[dart].cell, graph.darts[target].cell))
        bridged[one, other].append(literal)
    out: dict[int, list[cp_model.IntVar]] = {loop: [] for loop in loops}
    height = {loop: model.new_int_var(0, len(loops) - 1, "") for loop in loops}
    for pair in combinations(sorted(loops), 2):
        pointing = []
        for low, high in permutations(pair):
            points = model.new_bool_var("")
            model.add(height[high] > height[low]).only_enforce_if(points)
            out[high].append(points)
            pointing.append(points)
        within = len(bridged[pair]) * groups.same[pair] if groups.same else 0
        model.add(sum(bridged[pair]) <= sum(pointing) + within)
        model.add_at_most_one(pointing)
    for pointing in out.values():
        model.add_at_most_one(pointing)
    for (one, other), same in groups.same.items():
        model.add(height[one] == height[other]).only_enforce_if(same)
        model.add(sum(out[one]) + sum(out[other]) <= 1).only_enforce_if(same)


def _no_circles_of_bridges(model: cp_model.CpModel, v: Variables) -> None:
    """Bridges point from higher to lower blocks, so that they make no circle."""
    height = {dart: model.new_int_var(0, len(v.up), "") for pair in v.bridges for dart in pair}
    for pair in v.forward:
        if pair[0] in height and pair[1] in height:
            for link in v.links(*pair):
                model.add(height[pair[0]] == height[pair[1]]).only_enforce_if(link)
    for (dart, target), literal in v.bridges.items():
        model.add(height[dart] > height[target]).only_enforce_if(literal)


def read_apart(apart: Apart, graph: DartGraph, v: Variables, solver: cp_model.CpSolver) -> Painting:
    """The painting of the original cells: blocks that bridges connect are united."""
    painting = read_painting(graph, v, solver)
    whole: UnionFind[int] = UnionFind()
    block_of = {d: b for blocks in painting for b in blocks for d in b.darts}
    for (dart, target), literal in v.bridges.items():
        if solver.boolean_value(literal):
            whole.union(id(block_of[dart]), id(block_of[target]))
    found: dict[int, dict[int, Block]] = defaultdict(dict)
    empty: dict[int, Block] = {}
    for number, blocks in enumerate(painting):
        for block in blocks:
            if not block.darts:
                empty[apart.origin[number]] = block
                continue
            same = found[apart.origin[number]].setdefault(
                whole[id(block)], Block(block.color, set())
            )
            same.darts |= block.darts
    cells = sorted(set(apart.origin))
    return [list(found[cell].values()) or [empty[cell]] for cell in cells]
