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

from cellcolor.arrays import Array
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError, RefusedResult
from cellcolor.painting.paint import Painted
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
        The painting with moved borders.

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
    return replace(painted, plan=plan, segment_of=segment_of)
