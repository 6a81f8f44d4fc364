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

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, RefusedResult
from cellcolor.painting.paint import BorderMeasures, BorderReport, Painted
from cellcolor.painting.relabelling import Nearby, Relabelling


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
    cost = np.zeros(shape) if cost is None else cost
    if cost.shape != shape or not np.isfinite(cost).all():
        raise InputError(None, "cost", f"needs a finite number for each of {shape}")
    colors = painted.plan.vertex_colors
    color_of = {
        segment: color
        for segment, color in zip(painted.segment_of.tolist(), colors, strict=True)
        if color is not None
    }
    toll = cost * (nearby.areas / radius)[:, None]
    labels = Relabelling(nearby, painted.segment_of, color_of, toll)
    labels.shorten(deadline)
    segment_of = np.array(labels.segment, dtype=np.int64)
    plan = Plan(tuple([color_of.get(segment) for segment in labels.segment]))
    counted = check_plan(surface, plan).segments
    if counted != painted.segments:
        raise RefusedResult(f"moved borders have {counted} segments, not {painted.segments}")

    def measured(segment_of: Index) -> BorderMeasures:
        colored = np.flatnonzero(segment_of >= 0)
        color = [color_of[segment] for segment in segment_of[colored].tolist()]
        areas = nearby.areas[colored]
        mean = np.average(cost[colored, color], weights=areas) if areas.any() else 0.0
        return BorderMeasures(border_length(surface, segment_of), float(mean))

    moved = int((segment_of != painted.segment_of).sum())
    report = BorderReport(measured(painted.segment_of), measured(segment_of), moved)
    return replace(painted, plan=plan, segment_of=segment_of, borders=report)


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
