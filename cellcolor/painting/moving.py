"""Moves the borders between segments of a painting (docs/motion.md, "Moving the borders").

The aims, most important first:

1. The segments stay the same: a vertex changes its segment only if no segment falls apart.
2. The arm is well conditioned: the caller gives the cost of each color at each vertex.
3. Borders are short.

Aims 2 and 3 are one sum: the length of the borders in m + the integral of the cost over the surface
in m² / the tool's radius in m. If the cost differs by 1 between the two sides of a border, the
border bends as sharply as the tool's rim. Single vertices change their segment as long as that
makes the sum smaller.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Index, numbered
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, RefusedResult
from cellcolor.painting.paint import Painted
from cellcolor.union_find import UnionFind

_RINGS = 19
"""Vertices within two mesh edges of one in a regular mesh, itself among them."""
_LEAST = 1e-6
"""What a move has to gain, as a share of the mean mesh edge."""


def move_borders(
    painted: Painted,
    tool_radius_m: float | None = None,
    cost: Array | None = None,
    deadline: Deadline = NEVER,
) -> Painted:
    """Move the borders between the segments of a painting; its surface stays.

    Args:
        tool_radius_m: radius of the footprint, m; None takes the mean length of a mesh edge.
        cost: (n, colors) cost of painting a vertex in a color, from 0 (best) to 1; None for 0.

    Returns:
        The painting with moved borders.

    Raises:
        InputError: the radius is not positive, or the cost has another shape or is not finite.
        RefusedResult: the checker counts another number of segments than before.
    """
    surface = painted.surface
    mean_edge = float(surface.mesh.lengths.mean())
    radius = (mean_edge or 1.0) if tool_radius_m is None else tool_radius_m
    if not (np.isfinite(radius) and radius > 0):
        raise InputError(None, "tool_radius_m", "must be a positive number of meters")
    shape = (len(surface.vertices), len(surface.colors))
    cost = np.zeros(shape) if cost is None else cost
    if cost.shape != shape or not np.isfinite(cost).all():
        raise InputError(None, "cost", f"needs a finite number for each of {shape}")
    labels = _Relabelling(painted, cost * (surface.vertex_areas / radius)[:, None])
    labels.shorten(deadline)
    plan = Plan(tuple([labels.color_of.get(segment) for segment in labels.segment]))
    counted = check_plan(surface, plan).segments
    if counted != painted.segments:
        raise RefusedResult(f"moved borders have {counted} segments, not {painted.segments}")
    segment_of = np.array(labels.segment, dtype=np.int64)
    return replace(painted, plan=plan, segment_of=segment_of)


class _Relabelling:
    """A painting whose vertices can change their segments.

    Attributes:
        segment: of each vertex, -1 where it has no color.
        color_of: the color of each segment.
    """

    def __init__(self, painted: Painted, toll: Array) -> None:
        """``toll`` (n, colors): what a vertex of a color costs, in m of border."""
        self._surface = surface = painted.surface
        self._colors = [frozenset(colors) for colors in surface.vertex_colors]
        self._toll = toll.tolist()
        self._areas, edges = surface.vertex_areas, surface.mesh.edges
        self._least = _LEAST * float(surface.mesh.lengths.mean())
        self.segment: list[int] = painted.segment_of.tolist()
        pairs = zip(self.segment, painted.plan.vertex_colors, strict=True)
        self.color_of = {segment: color for segment, color in pairs if color is not None}
        count = len(self.segment)
        self._around: list[list[int]] = [[] for _ in range(count)]
        for a, b in edges.tolist():
            self._around[a].append(b)
            self._around[b].append(a)
        # The mesh edges opposite to each vertex in its triangles.
        self._link: list[list[tuple[int, int]]] = [[] for _ in range(count)]
        for (a, b), c in surface.left_of.items():
            self._link[c].append((a, b))
        self._keys = _two_steps(edges, count)
        self._first = np.searchsorted(self._keys, np.arange(count + 1) * count)
        self._known: dict[int, list[tuple[int, float]]] = {}

    def shorten(self, deadline: Deadline) -> None:
        """Move borders as long as tolls and lengths, added up, get smaller.

        Every move makes the sum smaller by a least amount, so this ends.
        """
        queue = deque(filter(self._at_border, range(len(self.segment))))
        queued = set(queue)
        while queue:
            deadline.check()
            vertex = queue.popleft()
            queued.discard(vertex)
            if not self._improved(vertex):
                continue
            beside = {vertex, *self._around[vertex]}
            for other, _ in self._near(vertex):
                if other in queued or not (other in beside or self._at_border(other)):
                    continue
                queue.append(other)
                queued.add(other)

    def _at_border(self, vertex: int) -> bool:
        segment = self.segment
        own = segment[vertex]
        return own >= 0 and any(segment[w] not in (own, -1) for w in self._around[vertex])

    def _improved(self, vertex: int) -> bool:
        """Give a vertex to the neighboring segment that gains most by it, if any gains."""
        segment = self.segment
        own = segment[vertex]
        if own < 0:
            return False
        beside = {segment[w] for w in self._around[vertex]} - {own, -1}
        weight = dict.fromkeys([own, *beside], 0.0)
        for other, share in self._near(vertex):
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
        for other in self._around[vertex]:
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
        for a, b in self._link[vertex]:
            if segment[a] == number == segment[b] and color not in cracked(a, b):
                linked.union(a, b)
        met = [
            other
            for other in self._around[vertex]
            if segment[other] == number and color not in cracked(vertex, other)
        ]
        return len({linked[other] for other in met})

    def _near(self, vertex: int) -> list[tuple[int, float]]:
        """The others within two mesh edges: vertex, weight in m.

        The weights of all pairs of vertices that a curve separates add up to about its length.
        For vertices that are spread evenly, with the two rings a disc of radius R, the products of
        the areas of two vertices, divided by their distance, add up to R² for each meter of the
        curve. So each product is divided by R², the disc as large as ``_RINGS`` vertices.
        """
        if vertex not in self._known:
            count = len(self._areas)
            others: Index = self._keys[self._first[vertex] : self._first[vertex + 1]] % count
            place = self._surface.vertices[vertex]
            far = np.linalg.norm(self._surface.vertices[others] - place, axis=1)
            squared = _RINGS * (self._areas[others] + self._areas[vertex]) / 2 / np.pi
            product = self._areas[others] * self._areas[vertex]
            # Where triangles are flat to a line there is no area, and perhaps no distance.
            weight: Array = np.divide(product, far * squared, where=product * far > 0, out=0 * far)
            self._known[vertex] = list(zip(others.tolist(), weight.tolist(), strict=True))
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
