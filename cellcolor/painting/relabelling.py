"""Vertices change from one segment to another, and every segment stays in one piece."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.painting.nearby import Nearby
from cellcolor.union_find import UnionFind

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
            if self._give(vertex, new):
                return True
        return False

    def _give(self, vertex: int, new: int) -> bool:
        """Give a vertex to another segment if that is legal; says whether it was."""
        legal = self.color_of[new] in self._colors[vertex] and self._keeps_segments(vertex, new)
        if legal:
            self.segment[vertex] = new
        return legal

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
