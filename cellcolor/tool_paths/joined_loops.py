"""Loops joined into one closed path: in over a bridge, round, and back beside the bridge.

Which loops are joined is a shortest spanning tree; a **door** is where two of them are joined: a
piece of each is left out between two bridges. Where there is no room for two bridges the door has
one, walked there and back, and nothing is left out. So an even number of ways meet at every vertex,
and the path is an Eulerian circuit.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from itertools import pairwise

import networkx as nx
import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.triangles import Triangles, Ways, off_border, ways_from
from cellcolor.union_find import UnionFind

_MOST_CANDIDATES = 250  # bridges looked at for one door
_MOST_TRIED = 2000  # pairs of them

_Bridge = list[int]
"""The vertices of a way from one loop to another, both ends included."""


@dataclass(frozen=True)
class _Door:
    """Where two loops may be joined: their numbers, and bridges between them, the best first."""

    loops: tuple[int, int]
    bridges: list[_Bridge]

    @property
    def ends(self) -> tuple[int, int]:
        """Those of the best bridge."""
        return self.bridges[0][0], self.bridges[0][-1]


class _Loop:
    """A closed row of vertices, with the distance along it to each."""

    def __init__(self, mesh: Triangles, row: list[int]) -> None:
        self.row = row
        steps = np.linalg.norm(mesh.points[np.roll(row, -1)] - mesh.points[row], axis=1)
        self.along = np.concatenate([[0.0], np.cumsum(steps)])
        self.length = float(self.along[-1])
        self.place = {vertex: place for place, vertex in enumerate(self.row)}

    def apart(self, places: Index) -> Array:
        """How far places (p,) are from each other, the shorter way round, (p, p)."""
        along = self.along[places]
        forward = (along[None, :] - along[:, None]) % self.length
        return np.asarray(np.minimum(forward, self.length - forward))

    def piece(self, one: int, other: int) -> list[int]:
        """The vertices of the shorter way round from one vertex to another, in the loop's order."""
        a, b = self.place[one], self.place[other]
        if (self.along[b] - self.along[a]) % self.length > self.length / 2:
            a, b = b, a
        return self.row[a : b + 1] if a <= b else self.row[a:] + self.row[: b + 1]


def join_loops(mesh: Triangles, rows: list[list[int]], gap: float, deadline: Deadline) -> list[int]:
    """One closed path along all loops, as vertices; the first is the last as well.

    Args:
        mesh: on which the loops are rows of edges; connected.
        rows: the loops.
        gap: wanted distance between the two bridges of a door, m.
    """
    loops = [_Loop(mesh, row) for row in rows]
    loop_of = np.full(len(mesh.points), -1, dtype=np.int64)
    for number, row in enumerate(rows):
        loop_of[row] = number
    ways = ways_from(mesh.graph(off_border(mesh, gap / 2)), np.concatenate(rows))
    doors = _doors(mesh, ways, loop_of[ways.source])
    deadline.check()
    graph: nx.MultiGraph[int] = nx.MultiGraph()
    for loop in loops:
        nx.add_cycle(graph, loop.row)
    # Ends of bridges, and all that is left out: no door leaves out what another one needs.
    taken = Counter(end for door in doors for end in door.ends)
    for door in doors:
        taken.subtract(door.ends)
        one, other = _widened(door, [loops[number] for number in door.loops], gap, taken)
        for bridge in (one, other):
            nx.add_path(graph, bridge)
        for number, end in zip(door.loops, (0, -1), strict=True):
            piece = loops[number].piece(one[end], other[end])
            graph.remove_edges_from(pairwise(piece))
            taken.update(piece)
    start = next(vertex for vertex in loops[0].row if graph.degree[vertex])
    graph.remove_nodes_from(list(nx.isolates(graph)))
    return [start, *(vertex for _, vertex in nx.eulerian_circuit(graph, start))]


def _doors(mesh: Triangles, ways: Ways, loop_of: Index) -> list[_Door]:
    """A door for each branch of a shortest spanning tree of the loops.

    Args:
        ways: to each vertex from the nearest loop.
        loop_of: (n,) the number of that loop.
    """
    a, b = mesh.edges.T
    apart = loop_of[a] != loop_of[b]
    a, b, lengths = a[apart], b[apart], mesh.lengths[apart]
    costs = ways.lengths[a] + lengths + ways.lengths[b]
    swapped = loop_of[a] > loop_of[b]
    a, b = np.where(swapped, b, a), np.where(swapped, a, b)
    by_pair: dict[tuple[int, int], list[int]] = {}
    firsts, seconds = loop_of[a].tolist(), loop_of[b].tolist()
    for number in np.argsort(costs, kind="stable").tolist():
        by_pair.setdefault((firsts[number], seconds[number]), []).append(number)
    joined: UnionFind[int] = UnionFind()
    found = []
    for (first, second), numbers in by_pair.items():  # the pair with the shortest bridge first
        if joined[first] == joined[second]:
            continue
        joined.union(first, second)
        bridges = [
            [*ways.back_from(int(a[number]))[::-1], *ways.back_from(int(b[number]))]
            for number in numbers[:_MOST_CANDIDATES]
            if costs[number] <= 1.25 * costs[numbers[0]]
        ]
        found.append(_Door((first, second), bridges))
    return found


def _widened(
    door: _Door, loops: list[_Loop], gap: float, taken: Counter[int]
) -> tuple[_Bridge, _Bridge]:
    """Two bridges about a gap apart, between which nothing is taken; or twice the best one."""
    wanted = min(gap, loops[0].length / 4, loops[1].length / 4)
    off = np.zeros((len(door.bridges), len(door.bridges)))
    for loop, end in zip(loops, (0, -1), strict=True):
        places = np.array([loop.place[bridge[end]] for bridge in door.bridges])
        off = np.maximum(off, np.abs(loop.apart(places) - wanted))
    usable = np.argwhere(off < 0.5 * wanted)
    order = np.argsort(off[usable[:, 0], usable[:, 1]], kind="stable")
    for a, b in usable[order[:_MOST_TRIED]].tolist():
        one, other = door.bridges[a], door.bridges[b]
        pieces = [
            loop.piece(one[end], other[end]) for loop, end in zip(loops, (0, -1), strict=True)
        ]
        if not any(taken[vertex] for piece in pieces for vertex in piece):
            return one, other
    return door.bridges[0], door.bridges[0]
