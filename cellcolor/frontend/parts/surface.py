"""The surface to be covered, as a triangle mesh with normals."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.frontend.parts.placement import Placement, rotation_from_rpy

__all__ = ["Faces", "Surface", "along_edges", "every_edge", "face_normals"]

Faces = NDArray[np.int64]


@dataclass(frozen=True)
class Surface:
    """A triangle mesh with outward unit normals at its vertices; faces ccw from outside, m.

    Attributes:
        vertices: (n, 3).
        faces: (m, 3).
        normals: (n, 3).
        faceted: whether the normals are means of its faces' normals, not those of a smooth shape.
    """

    vertices: Array
    faces: Faces
    normals: Array
    faceted: bool = False

    def placed(self, placement: Placement) -> Surface:
        """The same surface in the world."""
        rotation = rotation_from_rpy(*placement.rpy_rad)
        vertices = self.vertices @ rotation.T + np.array(placement.position_m)
        return replace(self, vertices=vertices, normals=self.normals @ rotation.T)

    def vertex_areas(self) -> Array:
        """A third of the adjoining faces' areas, (n,), m^2; they add up to the whole."""
        third = np.linalg.norm(face_normals(self.vertices, self.faces), axis=1) / 6
        areas = np.zeros(len(self.vertices))
        np.add.at(areas, self.faces, third[:, None])
        return areas

    def edges(self) -> Faces:
        """Every mesh edge once, (k, 2), smaller index first, in lexicographic order."""
        return every_edge(self.faces)

    def lengths(self, edges: Faces) -> Array:
        """Lengths (k,) of mesh edges (k, 2), m."""
        i, j = edges.T
        lengths: Array = np.linalg.norm(self.vertices[i] - self.vertices[j], axis=1)
        return lengths

    def turns(self, edges: Faces) -> Array:
        """Angles (k,) between the normals at the ends of mesh edges (k, 2), rad."""
        i, j = edges.T
        chord = np.linalg.norm(self.normals[i] - self.normals[j], axis=1)
        return np.asarray(2 * np.arcsin(np.minimum(chord / 2, 1.0)))


def every_edge(faces: Faces) -> Faces:
    """The edges (k, 2) of faces (m, 3), each once, in lexicographic order."""
    pairs = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    pairs.sort(axis=1)
    # One number a pair, sorted: np.unique takes fifty times as long, by rows or by numbers.
    count = int(pairs.max(initial=0)) + 1
    numbers = np.sort(pairs[:, 0] * count + pairs[:, 1])
    return np.stack(np.divmod(numbers[np.diff(numbers, prepend=-1) > 0], count), axis=1)


def face_normals(vertices: Array, faces: Faces) -> Array:
    """Normals (m, 3) with twice the face's area as their length."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normals: Array = np.cross(b - a, c - a)
    return normals


def along_edges(surface: Surface, edges: Index, way: Array) -> tuple[Array, Array]:
    """Points and unit tool directions (k, 3) at the parts ``way`` (k,) of mesh edges (k, 2).

    The point goes straight, on the mesh, and the normal turns with it.
    """
    i, j = edges.T
    at = way[:, None]
    points = (1 - at) * surface.vertices[i] + at * surface.vertices[j]
    normals = (1 - at) * surface.normals[i] + at * surface.normals[j]
    with np.errstate(invalid="ignore"):  # between opposite normals there is none: NaN
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return points, -normals
