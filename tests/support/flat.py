"""Flat painted surfaces, of which areas and distances are known."""

from __future__ import annotations

import numpy as np
from painted_at_random import Painting

from cellcolor.data.surface import Crack, LabelledSurface
from cellcolor.lab.families.meshes import grid_faces, make_mesh


def square(size: int = 11, cracks: tuple[tuple[int, int], ...] = ()) -> Painting:
    """The unit square in one segment, a grid of ``size`` times ``size`` vertices."""
    y, x = np.mgrid[0:size, 0:size] / (size - 1)
    points = np.stack([x.ravel(), y.ravel(), np.zeros(size * size)], axis=1)
    return one_segment(points, grid_faces(size, size), cracks)


def one_segment(
    points: np.ndarray, faces: np.ndarray, cracks: tuple[tuple[int, int], ...] = ()
) -> Painting:
    """A mesh in one color and one segment."""
    count = len(points)
    made = tuple([Crack(a, b, (0,)) for a, b in cracks])
    surface = LabelledSurface("one", ("a",), points, faces, ((0,),) * count, made)
    return Painting(surface, np.zeros(count, dtype=np.int64), [0], surface.vertex_normals)


def whole(shape: str, size: int = 10) -> Painting:
    """A mesh of some shape in one segment, its triangles about as wide as long."""
    if shape == "annulus":  # the one that random surfaces are drawn on has long triangles
        row, column = np.mgrid[0 : 6 * size, 0 : size + 1]
        radius, angle = 0.2 + 0.3 * column / size, 2 * np.pi * row / (6 * size)
        points = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius], axis=-1)
        return one_segment(points.reshape(-1, 3), grid_faces(6 * size, size + 1, wrap_rows=True))
    return one_segment(*make_mesh(shape, size))


def slit(size: int, column: int, rows: range) -> tuple[tuple[int, int], ...]:
    """The mesh edges of a grid between a column and the next one, in some rows."""
    found = []
    for row in rows:
        here = row * size + column
        found.append((here, here + 1))  # along the row
        found.append((here, here + size + 1))  # the diagonal of the square above
    return tuple(found)
