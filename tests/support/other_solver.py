"""Inverse kinematics by ssik, which shares no code with the product: all solutions of a pose."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
from independent import wrapped

from cellcolor.arrays import Array
from cellcolor.frontend.arm.robot import Robot

ssik = pytest.importorskip("ssik")


class Ssik:
    """ssik's arm from Pinocchio's joint axes at zero."""

    def __init__(self, robot: Robot) -> None:
        data = robot.model.createData()
        jacobian = pin.computeJointJacobians(robot.model, data, np.zeros(6))
        origins = np.array([data.oMi[i].translation for i in range(1, 7)])
        steps = np.diff(origins, axis=0, prepend=np.zeros((1, 3)))
        self._arm = ssik.Manipulator.from_axes(jacobian[3:].T, np.vstack([steps, np.zeros((1, 3))]))
        self._at_zero, self._tip = data.oMi[6].rotation, robot.tip

    def solutions(self, point: Array, direction: Array, roll: float) -> Array:
        """Joints 1 to 5 (s, 5) of all solutions, each once; any roll must give the same."""
        x = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
        x /= np.linalg.norm(x)
        x = np.cos(roll) * x + np.sin(roll) * np.cross(direction, x)
        return _once(self.whole_solutions(point, direction, x)[:, :5])

    def whole_solutions(self, point: Array, direction: Array, x: Array) -> Array:
        """All joints (s, 6) of all solutions with the tool's z and x axis so, each once."""
        turned = np.column_stack([x, np.cross(direction, x), direction]) @ self._tip[:3, :3].T
        pose = np.eye(4)
        pose[:3, :3] = turned @ self._at_zero.T
        pose[:3, 3] = point - turned @ self._tip[:3, 3]
        found = self._arm.solve(pose, respect_limits=False, enumerate_windings=False)
        return _once(np.array([np.asarray(each.q) for each in found]).reshape(-1, 6))


def _once(solutions: Array) -> Array:
    """Solutions (s, joints) modulo full circles, each once."""
    kept: list[Array] = []
    for q in solutions:
        if all(wrapped(q - other).max() > 1e-6 for other in kept):
            kept.append(q)
    return np.array(kept).reshape(-1, solutions.shape[1])
