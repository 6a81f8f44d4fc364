"""Boxes, cylinders and spheres as obstacles; unlike meshes they are filled."""

from __future__ import annotations

from abc import abstractmethod
from pathlib import Path
from typing import Literal

import fcl
import numpy as np
import trimesh

from cellcolor.arrays import Array
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.contact.obstacle import Obstacle
from cellcolor.frontend.contact.solids import Solid
from cellcolor.frontend.parts.surface import Faces
from cellcolor.frontend.tables import Length

__all__ = ["BoxObstacle", "CylinderObstacle", "Primitive", "SphereObstacle"]


class Primitive(Obstacle):
    """A filled shape that is centered on its position."""

    @abstractmethod
    def _shape(self) -> fcl.CollisionGeometry:
        """The shape for fcl."""

    @abstractmethod
    def _extents(self) -> tuple[float, float, float]:
        """Sizes along its own x, y and z, m."""

    @abstractmethod
    def _outside(self, local: Array) -> Array:
        """How far points (k, 3) lie outside in each of j perpendicular directions, (k, j), m."""

    @abstractmethod
    def _mesh(self) -> trimesh.Trimesh:
        """The shape for pictures."""

    def shell(
        self,
        folder: Path = Path(),  # noqa: ARG002
        deadline: Deadline = NEVER,  # noqa: ARG002
    ) -> tuple[Array, Faces]:
        """The shape with its curved faces as many flat ones."""
        mesh = self._mesh()
        return np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64)

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Solid:  # noqa: ARG002
        """The filled shape."""

        def distances(points: Array) -> tuple[Array, Array]:
            distance = np.linalg.norm(np.maximum(self._outside(points), 0.0), axis=1)
            return distance, distance

        return Solid(self._shape(), sorted(self._extents())[1], distances).placed(self)


class BoxObstacle(Primitive):
    """A solid box, centered on its position."""

    kind: Literal["box"] = "box"
    size_m: tuple[Length, Length, Length]

    def _shape(self) -> fcl.CollisionGeometry:
        return fcl.Box(*self.size_m)

    def _extents(self) -> tuple[float, float, float]:
        return self.size_m

    def _outside(self, local: Array) -> Array:
        return np.asarray(np.abs(local) - np.array(self.size_m) / 2)

    def _mesh(self) -> trimesh.Trimesh:
        return trimesh.creation.box(self.size_m)


class CylinderObstacle(Primitive):
    """A solid cylinder about its own z axis, centered on its position."""

    kind: Literal["cylinder"] = "cylinder"
    radius_m: Length
    height_m: Length

    def _shape(self) -> fcl.CollisionGeometry:
        return fcl.Cylinder(self.radius_m, self.height_m)

    def _extents(self) -> tuple[float, float, float]:
        return (2 * self.radius_m, 2 * self.radius_m, self.height_m)

    def _outside(self, local: Array) -> Array:
        across = np.hypot(local[:, 0], local[:, 1]) - self.radius_m
        return np.column_stack([across, np.abs(local[:, 2]) - self.height_m / 2])

    def _mesh(self) -> trimesh.Trimesh:
        whole = trimesh.creation.cylinder(self.radius_m, self.height_m, sections=20)
        # Pictures sort triangles by depth, which goes wrong with long ones.
        return whole.subdivide_to_size(max(self.height_m / 4, self.radius_m))


class SphereObstacle(Primitive):
    """A solid sphere, centered on its position."""

    kind: Literal["sphere"] = "sphere"
    radius_m: Length

    def _shape(self) -> fcl.CollisionGeometry:
        return fcl.Sphere(self.radius_m)

    def _extents(self) -> tuple[float, float, float]:
        return (2 * self.radius_m,) * 3

    def _outside(self, local: Array) -> Array:
        return np.asarray(np.linalg.norm(local, axis=1)[:, None] - self.radius_m)

    def _mesh(self) -> trimesh.Trimesh:
        return trimesh.creation.icosphere(subdivisions=2, radius=self.radius_m)
