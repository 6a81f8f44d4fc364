"""Smooth random color domains on a square grid mesh."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.surface import LabelledSurface
from cellcolor.errors import InputError
from cellcolor.lab.families.meshes import crack_paths, grid_faces


def blobs(
    seed: int,
    size: int = 24,
    colors: int = 6,
    *,
    waves: float = 0.7,
    coverage: tuple[float, float] = (0.35, 0.65),
    thin: bool = False,
    cracks: int = 0,
    rim: int = 0,
    islands: int = 0,
    holes: int = 0,
) -> LabelledSurface:
    """Smooth random color domains on a square grid mesh.

    Each color reaches where a random field of a few waves is high (or, ``thin``, near its median:
    bands instead of blobs). Where domains overlap a point has several colors, where none reaches
    it has none.

    Args:
        size: points along each side of the grid, two or more.
        waves: how many waves of a field fit across the grid, or nearly; more waves, more cells.
        coverage: the least and the largest share of the grid that a color reaches.
        thin: narrow bands instead of round blobs.
        cracks: random paths over the mesh that the colors common to both sides do not cross.
        rim: discs on the border of the grid that only one color reaches. With a large coverage
            they make the cell in their middle one that has to be cut.
        islands: such discs anywhere.
        holes: discs that no color reaches.

    Raises:
        InputError: a size below 2 or no colors.
    """
    if size < 2 or colors < 1:
        raise InputError(None, None, f"blobs need a size of 2 or more (is {size}) and a color")
    rng = np.random.default_rng([seed, size, colors])
    y, x = np.mgrid[0:size, 0:size]
    reached = np.zeros((colors, size, size), dtype=bool)
    for color in range(colors):
        field = _waves(rng, x / size, y / size, waves)
        if thin:
            field = -np.abs(field - np.median(field))
        reached[color] = field >= np.quantile(field, 1.0 - rng.uniform(*coverage))
    for number in range(rim + islands + holes):
        center = rng.uniform(0.2, 0.8, 2) * (size - 1)
        if number < rim:
            center[rng.integers(2)] = rng.integers(2) * (size - 1)
        radius = rng.uniform(0.09, 0.2) * size
        disc = np.hypot(x - center[0], y - center[1]) <= radius
        reached[:, disc] = False
        if number < rim + islands:
            reached[rng.integers(colors), disc] = True
    vertex_colors = tuple(
        tuple(np.flatnonzero(available).tolist()) for available in reached.reshape(colors, -1).T
    )
    faces = grid_faces(size, size)
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(size * size)], axis=1).astype(np.float64)
    return LabelledSurface(
        f"blobs_{seed}",
        tuple(f"c{color}" for color in range(colors)),
        vertices,
        faces,
        vertex_colors,
        crack_paths(rng, faces, vertex_colors, cracks, size),
        {"family": "blobs", "seed": seed},
    )


def _waves(rng: np.random.Generator, x: Array, y: Array, frequency: float) -> Array:
    """A smooth random field: a dozen plane waves of about the given frequency."""
    field = np.zeros_like(x)
    for _ in range(12):
        kx, ky = rng.normal(0.0, frequency / 2, 2)
        field += np.cos(2 * np.pi * (kx * x + ky * y) + rng.uniform(0, 2 * np.pi))
    return field
