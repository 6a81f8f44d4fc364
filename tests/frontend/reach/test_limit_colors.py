"""Colors that keep the joint limits, against positions worked out by hand or by trial.

The angles of one joint are given on a mesh; what inverse kinematics has of them is their remainder
modulo a full circle. A segment can be driven if some continuous positions of it are in the limits.
"""

from __future__ import annotations

from itertools import product
from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cellcolor.arrays import Array, Index
from cellcolor.frontend.reach.colors import Coloring, LimitColors, limit_colors

CIRCLE = 2 * pi


def divided(angles: Array, edges: Index, lower: float, upper: float) -> LimitColors:
    """The colors of one branch that reaches every vertex; angles (n,) in rad, edges all linked."""
    robot: Any = SimpleNamespace(
        joints=1,
        slides=np.array([False]),
        lower=np.array([lower]),
        upper=np.array([upper]),
        joint_names=("joint",),
    )
    remainder = np.remainder(angles + pi, CIRCLE) - pi
    linked = np.ones((len(edges), 1), dtype=bool)
    coloring = Coloring(("branch",), (0,), np.zeros((len(angles), 1), dtype=np.int64), linked, ())
    return limit_colors(robot, coloring, remainder[:, None, None], edges)


def row(count: int) -> Index:
    """Edges of vertices one beside the other."""
    return np.array([(k, k + 1) for k in range(count - 1)])


def ring(count: int) -> Index:
    return np.array([(k, (k + 1) % count) for k in range(count)])


def fewest_in_a_row(found: LimitColors, count: int) -> int:
    """The fewest stretches of one color, without a crack, that a row of vertices falls into."""
    torn = {(min(c.i, c.j), color) for c in found.cracks for color in c.colors}
    parts, start = 0, 0
    while start < count:
        ends = []
        for color, mask in enumerate(found.members):
            end = start
            while end < count and mask[end] and (end == start or (end - 1, color) not in torn):
                end += 1
            ends.append(end)
        assert max(ends) > start, "a vertex has no color"
        parts, start = parts + 1, max(ends)
    return parts


def fewest_by_trial(angles: Array, lower: float, upper: float) -> int:
    """The same by the definition: from the first vertex on, as far as some full circles allow."""
    parts, start = 0, 0
    while start < len(angles):
        end = start
        for turns in range(-5, 6):
            here = start
            while here < len(angles) and lower <= angles[here] + CIRCLE * turns <= upper:
                here += 1
            end = max(end, here)
        parts, start = parts + 1, end
    return parts


def test_a_ring_that_winds_is_cut_at_the_limits() -> None:
    # Once around with limits of 185 degrees each way: one segment is enough, with a wall in it.
    angles = np.radians(np.arange(0.0, 360.0, 10.0))
    found = divided(angles, ring(36), -np.radians(185), np.radians(185))
    assert found.winding == ("branch",)
    whole = [color for color, mask in enumerate(found.members) if mask.all()]
    assert whole
    for color in whole:
        walls = [c for c in found.cracks if color in c.colors]
        assert len(walls) == 1  # an annulus of one ring of edges is cut once
        (wall,) = walls
        ends = {wall.i, wall.j}
        assert ends <= set(range(16, 21))  # between 160 and 200 degrees


@given(
    steps=st.lists(st.floats(-1.4, 1.4), min_size=3, max_size=40),
    start=st.floats(-pi, pi),
    lower=st.floats(-6.0, -3.2),
    upper=st.floats(3.2, 6.0),
)
def test_rows_against_trial(steps: list[float], start: float, lower: float, upper: float) -> None:
    angles = start + np.cumsum(steps)
    found = divided(angles, row(len(angles)), lower, upper)
    fewest = fewest_in_a_row(found, len(angles))
    # A margin of 0.02 rad is kept where a color is divided, so one may need more, never fewer.
    assert fewest_by_trial(angles, lower, upper) <= fewest
    assert fewest <= fewest_by_trial(angles, lower + 0.021, upper - 0.021)
    for color, positions in found.positions.items():
        own = found.members[color]
        assert np.array_equal(np.isfinite(positions[:, 0]), own)
        turned = (positions[own, 0] - angles[own]) / CIRCLE
        assert np.allclose(turned, turned.round(), atol=1e-6)
        assert (positions[own] >= lower - 1e-6).all() and (positions[own] <= upper + 1e-6).all()


@given(data=st.data())
def test_every_walk_of_a_color_stays_in_the_limits(data: st.DataObject) -> None:
    # Any graph with any angles, winding or not: along links without a crack positions go on.
    count = data.draw(st.integers(2, 8))
    pairs = [(i, j) for i, j in product(range(count), repeat=2) if i < j]
    chosen = data.draw(st.lists(st.sampled_from(pairs), min_size=1, unique=True))
    edges = np.array(sorted(chosen))
    angles = np.array(data.draw(st.lists(st.floats(-pi, 3.14), min_size=count, max_size=count)))
    lower, upper = data.draw(st.floats(-6.2, -3.2)), data.draw(st.floats(3.2, 6.2))
    found = divided(angles, edges, lower, upper)
    torn = {(c.i, c.j, color) for c in found.cracks for color in c.colors}
    assert np.any(found.members, axis=0).all()  # each angle has a position in these limits
    for color, positions in found.positions.items():
        own = found.members[color]
        assert (positions[own] >= lower - 1e-6).all() and (positions[own] <= upper + 1e-6).all()
        for i, j in edges.tolist():
            if own[i] and own[j]:
                goes_on = abs(positions[i, 0] - positions[j, 0]) <= pi
                assert goes_on == ((i, j, color) not in torn)
