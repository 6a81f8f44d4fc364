"""Random paintings: surfaces with cracks, holes and handles, and a random division painted."""

from __future__ import annotations

import random
from typing import NamedTuple

import numpy as np
from random_divisions import random_division, random_seams

from cellcolor.data.solution import InstanceReference, Solution, count_segments
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.lab.families.voronoi import voronoi
from cellcolor.painting.paint import paint

SHAPES = ("disc", "annulus", "sphere", "torus", "double torus")


class Painting(NamedTuple):
    """What tool paths are laid on."""

    surface: LabelledSurface
    segment_of: np.ndarray
    colors: list[int]
    normals: np.ndarray


def painted_at_random(seed: int, shape: str) -> Painting:
    """A painting with cells of one vertex, cracks, holes and seams."""
    rng = random.Random(seed)
    surface = voronoi(
        seed, shape, size=rng.randint(8, 12), regions=rng.randint(1, 12), colors=rng.randint(1, 4),
        scattered=rng.random() < 0.5, cracks=rng.choice((0, 4, 8)), islands=rng.choice((0, 3)),
        holes=rng.choice((0, 2)),
    )  # fmt: skip
    decomposition = decomposition_of(surface)
    instance = decomposition.instance
    seams = random_seams(instance, 2, rng)
    division = random_division(instance, seams, rng.randint(1, 2), rng)
    segments = count_segments(division)
    solution = Solution(
        InstanceReference(instance.name, instance.sha256), "surface", 2, "by chance",
        "feasible", segments, max(0, segments - 1), 0, 0, False, seams, division, 0.0,
    )  # fmt: skip
    painted = paint(surface, decomposition, solution)
    color = {sub.segment: sub.color for cell in division for sub in cell.subcells}
    colors = [color.get(number, -1) for number in range(max(color, default=-1) + 1)]
    return Painting(painted.surface, painted.segment_of, colors, normals_of(painted.surface))


def normals_of(surface: LabelledSurface) -> np.ndarray:
    """Unit normals at the vertices, the mean of those of the triangles around by area."""
    corners = surface.vertices[surface.faces]
    doubled = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(surface.vertices)
    np.add.at(normals, surface.faces, doubled[:, None, :])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
