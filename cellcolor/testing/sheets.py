"""Flat labelled surfaces made of a few numbers, which Hypothesis can make smaller and print."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.lab.families.meshes import grid_faces
from cellcolor.mesh.triangle_mesh import TriangleMesh

Rectangle = tuple[int, int, int, int]
"""Column and row of a corner and of the opposite one; what lies beyond the sheet is cut off."""


def sheet(
    columns: int,
    rows: int,
    reach: Sequence[Sequence[Rectangle]],
    cracks: Sequence[tuple[int, int, int]] = (),
) -> LabelledSurface:
    """A sheet of points 1 m apart, on which each color reaches a few rectangles.

    Points in no rectangle are unreachable.

    Args:
        columns: of points, along x, 2 or more.
        rows: of points, along y, 2 or more.
        reach: the rectangles of each color.
        cracks: a column, and two rows: no color is continuous from this column to the next one
            between these rows.
    """
    reached = np.zeros((rows, columns, len(reach)), dtype=bool)
    for color, rectangles in enumerate(reach):
        for x, y, other_x, other_y in rectangles:
            across = slice(min(x, other_x), max(x, other_x) + 1)
            reached[min(y, other_y) : max(y, other_y) + 1, across, color] = True
    colors = [tuple(np.flatnonzero(own).tolist()) for own in reached.reshape(rows * columns, -1)]
    faces = grid_faces(rows, columns)
    y, x = np.mgrid[0:rows, 0:columns]
    points = np.stack([x.ravel(), y.ravel(), np.zeros(rows * columns)], axis=1).astype(np.float64)
    return LabelledSurface(
        "sheet",
        tuple(f"c{color}" for color in range(len(reach))),
        points,
        faces,
        tuple(colors),
        tuple(
            Crack(i, j, shared)
            for i, j in TriangleMesh(points, faces).edges.tolist()
            if (shared := tuple(sorted({*colors[i]} & {*colors[j]})))
            and any(_crosses(i, j, columns, crack) for crack in cracks)
        ),
    )


def _crosses(i: int, j: int, columns: int, crack: tuple[int, int, int]) -> bool:
    """Whether a mesh edge goes from the crack's column to the next one, between its rows."""
    column, row, other_row = crack
    between = range(min(row, other_row), max(row, other_row) + 1)
    return {i % columns, j % columns} == {column, column + 1} and all(
        vertex // columns in between for vertex in (i, j)
    )
