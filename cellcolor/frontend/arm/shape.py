"""Shapes that collide, as plain numbers; each engine makes of them what it works with."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
import trimesh
from scipy.spatial import ConvexHull, QhullError

from cellcolor.arrays import Array, Index
from cellcolor.mesh.triangle_mesh import grouped

Kind = Literal[
    "box", "sphere", "cylinder", "capsule", "cone", "half-space", "cells", "hull", "mesh"
]


@dataclass(frozen=True, eq=False)
class Shape:
    """A shape and where it is. All but a mesh are filled.

    Attributes:
        kind: a cylinder, capsule or cone is about its own z axis, in the middle of its length; a
            half space is below its own plane z = 0; ``cells`` are equal cubes.
        sizes: in m; three sides of a box, the radius of a sphere, radius and length of what has an
            axis (a capsule's without its round ends), the side of a cell.
        vertices: (n, 3) of a hull or a mesh, m; of cells the corner with the lowest coordinates.
        faces: (m, 3) of a hull or a mesh, counter-clockwise seen from outside.
        rotation, origin: (3, 3), and (3,) in m, from its own frame to that of what carries it.
        made: what engines have made of it, by their names; the same shape elsewhere shares it.
    """

    kind: Kind
    sizes: tuple[float, ...] = ()
    vertices: Array = field(default_factory=lambda: np.empty((0, 3)))
    faces: Index = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    rotation: Array = field(default_factory=lambda: np.eye(3))
    origin: Array = field(default_factory=lambda: np.zeros(3))
    made: dict[str, Any] = field(default_factory=dict, repr=False)

    def moved(self, rotation: Array, origin: Array) -> Shape:
        """The same shape, turned and then moved."""
        turned, there = rotation @ self.rotation, rotation @ self.origin + origin
        return replace(self, rotation=turned, origin=there)

    @cached_property
    def points(self) -> Array:
        """(k, 3) one of each part that hangs together, in its own frame; none of a half space.

        Of cells these are the middles of all.
        """
        if self.kind == "cells":
            return np.asarray(self.vertices + self.sizes[0] / 2)
        if self.kind in ("hull", "mesh"):
            return one_of_each_part(self.vertices, self.faces)
        return np.zeros((0 if self.kind == "half-space" else 1, 3))

    @cached_property
    def corners(self) -> Array:
        """(8, 3) of a box around a hull or a mesh: none of its points moves farther than these.

        The first one's neighbors along the edges have the numbers 1, 2 and 4.
        """
        to_box, extents = trimesh.bounds.oriented_bounds(self.vertices)
        signs = np.stack(np.meshgrid(*[(-0.5, 0.5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        from_box = np.linalg.inv(to_box)
        return np.asarray((signs * extents) @ from_box[:3, :3].T + from_box[:3, 3])

    @property
    def width(self) -> float:
        """The second of its three extents, m: of a plate not how thick it is."""
        if self.kind == "half-space":
            return np.inf
        if self.kind == "sphere":
            return 2 * self.sizes[0]
        extents: Sequence[float] = self.sizes
        if self.kind in ("cylinder", "cone", "capsule"):
            across = 2 * self.sizes[0]
            extents = (across, across, self.sizes[1] + (across if self.kind == "capsule" else 0.0))
        elif self.kind != "box":
            cell = self.sizes[0] if self.kind == "cells" else 0.0
            extents = (np.ptp(self.vertices, axis=0) + cell).tolist()
        return sorted(extents)[1]


def one_of_each_part(vertices: Array, faces: Index) -> Array:
    """A vertex (parts, 3) of each part of a mesh whose faces hang together."""
    part = grouped(len(vertices), np.concatenate([faces[:, :2], faces[:, 1:]]))
    used = np.unique(faces)
    return np.asarray(vertices[used[np.unique(part[used], return_index=True)[1]]])


def convex_hull(points: Array) -> Shape | None:
    """The convex hull of points (n, 3); None if they lie in a plane."""
    try:
        hull = ConvexHull(points)
    except (QhullError, ValueError):
        return None
    faces = hull.simplices.astype(np.int64)
    a, b, c = (points[faces[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    kept, faces = np.unique(faces, return_inverse=True)
    return Shape("hull", vertices=points[kept], faces=faces.reshape(-1, 3))
