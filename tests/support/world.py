"""Collisions once more, by coal on Pinocchio's own shapes: one configuration at a time.

One obstacle of each kind in the way of an arm, and the same in coal.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin
from pinocchio_reading import geometry_of

from cellcolor.arrays import Array
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.obstacle import (
    BoxGridObstacle,
    BoxObstacle,
    CapsuleObstacle,
    ConeObstacle,
    CylinderObstacle,
    HalfSpaceObstacle,
    Obstacle,
)
from cellcolor.frontend.parts.placement import rotation_from_rpy


class World:
    """Signed distances (m, negative inside) between the arm and what is around it."""

    def __init__(self, robot: Robot, vertices: Array, faces: Array) -> None:
        self.model, self.geometry = robot.model, geometry_of(robot)
        self.data = self.model.createData()
        self.geometry_data = self.geometry.createData()
        self.object = coal.BVHModelOBBRSS()
        self.object.beginModel(len(faces), len(vertices))
        self.object.addVertices(vertices)
        self.object.addTriangles(faces.astype(np.int32))
        self.object.endModel()
        shapes = self.geometry.geometryObjects
        self.link = [self.model.frames[shape.parentFrame].name for shape in shapes]

    def place(self, q: Array) -> None:
        """Put the arm into a configuration."""
        pin.updateGeometryPlacements(self.model, self.data, self.geometry, self.geometry_data, q)

    def to_itself(self, pairs: set[frozenset[str]]) -> float:
        """Smallest distance between shapes of the given pairs of links."""
        return min(
            self._between(i, j)
            for i in range(len(self.link))
            for j in range(i)
            if frozenset((self.link[i], self.link[j])) in pairs
        )

    def to_object(self) -> float:
        """Smallest distance of a moving shape to the mesh; 0 when it touches."""
        return self.to_solid(self.object, coal.Transform3s())

    def to_solid(self, solid: coal.CollisionGeometry, pose: coal.Transform3s) -> float:
        """Smallest distance of a moving shape to something that stands still."""
        return min(
            self._distance(solid, pose, i)
            for i in range(len(self.link))
            if self.link[i] != "base_link"
        )

    def to_ground(
        self,
        height: float,
        exempt: tuple[str, ...],
        normal: tuple[float, float, float] = (0.0, 0.0, 1.0),
    ) -> float:
        """Smallest distance of a shape to the half space below a height, perhaps tilted."""
        ground = coal.Halfspace(np.array(normal) / np.linalg.norm(normal), 0.0)
        return min(
            self._distance(ground, coal.Transform3s(np.eye(3), np.array([0.0, 0.0, height])), i)
            for i in range(len(self.link))
            if self.link[i] not in exempt
        )

    def _pose(self, shape: int) -> coal.Transform3s:
        placement = self.geometry_data.oMg[shape]
        return coal.Transform3s(placement.rotation, placement.translation)

    def _between(self, i: int, j: int) -> float:
        return self._distance(self.geometry.geometryObjects[i].geometry, self._pose(i), j)

    def _distance(self, other: coal.CollisionGeometry, pose: coal.Transform3s, i: int) -> float:
        shape = self.geometry.geometryObjects[i].geometry
        request, result = coal.DistanceRequest(), coal.DistanceResult()
        return float(coal.distance(other, pose, shape, self._pose(i), request, result))


# The pairs that share a joint, or are fixed to each other, written out by hand.
NEIGHBORS = [
    {"base_link", "shoulder_link"},
    {"shoulder_link", "upper_arm_link"},
    {"upper_arm_link", "forearm_link"},
    {"forearm_link", "wrist_1_link"},
    {"wrist_1_link", "wrist_2_link"},
    {"wrist_2_link", "wrist_3_link"},
    {"wrist_3_link", "tool_body"},
]
LINKS = sorted(set().union(*NEIGHBORS))
PAIRS = {frozenset((a, b)) for a in LINKS for b in LINKS if a < b and {a, b} not in NEIGHBORS}


KINDS = ("cone", "capsule", "half-space", "box-grid")


def in_coal(
    obstacle: Obstacle, cells: Sequence[tuple[int, ...]] = ()
) -> list[tuple[coal.ShapeBase, coal.Transform3s]]:
    """Coal's shapes of an obstacle and where they stand; a grid has these cells."""
    turn, place = rotation_from_rpy(*obstacle.rpy_rad), np.array(obstacle.position_m)
    if isinstance(obstacle, BoxGridObstacle):
        box = coal.Box(*[obstacle.cell_m] * 3)
        middles = [place + turn @ (np.add(cell, 0.5) * obstacle.cell_m) for cell in cells]
        return [(box, coal.Transform3s(turn, middle)) for middle in middles]
    if isinstance(obstacle, BoxObstacle):
        shape = coal.Box(*obstacle.size_m)
    elif isinstance(obstacle, ConeObstacle):
        shape = coal.Cone(obstacle.radius_m, obstacle.height_m)
    elif isinstance(obstacle, CapsuleObstacle):
        shape = coal.Capsule(obstacle.radius_m, obstacle.axis_m)
    elif isinstance(obstacle, CylinderObstacle):
        shape = coal.Cylinder(obstacle.radius_m, obstacle.height_m)
    else:
        assert isinstance(obstacle, HalfSpaceObstacle)
        shape = coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0)
    return [(shape, coal.Transform3s(turn, place))]


def standing(
    kind: str, place: Array, folder: Path
) -> tuple[Obstacle, list[tuple[coal.ShapeBase, coal.Transform3s]]]:
    """An obstacle about a place (3,), and coal's shapes and where they stand.

    Args:
        folder: for the file of a grid, and what its name is relative to.
    """
    where = {"position_m": tuple(place.tolist()), "rpy_rad": (0.3, -0.4, 0.5)}
    cells = [(i, j, k) for i in range(4) for j in range(3) for k in range(2) if i + j + k != 2]
    if kind == "cone":
        obstacle: Obstacle = ConeObstacle(radius_m=0.1, height_m=0.2, **where)
    elif kind == "capsule":
        obstacle = CapsuleObstacle(radius_m=0.04, axis_m=0.2, **where)
    elif kind == "half-space":
        obstacle = HalfSpaceObstacle(**where | {"rpy_rad": (0.0, -1.4, 0.0)})
    else:
        (folder / "map.csv").write_text("\n".join(",".join(map(str, cell)) for cell in cells))
        obstacle = BoxGridObstacle(file=str(folder / "map.csv"), cell_m=0.05, **where)
    return obstacle, in_coal(obstacle, cells)
