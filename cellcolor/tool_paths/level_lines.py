"""A mesh sliced along level lines of a field, so that every line is a row of edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.tool_paths.triangles import Triangles, split_at

_NEAR = 0.02  # of the distance between levels: vertices this close to a level are moved off it


@dataclass(frozen=True, eq=False)
class Sliced:
    """A mesh with the level lines of a field among its edges.

    Attributes:
        mesh: the finer mesh.
        values: (n,) the field at its vertices.
        level: (n,) the number of the level that a vertex was put on, -1 for all other vertices.
    """

    mesh: Triangles
    values: Array
    level: Index


Row = tuple[list[int], bool]
"""Vertices in order, and whether the row closes; the first is not repeated at the end then."""


def slice_along(mesh: Triangles, values: Array, levels: Array) -> Sliced:
    """Cut triangles along the level lines of a field that is linear in each.

    Levels ascend. A value (n,) on one or just beside it is moved off, so that lines run through no
    vertex and never touch each other.
    """
    if not len(levels):
        return Sliced(mesh, values, np.full(len(mesh.points), -1, dtype=np.int64))
    values = _off(values, levels)
    # Edges that several levels cross are halved until each is crossed by one at most.
    while True:
        at = np.sort(np.searchsorted(levels, values[mesh.edges]), axis=1)
        crossed = at[:, 1] - at[:, 0]
        several = crossed > 1
        if not several.any():
            break
        middles = values[mesh.edges[several]].mean(axis=1)
        mesh, _ = split_at(mesh, several, 0.5)
        values = _off(np.concatenate([values, middles]), levels)
    ends = values[mesh.edges]
    split = crossed == 1
    number = np.minimum(at[:, 0], len(levels) - 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = (levels[number] - ends[:, 0]) / (ends[:, 1] - ends[:, 0])
    finer, on = split_at(mesh, split, shares)
    level = np.concatenate([np.full(len(mesh.points), -1, dtype=np.int64), number[on]])
    return Sliced(finer, np.concatenate([values, levels[number[on]]]), level)


def level_lines(sliced: Sliced) -> list[Row]:
    """All connected level lines, by their lowest vertex; one that is open ends at the border."""
    edges = sliced.mesh.edges
    own = edges[(sliced.level[edges] >= 0).all(axis=1)]
    beside: dict[int, list[int]] = {}
    for a, b in own.tolist():
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    done: set[int] = set()
    lines = []
    # Lines with ends first, each from an end; what is left is closed.
    for start in sorted(beside, key=lambda vertex: (len(beside[vertex]), vertex)):
        if start in done:
            continue
        row = [start]
        done.add(start)
        while True:
            onward = [other for other in beside[row[-1]] if other not in done]
            if not onward:
                break
            row.append(onward[0])
            done.add(onward[0])
        lines.append((row, len(beside[start]) == 2))
    return lines


def _off(values: Array, levels: Array) -> Array:
    """The values, those on a level or just beside it moved a little above it."""
    apart = float(np.diff(levels).min()) if len(levels) > 1 else float(np.ptp(values)) or 1.0
    at = np.searchsorted(levels, values)
    bounds = np.concatenate([[-np.inf], levels, [np.inf]])
    below, above = bounds[at], bounds[at + 1]
    nearest = np.where(values - below < above - values, below, above)
    near = np.abs(values - nearest) < _NEAR * apart
    return np.where(near, nearest + _NEAR * apart, values)
