"""Boxes, cylinders, cones, capsules and spheres as obstacles; unlike meshes they are solid."""

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


class CapsuleObstacle(Primitive):
    """All points within a radius of a piece of its own z axis, centered on the position."""

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
