"""A half space: everything below a plane, which may be tilted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array


@dataclass(frozen=True)
class HalfSpace:
    """All points p of the world with ``normal @ p`` below an offset.

    Attributes:
        normal: (3,) a unit vector, out of the half space.
        offset_m: of the plane along the normal, from the world's origin, m.
    """

    normal: tuple[float, float, float]
    offset_m: float

    @classmethod
    def through(cls, point: Array, normal: Array) -> HalfSpace:
        """The half space whose plane passes through a point (3,), with a normal of any length."""
        x, y, z = (normal / np.linalg.norm(normal)).tolist()
        return cls((x, y, z), float(np.array([x, y, z]) @ point))

    def along(self, vectors: Array) -> Array:
        """How far points or vectors (..., 3) go along the normal, (...), m."""
        return np.asarray(vectors @ np.array(self.normal))
