"""A filled capsule as an obstacle."""

from __future__ import annotations

from typing import Literal

import fcl
import numpy as np
import trimesh

from cellcolor.arrays import Array
from cellcolor.frontend.contact.primitives import Primitive
from cellcolor.frontend.tables import Length

__all__ = ["CapsuleObstacle"]


class CapsuleObstacle(Primitive):
    """All within a radius of a piece of its own z axis, the middle of it on the position."""

    kind: Literal["capsule"] = "capsule"
    radius_m: Length
    axis_m: Length

    def _shape(self) -> fcl.CollisionGeometry:
        return fcl.Capsule(self.radius_m, self.axis_m)

    def _extents(self) -> tuple[float, float, float]:
        return (2 * self.radius_m, 2 * self.radius_m, self.axis_m + 2 * self.radius_m)

    def _outside(self, local: Array) -> Array:
        off = local.copy()
        off[:, 2] -= np.clip(local[:, 2], -self.axis_m / 2, self.axis_m / 2)
        return np.asarray(np.linalg.norm(off, axis=1)[:, None] - self.radius_m)

    def _mesh(self) -> trimesh.Trimesh:
        whole = trimesh.creation.capsule(self.axis_m, self.radius_m, count=[20, 20])
        whole.apply_translation(-whole.bounds.mean(axis=0))
        # Pictures sort triangles by depth, which goes wrong with long ones.
        return whole.subdivide_to_size(max(self.axis_m / 4, self.radius_m))
