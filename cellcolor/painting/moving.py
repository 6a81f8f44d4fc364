"""Moves the borders between segments of a painting (docs/motion.md, "Moving the borders").

The aims, most important first:

1. The segments stay the same: a vertex changes its segment only if no segment falls apart.
2. Corridors are as wide as the tool, if possible.
3. The arm is well conditioned: the caller gives the cost of each color at each vertex.
4. Borders are short.

Aims 3 and 4 are one sum: the length of the borders in m + the integral of the cost over the surface
in m² / the tool's radius in m. If the cost differs by 1 between the two sides of a border, the
border bends as sharply as the tool's rim.

The algorithm alternates two steps: single vertices change their segment as long as that makes the
sum smaller; then each corridor that is too narrow is widened, and its vertices are held in their
segment from then on. The best state on the way is kept.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, RefusedResult
from cellcolor.painting.border_report import BorderReport, Borders, Corridor
from cellcolor.painting.corridors import Room, within
from cellcolor.painting.nearby import Nearby
from cellcolor.painting.paint import Painted
from cellcolor.painting.relabelling import Relabelling

_ROUNDS = 12
"""The most times that borders are shortened and corridors widened."""


def move_borders(
    painted: Painted,
    tool_radius_m: float | None = None,
    cost: Array | None = None,
    deadline: Deadline = NEVER,
) -> Painted:
    """Move the borders between the segments of a painting; its surface stays.

    Args:
        tool_radius_m: radius of the footprint, m. None takes the mean length of a mesh edge: then
            a corridor of that width has a row of vertices inside.
        cost: (n, colors) cost of painting a vertex in a color, from 0 (best) to 1; None for 0.

    Returns:
        The painting with moved borders; its ``borders`` reports what has changed.

    Raises:
        InputError: the radius is not positive, or the cost has another shape or is not finite.
        RefusedResult: the checker counts another number of segments than before.
    """
    surface = painted.surface
    nearby = Nearby(surface)
    radius = (nearby.mean_edge or 1.0) if tool_radius_m is None else tool_radius_m
    if not (np.isfinite(radius) and radius > 0):
        raise InputError(None, "tool_radius_m", "must be a positive number of meters")
    shape = (len(surface.vertices), len(surface.colors))
    if cost is not None and (cost.shape != shape or not np.isfinite(cost).all()):
        raise InputError(None, "cost", f"needs a finite number for each of {shape}")
    colors = painted.plan.vertex_colors
    color_of = {
        segment: color
        for segment, color in zip(painted.segment_of.tolist(), colors, strict=True)
        if color is not None
    }
    toll = None if cost is None else cost * (nearby.areas / radius)[:, None]
    labels = Relabelling(nearby, painted.segment_of, color_of, toll)
    moving = _Moving(nearby, labels, cost, radius, deadline)
    first = moving.state()
    best = moving.improved(first)
    segment_of = np.array(best.segment, dtype=np.int64)
    plan = Plan(tuple([color_of.get(segment) for segment in best.segment]))
    counted = check_plan(surface, plan).segments
    if counted != painted.segments:
        raise RefusedResult(f"moved borders have {counted} segments, not {painted.segments}")
    moved = int((segment_of != painted.segment_of).sum())
    report = BorderReport(radius, moving.borders(first), moving.borders(best), moved)
    return replace(painted, plan=plan, segment_of=segment_of, borders=report)


@dataclass(frozen=True)
class _State:
    """One position of the borders, and its measures.

    Attributes:
        segment: of each vertex, -1 without color.
        room: the room that the segments leave to the tool.
        corridors: narrowest first.
        narrow: the corridors that are narrower than the tool.
        lacking: how much they are narrower, summed up, m.
        length: of all borders, m.
        cost: integral of the cost over the surface, m².
    """

    segment: list[int]
    room: Room
    corridors: list[Corridor]
    narrow: list[Corridor]
    lacking: float
    length: float
    cost: float


class _Moving:
    """The search for better borders: ``labels`` is changed in place, a state is a snapshot."""

    def __init__(
        self,
        nearby: Nearby,
        labels: Relabelling,
        cost: Array | None,
        radius: float,
        deadline: Deadline,
    ) -> None:
        self._nearby, self._labels, self._cost = nearby, labels, cost
        self._radius, self._deadline = radius, deadline

    def improved(self, first: _State) -> _State:
        """The best state found: least missing width first, then the least sum of aims 3 and 4."""
        best, labels = first, self._labels
        for _ in range(_ROUNDS):
            labels.shorten(self._deadline)
            state = self.state()
            best = min(best, state, key=self._rank)
            before = set(labels.held)
            for corridor in state.narrow:
                self._widen(corridor)
            if labels.held == before:
                break
        return best

    def _rank(self, state: _State) -> tuple[float, float]:
        lacking = round(state.lacking / (self._nearby.mean_edge or 1.0), 3)
        return lacking, state.length + state.cost / self._radius

    def _widen(self, corridor: Corridor) -> None:
        """Widen a corridor to the tool, as far as the segments allow, and hold its vertices.

        Its segment gets the vertices within the tool's radius of the way through the corridor,
        nearest first. A vertex may become free to move once others have, so this is repeated.
        """
        labels, own = self._labels, corridor.segment
        far = within(self._nearby, [(0.0, v) for v in corridor.way], self._radius, self._deadline)
        left = [v for v in sorted(far, key=far.__getitem__) if labels.segment[v] not in (own, -1)]
        while left:
            self._deadline.check()
            rest = [v for v in left if v in labels.held or not labels.give(v, own)]
            if len(rest) == len(left):
                break
            left = rest
        labels.held.update(v for v in far if labels.segment[v] == own)

    def state(self) -> _State:
        """The present position of the borders."""
        labels, nearby = self._labels, self._nearby
        segment, surface = list(labels.segment), nearby.surface

        def joined(a: int, b: int) -> bool:
            return labels.color_of[segment[a]] not in surface.cracked(a, b)

        room = Room(nearby, segment, joined, self._radius, self._deadline)
        corridors = room.corridors()
        narrow = [found for found in corridors if found.width_m < 2 * self._radius]
        lacking = sum(2 * self._radius - found.width_m for found in narrow)
        numbers = np.array(segment, dtype=np.int64)
        cost = 0.0
        if self._cost is not None:
            colored = np.flatnonzero(numbers >= 0)
            color = [labels.color_of[segment[v]] for v in colored.tolist()]
            cost = float((self._cost[colored, color] * nearby.areas[colored]).sum())
        length = border_length(surface, numbers)
        return _State(segment, room, corridors, narrow, lacking, length, cost)

    def borders(self, state: _State) -> Borders:
        """The measures of a state for the report."""
        area = float(self._nearby.areas[np.array(state.segment) >= 0].sum())
        narrowest = state.corridors[0] if state.corridors else None
        repeated = state.room.repeated(state.narrow)
        cost = state.cost / area if area else 0.0
        return Borders(state.length, cost, len(state.narrow), narrowest, repeated)


def border_length(surface: LabelledSurface, segment_of: Index) -> float:
    """The length in m of all borders between segments (n,), -1 for none.

    In a triangle with two segments a border is a straight line between the middles of two mesh
    edges. In a triangle with three, it consists of lines from the middles to the center.
    """
    places = surface.vertices[surface.faces]
    own = segment_of[surface.faces]
    following = own[:, [1, 2, 0]]
    crossed = (own != following) & (own >= 0) & (following >= 0)
    middles = (places + places[:, [1, 2, 0]]) / 2
    count = crossed.sum(axis=1)
    three = np.linalg.norm(middles - places.mean(axis=1, keepdims=True), axis=2)
    total = three[count == 3].sum()
    # One border edge: the third vertex has no segment, so the line ends at the center.
    for row in np.flatnonzero(count == 1).tolist():
        total += three[row][crossed[row]].sum()
    ends = middles[count == 2][crossed[count == 2]].reshape(-1, 2, 3)
    return float(total + np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())
