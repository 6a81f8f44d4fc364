"""Borders moved to where they should be (docs/painting.md, "Moving the borders").

What comes first, in this order:

1. The segments stay what they are: a vertex changes its segment only if no segment falls apart.
2. Corridors are as wide as the tool, where that is possible.
3. The arm is well conditioned: the caller says what a color costs at each vertex.
4. Borders are short.

The last two are one sum, the length of the borders in m + the integral of the cost over the surface
in m² / the tool's radius in m. So a difference in cost of 1 on both sides of a border is worth
bending it as sharply as the tool's rim.
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
"""So often are corridors widened, and borders shortened again."""


def move_borders(
    painted: Painted,
    tool_radius_m: float | None = None,
    cost: Array | None = None,
    deadline: Deadline = NEVER,
) -> Painted:
    """Move the borders between the segments of a painting; its surface stays.

    Args:
        painted: any painting.
        tool_radius_m: of the footprint; None for one mean mesh edge, so that a corridor has a row
            of vertices inside.
        cost: (n, colors) from 0, best, to 1, what a vertex of that color costs; None for nothing.
        deadline: when to give up.

    Returns:
        The painting with the same segments elsewhere; ``borders`` says what has changed.

    Raises:
        InputError: the radius is not positive, or the cost has another shape or is not finite.
        OutOfTime: the deadline came first.
        RefusedResult: the checker counts other segments than before.
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
    """Where borders are at one time.

    Attributes:
        segment: of each vertex.
        room: that they leave.
        corridors: narrowest first.
        narrow: those that the tool is too wide for.
        lacking: of the widths of these, in sum, m.
        length: of the borders, m.
        cost: its integral over the surface, m².
    """

    segment: list[int]
    room: Room
    corridors: list[Corridor]
    narrow: list[Corridor]
    lacking: float
    length: float
    cost: float


class _Moving:
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
        """The best state on the way: the one that lacks least width, then the one of least sum."""
        best, held = first, set[int]()
        labels = self._labels
        for _ in range(_ROUNDS):
            labels.shorten(self._deadline)
            state = self.state()
            best = min(best, state, key=self._rank)
            before = set(held)
            for corridor in state.narrow:
                self._widen(corridor)
            held = set(labels.held)
            if held == before:
                break
        return best

    def _rank(self, state: _State) -> tuple[float, float]:
        lacking = round(state.lacking / (self._nearby.mean_edge or 1.0), 3)
        return lacking, state.length + state.cost / self._radius

    def _widen(self, corridor: Corridor) -> None:
        """Give all within the tool's radius of a corridor's middle to it, and hold it there."""
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
        """Where borders are now."""
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
        """A state in numbers."""
        area = float(self._nearby.areas[np.array(state.segment) >= 0].sum())
        narrowest = state.corridors[0] if state.corridors else None
        repeated = state.room.repeated(state.narrow)
        cost = state.cost / area if area else 0.0
        return Borders(state.length, cost, len(state.narrow), narrowest, repeated)


def border_length(surface: LabelledSurface, segment_of: Index) -> float:
    """The length in m of all borders between segments (n,), -1 for none.

    They are drawn straight through triangles, from the middle of one mesh edge to that of another;
    in a triangle with three segments to its center.
    """
    places = surface.vertices[surface.faces]
    own = segment_of[surface.faces]
    following = own[:, [1, 2, 0]]
    crossed = (own != following) & (own >= 0) & (following >= 0)
    middles = (places + places[:, [1, 2, 0]]) / 2
    count = crossed.sum(axis=1)
    three = np.linalg.norm(middles - places.mean(axis=1, keepdims=True), axis=2)
    total = three[count == 3].sum()
    # Two middles, or one and the center where the third vertex has no segment.
    for row in np.flatnonzero(count == 1).tolist():
        total += three[row][crossed[row]].sum()
    ends = middles[count == 2][crossed[count == 2]].reshape(-1, 2, 3)
    return float(total + np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum())
