"""The place of a thing in the world."""

from __future__ import annotations

from typing import Self

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.tables import Angles, Position, Table


class Placement(Table):
    """Pose of a thing in the world; angles extrinsic x, y, z."""

    position_m: Position
    rpy_rad: Angles = (0.0, 0.0, 0.0)

    def placed(self, points: Array) -> Array:
        """Points (n, 3) of the thing's own frame in the world, m."""
        turn = rotation_from_rpy(*self.rpy_rad)
        return np.asarray(points @ turn.T + np.array(self.position_m))

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
