"""Vertices change from one segment to another near them, and every segment stays in one piece."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from functools import cached_property

import numpy as np

from cellcolor.arrays import Array, Index, numbered
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.union_find import UnionFind

_RINGS = 19
"""Vertices within two mesh edges of one in a regular mesh, itself among them."""


class Nearby:
    """The vertices within two mesh edges of each vertex of a surface.

    Attributes:
        surface: the labelled surface.
        edges: (k, 2) its mesh edges.
        areas: (n,) m² that each vertex owns.
    """

    def __init__(self, surface: LabelledSurface) -> None:
        self.surface = surface
        self.areas, self.edges = surface.vertex_areas, surface.mesh.edges
        count = len(surface.vertices)
        self._keys = _two_steps(self.edges, count)
        self._first = np.searchsorted(self._keys, np.arange(count + 1) * count)
        self._known: dict[int, list[tuple[int, float, float]]] = {}

    @cached_property
    def mean_edge(self) -> float:
        """Mean length of the mesh edges, m."""
        return float(self.surface.mesh.lengths.mean())

    @cached_property
    def around(self) -> list[list[int]]:
        """The neighbors of each vertex."""
        found: list[list[int]] = [[] for _ in self.areas]
        for a, b in self.edges.tolist():
            found[a].append(b)
            found[b].append(a)
        return found

    @cached_property
    def link(self) -> list[list[tuple[int, int]]]:
        """The mesh edges opposite to each vertex in its triangles."""
        found: list[list[tuple[int, int]]] = [[] for _ in self.areas]
        for (a, b), c in self.surface.left_of.items():
            found[c].append((a, b))
        return found

    def near(self, vertex: int) -> list[tuple[int, float, float]]:
        """The others within two mesh edges: vertex, distance in m, weight in m.

        The weights of all pairs of vertices that a curve separates add up to about its length.
        For vertices that are spread evenly, with the two rings a disc of radius R, the products of
        the areas of two vertices, divided by their distance, add up to R² for each meter of the
        curve. So each product is divided by R², the disc as large as ``_RINGS`` vertices.
        """
        if vertex not in self._known:
            count = len(self.areas)
            others: Index = self._keys[self._first[vertex] : self._first[vertex + 1]] % count
            place = self.surface.vertices[vertex]
            far = np.linalg.norm(self.surface.vertices[others] - place, axis=1)
            squared = _RINGS * (self.areas[others] + self.areas[vertex]) / 2 / np.pi
            product = self.areas[others] * self.areas[vertex]
            # Where triangles are flat to a line there is no area, and perhaps no distance.
            weight: Array = np.divide(product, far * squared, where=product * far > 0, out=0 * far)
            rows = zip(others.tolist(), far.tolist(), weight.tolist(), strict=True)
            self._known[vertex] = list(rows)
        return self._known[vertex]


def _two_steps(edges: Index, count: int) -> Index:
    """All pairs (a, b) within two mesh edges as ascending numbers a * count + b."""
    start, end = np.concatenate([edges, edges[:, ::-1]]).T
    order = np.argsort(start, kind="stable")
    start, end = start[order], end[order]
    degree = np.bincount(start, minlength=count)
    first = np.cumsum(degree) - degree
    # Behind each directed edge (a, b) all edges (b, c).
    before, place = numbered(degree[end])
    behind = end[first[end][before] + place]
    from_a = start[before]
    distinct = from_a != behind
    keys = np.concatenate([start * count + end, from_a[distinct] * count + behind[distinct]])
    keys.sort()
    return keys[np.diff(keys, prepend=-1) > 0]


_LEAST = 1e-6
"""What a move has to gain, as a share of the mean mesh edge."""


class Relabelling:
    """A painting whose vertices can change their segments.

    Attributes:
        segment: of each vertex, -1 where it has no color.
        color_of: the color of each segment.
    """

    def __init__(
        self, nearby: Nearby, segment_of: Index, color_of: Mapping[int, int], toll: Array
    ) -> None:
        """``toll`` (n, colors): what a vertex of a color costs, in m of border."""
        self._nearby = nearby
        self._surface = nearby.surface
        self._colors = [frozenset(colors) for colors in self._surface.vertex_colors]
        self._toll = toll.tolist()
        self._least = _LEAST * nearby.mean_edge
        self.segment: list[int] = segment_of.tolist()
        self.color_of = color_of

    def shorten(self, deadline: Deadline) -> None:
        """Move borders as long as tolls and lengths, added up, get smaller.

        Every move makes the sum smaller by a least amount, so this ends.
        """
        around = self._nearby.around
        queue = deque(filter(self._at_border, range(len(self.segment))))
        queued = set(queue)
        while queue:
            deadline.check()
            vertex = queue.popleft()
            queued.discard(vertex)
            if not self._improved(vertex):
                continue
            beside = {vertex, *around[vertex]}
            for other, _, _ in self._nearby.near(vertex):
                if other in queued or not (other in beside or self._at_border(other)):
                    continue
                queue.append(other)
                queued.add(other)

    def _at_border(self, vertex: int) -> bool:
        segment = self.segment
        own = segment[vertex]
        return own >= 0 and any(segment[w] not in (own, -1) for w in self._nearby.around[vertex])

    def _improved(self, vertex: int) -> bool:
        """Give a vertex to the neighboring segment that gains most by it, if any gains."""
        segment = self.segment
        own = segment[vertex]
        if own < 0:
            return False
        beside = {segment[w] for w in self._nearby.around[vertex]} - {own, -1}
        weight = dict.fromkeys([own, *beside], 0.0)
        for other, _, share in self._nearby.near(vertex):
            if segment[other] in weight:
                weight[segment[other]] += share
        # A color that does not reach the vertex is refused below.
        toll = {number: self._toll[vertex][self.color_of[number]] for number in weight}
        change = {new: weight[own] - weight[new] + toll[new] - toll[own] for new in beside}
        for new in sorted(beside, key=lambda number: (change[number], number)):
            if change[new] >= -self._least:
                return False
            if self.color_of[new] in self._colors[vertex] and self._keeps_segments(vertex, new):
                segment[vertex] = new
                return True
        return False

    def _keeps_segments(self, vertex: int, new: int) -> bool:
        """Whether no segment falls apart, closes in on itself, or touches one of its color."""
        own = self.segment[vertex]
        for other in self._nearby.around[vertex]:
            number = self.segment[other]
            if number in (own, new, -1):
                continue
            color = self.color_of[number]
            alike = color in (self.color_of[own], self.color_of[new])
            if alike and color not in self._surface.cracked(vertex, other):
                return False
        return self._pieces_beside(vertex, own) == 1 == self._pieces_beside(vertex, new)

    def _pieces_beside(self, vertex: int, number: int) -> int:
        """In how many pieces a segment meets a vertex, joined with each other around it."""
        color, segment, cracked = self.color_of[number], self.segment, self._surface.cracked
        linked: UnionFind[int] = UnionFind()
        for a, b in self._nearby.link[vertex]:
            if segment[a] == number == segment[b] and color not in cracked(a, b):
                linked.union(a, b)
        met = [
            other
            for other in self._nearby.around[vertex]
            if segment[other] == number and color not in cracked(vertex, other)
        ]
        return len({linked[other] for other in met})
