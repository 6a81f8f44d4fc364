"""A capsule around points, as small as can be found."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.optimize import minimize

from cellcolor.arrays import Array
from cellcolor.frontend.arm.polyhedron import convex_hull

__all__ = ["Capsule", "along_axis", "capsule_around"]

_ROUNDING = 1e-9  # of the radius, so that no point is left outside by rounding


class Capsule(NamedTuple):
    """All points within ``radius`` (m) of the segment from ``start`` to ``end``, (3,) in m."""

    start: Array
    end: Array
    radius: float

    @property
    def volume(self) -> float:
        """In m^3."""
        length = float(np.linalg.norm(self.end - self.start))
        return float(np.pi * self.radius**2 * (length + 4 / 3 * self.radius))


def capsule_around(points: Array) -> Capsule:
    """A small capsule around points (n, 3): the best one found from each principal direction."""
    hull = convex_hull(points)
    outer = points if hull is None else hull.vertices
    middle = outer.mean(axis=0)
    axes = np.linalg.svd(outer - middle, full_matrices=False)[2]
    size = max(float(np.ptp(outer, axis=0).max()), 1e-9)
    best = None
    for axis in axes:
        across = np.linalg.svd(axis[None])[2][1:]

        def around(tried: Array, axis: Array = axis, across: Array = across) -> Capsule:
            direction = axis + tried[2:4] @ across
            center = middle + size * tried[:2] @ across
            direction /= np.linalg.norm(direction)
            return along_axis(outer, center, direction, 1 + abs(float(tried[4])))

        found = minimize(
            lambda tried, around=around: around(tried).volume / size**3,
            _SIMPLEX[0],
            method="Nelder-Mead",
            options={"maxiter": 200, "initial_simplex": _SIMPLEX},
        )
        capsule = around(found.x)
        if best is None or capsule.volume < best.volume:
            best = capsule
    assert best is not None  # there are three axes
    return best


_SIMPLEX = np.concatenate([np.zeros((1, 5)), 0.1 * np.eye(5)])


def along_axis(points: Array, center: Array, axis: Array, wider: float) -> Capsule:
    """The shortest capsule around points whose axis lies on a given line.

    Its radius is ``wider`` times the smallest one that is possible; with more it may be shorter.
    """
    along = (points - center) @ axis
    off = points - center - along[:, None] * axis
    squares = np.einsum("ij,ij->i", off, off)
    radius = float(np.sqrt(squares.max())) * wider * (1 + _ROUNDING)
    cap = np.sqrt(np.maximum(radius**2 - squares, 0.0))
    low, high = float((along + cap).min()), float((along - cap).max())
    if low > high:
        low = high = (low + high) / 2
    return Capsule(center + low * axis, center + high * axis, radius)
