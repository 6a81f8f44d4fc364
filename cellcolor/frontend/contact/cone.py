"""A filled cone as an obstacle."""

from __future__ import annotations

from typing import Literal

import fcl
import numpy as np
import trimesh

from cellcolor.arrays import Array
from cellcolor.frontend.contact.primitives import Primitive
from cellcolor.frontend.tables import Length

__all__ = ["ConeObstacle"]


class ConeObstacle(Primitive):
    """A solid cone about its own z axis, its point up; the middle of its height on the position."""

    kind: Literal["cone"] = "cone"
    radius_m: Length
    height_m: Length

    def _shape(self) -> fcl.CollisionGeometry:
        return fcl.Cone(self.radius_m, self.height_m)

    def _extents(self) -> tuple[float, float, float]:
        return (2 * self.radius_m, 2 * self.radius_m, self.height_m)

    def _outside(self, local: Array) -> Array:
        """Distances (k, 1) from the triangle that turns about the axis, 0 inside."""
        place = np.column_stack([np.hypot(local[:, 0], local[:, 1]), local[:, 2]])
        rim = np.array([self.radius_m, -self.height_m / 2])
        top = np.array([0.0, self.height_m / 2])
        slope = np.array([self.height_m, self.radius_m])  # out of the flank, not of length 1
        inside = (place[:, 1] >= rim[1]) & ((place - top) @ slope <= 0)
        to_base = place - np.column_stack(
            [np.minimum(place[:, 0], rim[0]), np.full(len(place), rim[1])]
        )
        way = np.clip((place - rim) @ (top - rim) / ((top - rim) @ (top - rim)), 0.0, 1.0)
        to_flank = place - (rim + way[:, None] * (top - rim))
        nearest = np.minimum(np.linalg.norm(to_base, axis=1), np.linalg.norm(to_flank, axis=1))
        return np.where(inside, 0.0, nearest)[:, None]

    def _mesh(self) -> trimesh.Trimesh:
        whole = trimesh.creation.cone(self.radius_m, self.height_m, sections=20)
        whole.apply_translation([0.0, 0.0, -self.height_m / 2])  # trimesh's stands on the origin
        # Pictures sort triangles by depth, which goes wrong with long ones.
        return whole.subdivide_to_size(max(self.height_m / 4, self.radius_m))
