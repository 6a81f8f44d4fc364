"""The model's variables and constraints, one function for each group of constraints.

Every dart in state 1 points at another dart: across its edge, along its sub-cell to the next dart
in state 1, or nowhere when it is the root of its segment. Pointers without a cycle
make a forest, and every tree of it is one segment.

``DEFINING`` groups are needed for a correct answer; ``REDUNDANT`` groups only speed up the proof.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ortools.sat.python import cp_model

from cellcolor.solvers.bounds.cover import Region
from cellcolor.solvers.bounds.hubs import best_grouping
from cellcolor.solvers.cpsat.model.dart_graph import DartGraph


@dataclass(frozen=True, slots=True)
class Variables:
    """Literals and ranks, by dart index (see ``DartGraph``).

    Attributes:
        joined: per edge (its lower dart) and color: the edge is joined in that color, and the
            join is counted. Joins that only close a cycle of sub-cells are never counted.
        up: per dart: its sub-cell's parent lies across it.
        forward: per two darts of a cell, in list order: they are neighbours within one sub-cell,
            and the first points at the second.
        backward: likewise, and the second points at the first.
        root: per dart: it is the root of its segment.
        alone: per cell: it has no dart in state 1, and is a segment of its own.
        rank: per dart: falls along every pointer, strictly across edges.
    """

    joined: dict[tuple[int, int], cp_model.IntVar]
    up: list[cp_model.IntVar]
    forward: dict[tuple[int, int], cp_model.IntVar]
    backward: dict[tuple[int, int], cp_model.IntVar]
    root: list[cp_model.IntVar]
    alone: list[cp_model.IntVar]
    rank: list[cp_model.IntVar]

    def links(self, one: int, other: int) -> tuple[cp_model.IntVar, ...]:
        """The literals that link two darts, none if they share no color."""
        pair = (one, other)
        return (self.forward[pair], self.backward[pair]) if pair in self.forward else ()


def make_variables(model: cp_model.CpModel, graph: DartGraph) -> Variables:
    """Add the variables of a dart graph to a model."""
    darts = range(len(graph.darts))
    edges = graph.edges
    joined = {
        (edge, color): model.new_bool_var(f"joined_{edge}_{color}")
        for edge in edges
        for color in sorted(graph.darts[edge].colors)
    }
    pairs = [
        (one, other)
        for cell in graph.lists
        for place, one in enumerate(cell)
        for other in cell[place + 1 :]
        if graph.darts[one].colors & graph.darts[other].colors
    ]
    return Variables(
        joined=joined,
        up=[model.new_bool_var(f"up_{dart}") for dart in darts],
        forward={pair: model.new_bool_var("forward_{}_{}".format(*pair)) for pair in pairs},
        backward={pair: model.new_bool_var("backward_{}_{}".format(*pair)) for pair in pairs},
        root=[model.new_bool_var(f"root_{dart}") for dart in darts],
        alone=[model.new_bool_var(f"alone_{cell}") for cell in range(len(graph.lists))],
        rank=[model.new_int_var(0, len(edges), f"rank_{dart}") for dart in darts],
    )


Group = Callable[[cp_model.CpModel, DartGraph, Variables, Sequence[Region]], None]


def one_color(model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]) -> None:
    """An edge is joined in one color at most, and the join counts for one of its sides."""
    for edge in graph.edges:
        twin = graph.darts[edge].twin
        colors = graph.darts[edge].colors
        model.add(sum(v.joined[edge, color] for color in colors) == v.up[edge] + v.up[twin])
        model.add_at_most_one(v.up[edge], v.up[twin])


def one_pointer(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]
) -> None:
    """A dart in state 1 points at one other dart or is a root; a dart in state 0 does neither."""
    pointers = [[up, root] for up, root in zip(v.up, v.root, strict=True)]
    for (one, other), literal in v.forward.items():
        pointers[one].append(literal)
        pointers[other].append(v.backward[one, other])
    for dart, found in enumerate(pointers):
        model.add(sum(found) == v.up[dart] + v.up[graph.darts[dart].twin])


def one_chain(model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]) -> None:
    """The darts of a sub-cell form one chain in list order."""
    later: dict[int, list[cp_model.IntVar]] = defaultdict(list)
    earlier: dict[int, list[cp_model.IntVar]] = defaultdict(list)
    for one, other in v.forward:
        later[one] += v.links(one, other)
        earlier[other] += v.links(one, other)
    for links in (later, earlier):
        for dart, found in links.items():
            model.add(sum(found) <= v.up[dart] + v.up[graph.darts[dart].twin])


def equal_colors(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]
) -> None:
    """Linked darts are joined in one and the same color."""
    for pair in v.forward:
        for one, other in (pair, pair[::-1]):
            own, its = (min(dart, graph.darts[dart].twin) for dart in (one, other))
            for color in sorted(graph.darts[one].colors):
                same = [v.joined[its, color]] if color in graph.darts[other].colors else []
                for literal in v.links(*pair):
                    model.add_bool_or([~literal, ~v.joined[own, color], *same])


def no_crossing(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]
) -> None:
    """Cutting paths do not cross, so neither do links."""
    for cell in graph.lists:
        for place, inner in enumerate(cell):
            for far in range(place + 1, len(cell)):
                over = [link for outer in cell[:place] for link in v.links(outer, cell[far])]
                out = [link for target in cell[far + 1 :] for link in v.links(inner, target)]
                if over and out:
                    model.add_at_most_one(over + out)


def roots(model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]) -> None:
    """A root is the first dart in state 1 of an undivided cell (docs/semantics.md, section 6)."""
    for number, cell in enumerate(graph.lists):
        ways = [(v.up[dart], v.up[graph.darts[dart].twin]) for dart in cell]
        model.add_bool_or([v.alone[number], *(literal for way in ways for literal in way)])
        for way in ways:
            for literal in way:
                model.add_implication(v.alone[number], ~literal)
        for place, dart in enumerate(cell):
            for own, _parent in ways:
                model.add_implication(v.root[dart], ~own)
            for _own, child in ways[:place]:
                model.add_implication(v.root[dart], ~child)


def no_circles(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]
) -> None:
    """Ranks fall along pointers."""
    for dart, literal in enumerate(v.up):
        model.add(v.rank[dart] > v.rank[graph.darts[dart].twin]).only_enforce_if(literal)
    for (one, other), literal in v.forward.items():
        model.add(v.rank[one] >= v.rank[other]).only_enforce_if(literal)
        model.add(v.rank[other] >= v.rank[one]).only_enforce_if(v.backward[one, other])


def cover(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, regions: Sequence[Region]
) -> None:
    """Each color region in use holds a root, and each cell touches one or is alone."""
    region_of = {(color, cell): n for n, (color, cells) in enumerate(regions) for cell in cells}
    used = [model.new_bool_var(f"used_{n}") for n in range(len(regions))]
    for (edge, color), literal in v.joined.items():
        model.add_implication(literal, used[region_of[color, graph.darts[edge].cell]])
    for number, colors in enumerate(graph.colors):
        model.add_bool_or(
            [v.alone[number], *(used[region_of[color, number]] for color in sorted(colors))]
        )
    model.add(sum(v.root) >= sum(used))


def most_links(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]
) -> None:
    """No cell has more links than can be drawn in it between darts of common colors."""
    for cell in graph.lists:
        found = [
            link
            for place, one in enumerate(cell)
            for other in cell[place + 1 :]
            for link in v.links(one, other)
        ]
        if found:
            most = best_grouping([graph.darts[dart].colors for dart in cell]).links
            model.add(sum(found) <= most)


def fixed_roots(graph: DartGraph, regions: Sequence[Region]) -> set[int]:
    """For each color region a cell that has no other color; one with many darts, if there are any.

    Such a cell is never divided, so the segment that it belongs to can have its root there.
    """
    found = set()
    for color, cells in regions:
        only = [cell for cell in sorted(cells) if graph.colors[cell] == {color}]
        if only:
            found.add(max(only, key=lambda cell: len(graph.lists[cell])))
    return found


def forced_roots(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, regions: Sequence[Region]
) -> None:
    """A segment with one of the fixed roots has its root there."""
    for cell in sorted(fixed_roots(graph, regions)):
        for dart in graph.lists[cell]:
            model.add(v.up[dart] == 0)


def first_petal(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, regions: Sequence[Region]
) -> None:
    """Among the petals around a sub-cell, only the first can be the root of the segment.

    A petal is a cell with a single live dart. It is never divided, so that a tree which has its
    root in one petal can have it in any other one as well, unless it is fixed (``fixed_roots``).
    """
    fixed = fixed_roots(graph, regions)
    petal = [graph.darts[dart.twin].cell for dart in graph.darts]
    single = [len(graph.lists[cell]) == 1 for cell in petal]
    for (one, other), link in v.forward.items():
        if single[one] and single[other] and petal[other] not in fixed:
            model.add_implication(link, ~v.up[other])


def strands_in_turn(
    model: cp_model.CpModel, graph: DartGraph, v: Variables, _: Sequence[Region]
) -> None:
    """The lower strands of an edge are joined first, successive ones in different colors.

    It does not matter which strands the corridors take. Why their colors differ is explained in
    docs/bounds/crossings.md.
    """
    seams = {seam.id for seam in graph.seams}
    for edge in graph.edges:
        signed, strand = graph.darts[edge].name
        higher = graph.number_of.get((signed, strand + 1))
        if higher is None or abs(signed) in seams:
            continue
        twin, higher_twin = graph.darts[edge].twin, graph.darts[higher].twin
        model.add(v.up[higher] + v.up[higher_twin] <= v.up[edge] + v.up[twin])
        for color in sorted(graph.darts[edge].colors):
            both = (v.joined[edge, color], v.joined[min(higher, higher_twin), color])
            model.add_at_most_one(both)


DEFINING: tuple[Group, ...] = (
    one_color,
    one_pointer,
    one_chain,
    equal_colors,
    no_crossing,
    roots,
    no_circles,
)
REDUNDANT: tuple[Group, ...] = (cover, most_links, forced_roots, first_petal, strands_in_turn)
