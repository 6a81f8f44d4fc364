"""Where a thing stands in the world."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array
from cellcolor.frontend.tables import Angles, Position, Table

__all__ = ["Placement", "rotation_from_rpy"]


class Placement(Table):
    """Pose of a thing in the world; angles extrinsic x, y, z."""

    position_m: Position
    rpy_rad: Angles = (0.0, 0.0, 0.0)

    def placed(self, points: Array) -> Array:
        """Points (n, 3) of the thing's own frame in the world, m."""
        turn = rotation_from_rpy(*self.rpy_rad)
        return np.asarray(points @ turn.T + np.array(self.position_m))


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
