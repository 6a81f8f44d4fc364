"""Surfaces of simple shapes: meshes of the plane, mapped keeping areas."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, FiniteFloat

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.surface import MOST_VERTICES, Faces, Part, Surface, check_vertices
from cellcolor.frontend.tables import IN_RADIANS, Length


class _Sampled(Part):
    """A shape whose mesh is made here."""

    target_vertices: Annotated[int, Field(ge=7, le=MOST_VERTICES)]
    jitter: Annotated[FiniteFloat, Field(ge=0, le=0.25)] = 0.0
    seed: Annotated[int, Field(ge=0)] = 0


class CapObject(_Sampled):
    """A spherical cap about +z, the sphere's center at the object's origin."""

    kind: Literal["spherical-cap"] = "spherical-cap"
    radius_m: Length
    half_angle_rad: Annotated[FiniteFloat, Field(gt=0, lt=3.1), IN_RADIANS]

    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:  # noqa: ARG002
        """The cap as rings of vertices about its pole."""
        disc, faces = disc_mesh(self.target_vertices, self.jitter, self.seed)
        squared = (disc**2).sum(axis=1)
        height = 1 - squared * (1 - np.cos(self.half_angle_rad))  # cosine of the polar angle
        stretch = np.zeros(len(disc))
        stretch[1:] = np.sqrt((1 - height[1:] ** 2) / squared[1:])
        normals = np.column_stack([disc * stretch[:, None], height])
        return Surface(self.radius_m * normals, faces, normals)


class PipeObject(_Sampled):
    """Part of a pipe's outside: its axis along y through the origin, its crown at +z."""

    kind: Literal["pipe"] = "pipe"
    radius_m: Length
    length_m: Length
    arc_rad: Annotated[FiniteFloat, Field(gt=0, lt=6.2), IN_RADIANS]

    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:  # noqa: ARG002
        """The pipe as a grid that is bent."""
        sizes = self.radius_m * self.arc_rad, self.length_m
        grid, faces = grid_mesh(*sizes, self.target_vertices, self.jitter, self.seed)
        angle = grid[:, 0] / self.radius_m - self.arc_rad / 2
        zero = np.zeros(len(grid))
        normals = np.column_stack([np.sin(angle), zero, np.cos(angle)])
        along = np.column_stack([zero, grid[:, 1] - self.length_m / 2, zero])
        return Surface(self.radius_m * normals + along, faces, normals)


class RectangleObject(_Sampled):
    """A flat rectangle in z = 0, centered on the origin, its outside at +z."""

    kind: Literal["rectangle"] = "rectangle"
    size_x_m: Length
    size_y_m: Length

    def surface(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Surface:  # noqa: ARG002
        """The rectangle as a grid."""
        sizes = self.size_x_m, self.size_y_m
        grid, faces = grid_mesh(*sizes, self.target_vertices, self.jitter, self.seed)
        vertices = np.column_stack([grid - np.array(sizes) / 2, np.zeros(len(grid))])
        return Surface(vertices, faces, np.tile([0.0, 0.0, 1.0], (len(grid), 1)))


def disc_mesh(target: int, jitter: float, seed: int) -> tuple[Array, Faces]:
    """The unit disc as concentric rings of 6, 12, 18, ... vertices about a center.

    Args:
        target: wanted number of vertices; the nearest possible one is 1 + 3 k (k + 1).
        jitter: vertices are moved by at most this part of a ring's width, along the rim and
            (except on the rim) across it, so that borders do not run along mesh lines.

    Returns:
        points (n, 2) and faces (m, 3), counter-clockwise.
    """
    rings = max(1, round((np.sqrt(1 + 4 * (target - 1) / 3) - 1) / 2))
    ring = np.repeat(np.arange(1, rings + 1), 6 * np.arange(1, rings + 1))
    place = np.concatenate([np.arange(6 * k) for k in range(1, rings + 1)])
    shift = np.random.default_rng(seed).uniform(-jitter, jitter, (len(ring), 2))
    shift[ring == rings, 0] = 0.0
    radius = (ring + shift[:, 0]) / rings
    # A ring's vertices are pi/3 ring widths apart, so this is a part of a ring width as well.
    angle = (place + shift[:, 1]) * np.pi / (3 * ring)
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    return np.vstack([[0.0, 0.0], points]), np.array(_disc_faces(rings), dtype=np.int64)


def _disc_faces(rings: int) -> list[tuple[int, int, int]]:
    def vertex(ring: int, place: int) -> int:
        return 0 if ring == 0 else 1 + 3 * ring * (ring - 1) + place % (6 * ring)

    faces = []
    for ring in range(1, rings + 1):
        for sector in range(6):
            outer, inner = sector * ring, sector * (ring - 1)
            for step in range(ring):
                a, b = vertex(ring, outer + step), vertex(ring, outer + step + 1)
                faces.append((a, b, vertex(ring - 1, inner + step)))
                if step + 1 < ring:
                    inside = vertex(ring - 1, inner + step), vertex(ring - 1, inner + step + 1)
                    faces.append((inside[0], b, inside[1]))
    return faces


def grid_mesh(
    width: float, height: float, target: int, jitter: float, seed: int
) -> tuple[Array, Faces]:
    """A rectangle from (0, 0) to (width, height) as rows of nearly square meshes.

    Args:
        target: wanted number of vertices; rows and columns are chosen near it.
        jitter: vertices are moved by at most this part of a mesh, on the border along it only,
            at the corners not at all.

    Returns:
        points (n, 2) and faces (m, 3), counter-clockwise.
    """
    columns = max(1, round(np.sqrt(target * width / height)) - 1)
    rows = max(1, round(target / (columns + 1)) - 1)
    check_vertices((columns + 1) * (rows + 1), "target_vertices")  # a strip can get far too long
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(rows + 1.0))
    shift = np.random.default_rng(seed).uniform(-jitter, jitter, (2, *x.shape))
    shift[0, :, [0, -1]] = 0.0
    shift[1, [0, -1], :] = 0.0
    points = np.stack([(x + shift[0]) * width / columns, (y + shift[1]) * height / rows], axis=-1)
    number = np.arange(x.size).reshape(x.shape)
    a, b = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    c, d = number[1:, 1:].ravel(), number[1:, :-1].ravel()
    # Diagonals in turn, so that they favor no direction.
    even = ((x + y)[:-1, :-1].ravel() % 2 == 0)[:, None]
    first = np.where(even, np.column_stack([a, b, c]), np.column_stack([a, b, d]))
    second = np.where(even, np.column_stack([a, c, d]), np.column_stack([b, c, d]))
    return points.reshape(-1, 2), np.concatenate([first, second]).astype(np.int64)
