"""The place of a thing in the world, and how far it may be off."""

from __future__ import annotations

from typing import Annotated, Self

import numpy as np
from pydantic import Field, FiniteFloat, model_validator
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array, unit
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.tables import Angles, Position, Table


class Placement(Table):
    """Pose of a thing in the world; angles extrinsic x, y, z."""

    position_m: Position
    rpy_rad: Angles = (0.0, 0.0, 0.0)

    @property
    def matrix(self) -> Array:
        """(4, 4) from the thing's own frame to the world."""
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = rotation_from_rpy(*self.rpy_rad), self.position_m
        return pose

    def placed(self, points: Array) -> Array:
        """Points (n, 3) of the thing's own frame in the world, m."""
        turn = rotation_from_rpy(*self.rpy_rad)
        return np.asarray(points @ turn.T + np.array(self.position_m))

    def standing(self, shape: Shape) -> Shape:
        """A shape of the thing's own frame in the world."""
        return shape.moved(rotation_from_rpy(*self.rpy_rad), np.array(self.position_m))

    def seen_from(self, frame: Placement) -> Self:
        """The same place in a frame that stands in the world itself."""
        turn = rotation_from_rpy(*frame.rpy_rad)
        position = (np.array(self.position_m) - np.array(frame.position_m)) @ turn
        rotation = turn.T @ rotation_from_rpy(*self.rpy_rad)
        return self.varied(position_m=tuple(position.tolist()), rpy_rad=rpy_from_rotation(rotation))


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation matrix of extrinsic x, y, z angles, as in URDF."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def rpy_from_rotation(rotation: Array) -> tuple[float, float, float]:
    """Extrinsic x, y, z angles in rad of a rotation matrix (3, 3)."""
    pitch = np.arcsin(np.clip(-rotation[2, 0], -1, 1))
    if abs(rotation[2, 0]) < 1 - 1e-12:
        roll = np.arctan2(rotation[2, 1], rotation[2, 2])
        yaw = np.arctan2(rotation[1, 0], rotation[0, 0])
    else:  # only one of the two is determined
        roll, yaw = 0.0, np.arctan2(-rotation[0, 1], rotation[1, 1])
    return float(roll), float(pitch), float(yaw)


_SEED = 0


class Tolerance(Table):
    """How far a part may be off.

    Attributes:
        position_m: its center may be off so far, in any direction, m.
        rotation_rad: it may be turned so far, about any axis through its center, rad.
        samples: how many displacements are tested.
    """

    position_m: Annotated[FiniteFloat, Field(ge=0, le=1)] = 0.0
    rotation_rad: Annotated[FiniteFloat, Field(ge=0, le=np.pi)] = 0.0
    samples: Annotated[int, Field(ge=1, le=1000)] = 16

    @model_validator(mode="after")
    def _something(self) -> Tolerance:
        if not self.position_m and not self.rotation_rad:
            raise ValueError("needs position_m or rotation_rad above 0")
        return self

    def displaced(self, placement: Placement, center: Array) -> list[Placement]:
        """A sample of placements, always the same, all with the largest displacement and turn.

        Directions and axes are opposite in pairs, so that no side is favored. The part's center
        (3,) is in the world, m.
        """
        rng, found = np.random.default_rng(_SEED), []
        own = rotation_from_rpy(*placement.rpy_rad)
        for number in range(self.samples):
            if number % 2 == 0:
                shift, axis = (unit(rng.standard_normal(3)) for _ in range(2))
            else:
                shift, axis = -shift, -axis
            rotation = Rotation.from_rotvec(self.rotation_rad * axis).as_matrix()
            position = rotation @ (np.array(placement.position_m) - center) + center
            position += self.position_m * shift
            found.append(
                Placement(
                    position_m=tuple(position.tolist()), rpy_rad=rpy_from_rotation(rotation @ own)
                )
            )
        return found
