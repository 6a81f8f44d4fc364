"""Continuation along mesh edges by Newton's method on Pinocchio's Jacobian.

It knows no branches and no inverse kinematics: from the configuration at one end it follows the
tool's pose, at 400 points and at as many in between as it needs to lose no solution.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin
from independent import wrapped
from reasons import Reason

from cellcolor.arrays import Array
from cellcolor.frontend import BuildResult
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.prepared import PreparedScene

POINTS = 400
SMALL = 0.05  # rad; larger steps are halved
DEEPEST = 30  # times


class Follower:
    """Differential kinematics of one robot."""

    def __init__(self, robot: Robot) -> None:
        self._model, self._data = robot.model, robot.model.createData()
        self._tip = robot.model.getFrameId("tool_tip")

    def corrected(self, q: Array, point: Array, axis: Array) -> Array | None:
        """The solution near a configuration for a tip position and tool axis, if one is found."""
        q = q.copy()
        for _ in range(8):
            jacobian = pin.computeFrameJacobian(
                self._model, self._data, q, self._tip, pin.ReferenceFrame.LOCAL
            )
            pin.framesForwardKinematics(self._model, self._data, q)
            pose = self._data.oMf[self._tip]
            gap = pose.rotation.T @ (point - pose.translation)
            turn = np.cross([0.0, 0.0, 1.0], pose.rotation.T @ axis)
            error = np.concatenate([gap, turn[:2]])
            if np.linalg.norm(error) < 1e-11 and (pose.rotation.T @ axis)[2] > 0:
                return q
            try:
                q[:5] += np.linalg.solve(jacobian[:5, :5], error)
            except np.linalg.LinAlgError:
                return None
        return None

    def along(self, start: Array, points: Array, normals: Array) -> Array | None:
        """Configurations (400, 6) from ``start`` along an edge; None when the motion is lost.

        Args:
            points, normals: (2, 3) at the ends of the edge.
        """

        def pose(t: float) -> tuple[Array, Array]:
            normal = (1 - t) * normals[0] + t * normals[1]
            return (1 - t) * points[0] + t * points[1], -normal / np.linalg.norm(normal)

        q, at, path = start, 0.0, [start]
        for goal in np.linspace(0, 1, POINTS)[1:]:
            halved = 0
            while at < goal:
                step = (goal - at) / 2**halved
                next_at = goal if halved == 0 else at + step
                found = self.corrected(q, *pose(next_at))
                if found is None or np.abs(found - q).max() > SMALL:
                    halved += 1
                    if halved > DEEPEST:
                        return None
                    continue
                q, at, halved = found, next_at, max(halved - 1, 0)
            path.append(q)
        return np.array(path)


def unlinked_pairs(result: BuildResult) -> Array:
    """(k, 3) vertices i < j and branch: valid at both ends of a mesh edge, and not linked.

    Of a surface that was built without a sliver policy.
    """
    faces = result.surface.faces
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    torn = {(c.i, c.j, color) for c in result.surface.cracks for color in c.colors}
    pairs = []
    for i, j in np.unique(np.sort(sides, axis=1), axis=0).tolist():
        both = (result.reasons[i] == Reason.VALID) & (result.reasons[j] == Reason.VALID)
        for branch in np.flatnonzero(both).tolist():
            first, second = result.node_color[[i, j], branch].tolist()
            if first != second or (i, j, first) in torn:
                pairs.append((i, j, branch))
    return np.array(pairs, dtype=np.int64).reshape(-1, 3)


def smooth_and_valid(prepared: PreparedScene, result: BuildResult, pair: Array) -> bool:
    """Whether an independent motion joins a pair's configurations, valid at all its points."""
    i, j, branch = pair.tolist()
    ends = [i, j]
    path = Follower(prepared.robot).along(
        result.configurations[i, branch],
        prepared.surface.vertices[ends],
        prepared.surface.normals[ends],
    )
    if path is None or wrapped(path[-1] - result.configurations[j, branch]).max() > 1e-6:
        return False
    return bool((prepared.judge(path).reasons == Reason.VALID).all())
