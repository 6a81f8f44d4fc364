"""How much room a tool has inside its segments: corridors, and what it would pass over twice.

The **clearance** of a vertex is its distance along the surface from the nearest point of another
segment; what no color reaches, and the rim of the surface, do not count. A footprint of radius r
stays inside its segment where its center has a clearance of r or more. A **corridor** is a place
where two parts of a segment are connected and have more clearance than the way between them; its
width is twice the best clearance on that way.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from heapq import heapify, heappop, heappush

import numpy as np

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.painting.border_report import Corridor
from cellcolor.painting.nearby import Nearby
from cellcolor.union_find import UnionFind

_FAR = 3
"""In tool radii: how far clearances are followed."""


def within(
    nearby: Nearby,
    starts: Iterable[tuple[float, int]],
    reach: float,
    deadline: Deadline = NEVER,
) -> dict[int, float]:
    """The vertices within ``reach`` of some along the surface, and how far they are, m (Dijkstra).

    ``starts`` are distances to begin with, and vertices.
    """
    queue = list(starts)
    heapify(queue)
    found: dict[int, float] = {}
    while queue:
        deadline.check()
        far, vertex = heappop(queue)
        if vertex in found:
            continue
        found[vertex] = far
        for other, length, _ in nearby.near(vertex):
            if other not in found and far + length <= reach:
                heappush(queue, (far + length, other))
    return found


class Room:
    """The room that segments leave to a tool.

    Attributes:
        radius: of the tool's footprint, m.
        clearance: (n,) of each vertex, m; as far as it was followed if it is larger, and of a
            vertex without color 0.
    """

    def __init__(
        self,
        nearby: Nearby,
        segment: list[int],
        joined: Callable[[int, int], bool],
        radius: float,
        deadline: Deadline = NEVER,
    ) -> None:
        """``joined``: whether a mesh edge leads on in the segment that both ends are in."""
        self._deadline = deadline
        self._nearby = nearby
        self._segment = segment
        self._joined = joined
        self.radius = radius
        self.clearance = self._clearances()

    def _clearances(self) -> Array:
        """By following the two nearest segments from every border."""
        segment, nearby = self._segment, self._nearby
        places = nearby.surface.vertices
        queue: list[tuple[float, int, int]] = []
        for a, b in self._deadline.watch(nearby.edges.tolist()):
            if segment[a] == segment[b]:
                continue
            half = float(np.linalg.norm(places[a] - places[b])) / 2
            for here, there in ((a, b), (b, a)):
                if segment[there] >= 0:
                    queue.append((half, here, segment[there]))
        heapify(queue)
        reach = _FAR * self.radius
        found: dict[int, dict[int, float]] = {}
        while queue:
            self._deadline.check()
            far, vertex, number = heappop(queue)
            known = found.setdefault(vertex, {})
            if number in known or len(known) == 2:
                continue
            known[number] = far
            for other, length, _ in nearby.near(vertex):
                # Inside the segment itself its own distance is no clearance.
                if far + length <= reach and segment[other] != number:
                    heappush(queue, (far + length, other, number))
        clearance = np.full(len(segment), reach)
        for vertex, known in found.items():
            clearance[vertex] = min(known.values())
        clearance[np.array(segment) < 0] = 0.0
        return clearance

    def corridors(self) -> list[Corridor]:
        """Those that are at most half as wide as both their ends, or too narrow for a tool that
        fits into both; narrowest first.

        They are saddles of the clearance, found as in a merge tree: vertices come in with falling
        clearance, and where one connects two parts that were apart, it is the narrowest place
        between them.
        """
        peak: dict[int, float] = {}  # the greatest clearance of each part, by its representative
        part: UnionFind[int] = UnionFind()
        clearance = self.clearance.tolist()
        tree: dict[int, list[int]] = {}
        found = []
        for vertex in np.argsort(-self.clearance, kind="stable").tolist():
            self._deadline.check()
            if self._segment[vertex] < 0:
                continue
            peak[vertex], tree[vertex] = clearance[vertex], []
            best = None
            for other in sorted(self._onward(vertex), key=lambda w: -clearance[w]):
                if other not in tree or part[vertex] == part[other]:
                    continue
                lower, upper = sorted((peak[part[vertex]], peak[part[other]]))
                if best is None:
                    best = other  # the side of the vertex itself from now on
                elif lower >= 2 * clearance[vertex] or clearance[vertex] < self.radius <= lower:
                    way = (vertex, *self._roomward(tree, best), *self._roomward(tree, other))
                    x, y, z = self._nearby.surface.vertices[vertex].tolist()
                    width = 2 * clearance[vertex]
                    found.append(Corridor(self._segment[vertex], width, (x, y, z), way))
                part.union(vertex, other)
                peak[part[vertex]] = upper
                tree[vertex].append(other)
                tree[other].append(vertex)
        return sorted(found, key=lambda corridor: corridor.width_m)

    def _onward(self, vertex: int) -> Iterator[int]:
        """The neighbors of a vertex that its segment joins to it."""
        for other in self._nearby.around[vertex]:
            if self._segment[other] == self._segment[vertex] and self._joined(vertex, other):
                yield other

    def _roomward(self, tree: dict[int, list[int]], first: int) -> list[int]:
        """The vertices on the way from one to where the tool has room, that one left out."""
        before = {first: first}
        queue = deque([first])
        while queue:
            self._deadline.check()
            vertex = queue.popleft()
            if self.clearance[vertex] >= self.radius:
                way = []
                while vertex != first:
                    vertex = before[vertex]
                    way.append(vertex)
                return way
            for other in tree[vertex]:
                if other not in before:
                    before[other] = vertex
                    queue.append(other)
        return []

    def repeated(self, narrow: Iterable[Corridor]) -> float:
        """The area in m² of other segments that a tool passes over where it cannot stay inside.

        Its center goes through narrow corridors. Then, as long as there are vertices that it has
        not reached, to a mesh edge, it is put on the one of these that has most clearance.
        """
        segment, clearance = self._segment, self.clearance.tolist()
        reach = self.radius + self._nearby.mean_edge
        left = {v for v, own in enumerate(segment) if own >= 0}
        inside: dict[int, list[tuple[float, int]]] = {}
        for vertex in left:
            if clearance[vertex] >= self.radius:
                inside.setdefault(segment[vertex], []).append((0.0, vertex))
        for own, starts in inside.items():
            reached = within(self._nearby, starts, reach, self._deadline)
            left.difference_update(v for v in reached if segment[v] == own)
        centers = {vertex for corridor in narrow for vertex in corridor.way}
        for vertex in sorted(left, key=lambda v: (-clearance[v], v)):
            if vertex in left:
                centers.add(vertex)
                reached = within(self._nearby, [(0.0, vertex)], reach, self._deadline)
                left.difference_update(v for v in reached if segment[v] == segment[vertex])
        passed: set[int] = set()
        for vertex in centers:
            reached = within(self._nearby, [(0.0, vertex)], self.radius, self._deadline)
            passed.update(v for v in reached if segment[v] not in (-1, segment[vertex]))
        return float(self._nearby.areas[sorted(passed)].sum())
