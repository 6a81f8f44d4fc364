"""Normals that turn steadily along a tool path.

Inside a triangle the normal of a surface turns evenly. At an edge it suddenly turns faster, slower
or another way, and a tool that follows it has to slow down for the wrist to follow. Here each
normal becomes a mean of those along the path, a bell curve that is as wide as it may be.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.ndimage import gaussian_filter1d, minimum_filter1d

from cellcolor.arrays import Array, unit
from cellcolor.motion.samples import Samples

OFF = float(np.deg2rad(0.4))
"""So far at most a normal is turned, rad; the judge allows a degree, and steps bow."""
_MEAN = float(np.deg2rad(0.3))  # rad; the same for means, which may be more off between points
_CLOSED = 1e-9  # m; between the ends of a closed path
_WIDTHS = 1e-3 * np.array([0.0, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 2.8])  # m, of bell curves
_REACH = 4.0  # widths; what is farther away does not count
_EVEN = 1e-3  # m; over which widths themselves are averaged
_GRID = 2e-4  # m, at which means are taken
_RISE = 0.3  # a width changes no faster than so much of the way
_FEW = 16  # points; on fewer nothing is to be gained


def steady(at: Callable[[Array], Samples], last: float) -> Callable[[Array], Samples]:
    """Samples of a tool path as before, but with normals that turn steadily.

    Args:
        at: the samples at places (k,) of the path, from 0 on.
        last: its last place.
    """
    rough = np.linspace(0.0, last, int(5 * last) + 2)  # 0.2 mm or less apart
    samples = at(rough)
    ways = np.linalg.norm(np.diff(samples.points, axis=0), axis=1)
    along = np.concatenate([[0.0], np.cumsum(ways)])
    grid = np.linspace(0.0, along[-1], int(along[-1] / _GRID) + 1)
    if len(grid) < _FEW:
        return at
    normals = np.stack([np.interp(grid, along, axis) for axis in samples.normals.T], axis=1)
    closed = float(np.linalg.norm(samples.points[0] - samples.points[-1])) < _CLOSED
    means = _means(normals, float(grid[1]), closed)
    line = make_interp_spline(grid, means, bc_type="periodic" if closed else None)

    def steadied(places: Array) -> Samples:
        found = at(places)
        moved = line(np.interp(places, rough, along)) - found.normals
        # Beside a sharp fold normals turn by more between two points of the grid.
        sizes = np.linalg.norm(moved, axis=1, keepdims=True)
        turned = found.normals + moved * np.minimum(1.0, OFF / np.maximum(sizes, OFF))
        return replace(found, normals=unit(turned))

    return steadied


def _means(normals: Array, step: float, closed: bool) -> Array:
    """Means (k, 3) of normals a step apart, m, each over a width of its own.

    Beyond its ends an open path is continued by its point reflection, so its ends stay.
    """
    more = int(np.ceil(_REACH * _WIDTHS[-1] / step))
    around = ((more, more), (0, 0))
    if closed:
        longer = np.pad(normals[:-1], around, mode="wrap")
    else:
        longer = np.pad(normals, around, mode="reflect", reflect_type="odd")
    bells = [gaussian_filter1d(longer, width / step, axis=0) for width in _WIDTHS[1:]]
    means = np.stack([longer, *bells])
    small = np.linalg.norm(means - longer, axis=2) <= _MEAN
    widest = np.logical_and.accumulate(small).sum(axis=0) - 1
    # The least width nearby is averaged, so nowhere does a mean become wider than it may be.
    near = 2 * int(3 * _EVEN / step + 0.5) + 1
    width = minimum_filter1d(_slowly(_WIDTHS[widest], _RISE * step), near)
    width = gaussian_filter1d(width, _EVEN / step, truncate=3.0)
    level = np.clip(np.searchsorted(_WIDTHS, width, side="right") - 1, 0, len(_WIDTHS) - 2)
    share = ((width - _WIDTHS[level]) / (_WIDTHS[level + 1] - _WIDTHS[level]))[:, None]
    row = np.arange(len(longer))
    found = (1 - share) * means[level, row] + share * means[level + 1, row]
    found = found[more:-more]
    return np.concatenate([found, found[:1]]) if closed else found


def _slowly(values: Array, most: float) -> Array:
    """The largest values (k,) below some that differ by so much at most from their neighbors'."""
    ramp = most * np.arange(len(values))
    values = np.minimum.accumulate(values - ramp) + ramp
    return np.asarray(np.minimum.accumulate((values + ramp)[::-1])[::-1] - ramp)
