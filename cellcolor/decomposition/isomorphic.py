"""Are two topological graphs the same, whatever their cells, edges and colors are called?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline

if TYPE_CHECKING:
    import networkx as nx

_Node = tuple[str, int] | tuple[str, int, int]


def isomorphic(one: Instance, other: Instance, deadline: Deadline = NEVER) -> bool:
    """Whether some naming makes the graphs equal: cells, loops with their darts in cyclic order,
    the darts across, and the joinable colors.

    A color goes to one of the same branch: where a branch has several, the numbers in their names
    mean nothing.

    Args:
        deadline: when to give up; asked between rounds, and not in the last step.
    """
    import networkx as nx  # slow to import

    graphs = _incidence(one), _incidence(other)
    kinds = _kinds(graphs, deadline)
    if Counter(kinds[0].values()) != Counter(kinds[1].values()):
        return False
    if not kinds[0]:
        return True
    for graph, kind in zip(graphs, kinds, strict=True):
        nx.set_node_attributes(graph, kind, "kind")
    return bool(nx.vf2pp_is_isomorphic(*graphs, node_label="kind"))


def without_short_edges(instance: Instance, shorter_m: float) -> Instance:
    """A graph with its edges below a length, in m, drawn together to points.

    Where two borders cross, a mesh parts the crossing into two corners with a short edge between,
    and two of the four cells touch there. Without that edge nothing tells which two. Loops that
    would vanish stay as they are; an edge without a length is not short.
    """
    short = {edge.id for edge in instance.edges if (edge.length or shorter_m) < shorter_m}
    loops = [[abs(dart) for dart in loop] for cell in instance.cells for loop in cell.loops]
    short.difference_update(*[own for own in loops if short.issuperset(own)])
    cells = tuple(
        replace(
            cell,
            loops=tuple(
                tuple(dart for dart in loop if abs(dart) not in short) for loop in cell.loops
            ),
        )
        for cell in instance.cells
    )
    edges = tuple(edge for edge in instance.edges if edge.id not in short)
    return replace(instance, cells=cells, edges=edges)


def _incidence(instance: Instance) -> nx.DiGraph[_Node]:
    """Colors, cells, loops, edges and darts as nodes; each knows what it is, without any name."""
    import networkx as nx

    graph: nx.DiGraph[_Node] = nx.DiGraph()
    for color, name in enumerate(instance.colors):
        graph.add_node(("color", color), kind=f"color {name.rstrip('0123456789').rstrip()}")
    for edge in instance.edges:
        graph.add_node(("edge", edge.id), kind="edge")
        for color in instance.joinable(edge.id):
            graph.add_edge(("edge", edge.id), ("color", color))
    for cell in instance.cells:
        graph.add_node(("cell", cell.id), kind="cell")
        for color in cell.colors:
            graph.add_edge(("cell", cell.id), ("color", color))
        for number, loop in enumerate(cell.loops):
            graph.add_node(("loop", cell.id, number), kind="loop")
            graph.add_edge(("loop", cell.id, number), ("cell", cell.id))
            for place, dart in enumerate(loop):
                outside = instance.across(dart) == OUTSIDE
                graph.add_node(("dart", dart), kind=f"dart {outside}")
                graph.add_edge(("dart", dart), ("loop", cell.id, number))
                graph.add_edge(("dart", dart), ("edge", abs(dart)))
                following = loop[place + 1 - len(loop)]
                if following != dart:
                    graph.add_edge(("dart", dart), ("dart", following))
    return graph


def _kinds(
    graphs: tuple[nx.DiGraph[_Node], nx.DiGraph[_Node]], deadline: Deadline
) -> list[dict[_Node, int]]:
    """What each node is, told by its neighbors and theirs, numbered alike in both graphs.

    Planar graphs have few nodes of a kind left then, so that the search has little to try.
    """
    kinds: list[dict[_Node, int]] = []
    told: list[Mapping[_Node, object]] = [
        {node: data["kind"] for node, data in graph.nodes(data=True)} for graph in graphs
    ]
    known = 0
    while True:
        deadline.check()
        numbers: dict[object, int] = {}
        kinds = [
            {node: numbers.setdefault(what, len(numbers)) for node, what in own.items()}
            for own in told
        ]
        if len(numbers) == known:
            return kinds
        known = len(numbers)
        told = [
            {
                node: (
                    own[node],
                    tuple(sorted(own[n] for n in graph.successors(node))),
                    tuple(sorted(own[n] for n in graph.predecessors(node))),
                )
                for node in graph
            }
            for graph, own in zip(graphs, kinds, strict=True)
        ]
