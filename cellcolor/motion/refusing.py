"""Where the arm cannot touch a segment in its color, asked point by point and remembered."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.motion.small_triangles import JUMP, CornerStates, SmallTriangles
from cellcolor.tool_paths.refused import Codes

FOLDED = "folded"
"""The reason where the normal leads behind the surface's own triangle, as on a sharp fold."""
_FACING = float(np.cos(np.radians(85.0)))  # of normal to triangle; the judge allows 90 degrees
_INSIDE = 1e-9  # m, and in shares of a triangle


class ArmRefusals:
    """The tests of the arm in one branch, and places where a sample of a path has failed.

    Attributes:
        names: of the codes: those of the scene's judge, one for a branch that jumps, and one for a
            normal that leads behind the surface.
        doubtful: triangles of the surface with a sample that has failed.
    """

    def __init__(
        self,
        prepared: PreparedScene,
        branch: int,
        states: CornerStates,
        segment: int,
        touched: Mask,
        around: float,
        deadline: Deadline,
    ) -> None:
        """Begin with the known results at the corners of the segment's small triangles.

        Args:
            touched: (n,) the vertices of the surface that paths may come near to.
            around: everything this near to a sample that has failed is refused, m.
        """
        self._prepared, self._branch, self._deadline = prepared, branch, deadline
        self.names = (*prepared.judge.reason_names, JUMP, FOLDED)
        small = states.small
        self._folded = _folded(small, touched) if prepared.robot.task.direction else []
        self.doubtful = set(self._folded)
        self._failed: list[tuple[Array, int]] = []
        self._around = around
        own = np.flatnonzero(small.segment == segment)
        corners = small.corners[own].ravel()
        rows = np.column_stack([small.points[corners], small.normals[corners]])
        codes = states.reasons[own].ravel().tolist()
        self._known = dict(zip(map(bytes, rows), codes, strict=True))
        self._small = small
        for number in own[states.wound[own]].tolist():
            self.add(number // 6, small.points[small.corners[number]].mean(axis=0), JUMP)

    def add(self, face: int, point: Array, why: str) -> None:
        """A sample (3,) in a triangle of the surface that has failed."""
        self.doubtful.add(face)
        self._failed.append((point, self.names.index(why)))

    def __call__(self, points: Array, normals: Array) -> Codes:
        """The first test that fails at each point (k, 3), with unit normals (k, 3)."""
        keys = [bytes(row) for row in np.column_stack([points, normals])]
        asked = np.array([k for k, key in enumerate(keys) if key not in self._known], dtype=int)
        if len(asked):
            branches = np.full(len(asked), self._branch, dtype=np.intp)
            found = self._prepared.arm.follow(points[asked], -normals[asked], branches)
            verdicts = self._prepared.judge(found, self._deadline).reasons
            self._known.update(zip((keys[k] for k in asked), verdicts.tolist(), strict=True))
        codes = np.array([self._known[key] for key in keys], dtype=np.uint8)
        codes[(codes == 0) & self._behind(points, normals)] = self.names.index(FOLDED)
        if self._failed:
            failed = np.array([point for point, _ in self._failed])
            apart, nearest = cKDTree(failed).query(points)
            near = (apart <= self._around) & (codes == 0)
            codes[near] = np.array([code for _, code in self._failed])[nearest[near]]
        return codes

    def tested(self, point: Array, normal: Array) -> Array:
        """The point (3,) itself if its own test fails, otherwise the failed sample nearest."""
        if not self._failed or self._known.get(bytes(np.append(point, normal))):
            return point
        if self._behind(point[None], normal[None])[0]:
            return point
        failed = np.array([place for place, _ in self._failed])
        return np.asarray(failed[np.linalg.norm(failed - point, axis=1).argmin()])

    def _behind(self, points: Array, normals: Array) -> Mask:
        """At which points (k, 3) the tool would come from behind the triangle that it touches."""
        mesh, behind = self._small.whole, np.zeros(len(points), dtype=bool)
        for face in self._folded:
            facing, corner = mesh.triangle_normals[face], mesh.points[mesh.corners[face, 0]]
            near = (normals @ facing < _FACING) & (np.abs((points - corner) @ facing) < _INSIDE)
            rows = np.flatnonzero(near)
            shares = mesh.shares(np.full(len(rows), face), points[rows])
            behind[rows[(shares > -_INSIDE).all(axis=1)]] = True
        return behind


def _folded(small: SmallTriangles, touched: Mask) -> list[int]:
    """The triangles beside some vertices (n,) where the normal may lead behind them, ascending.

    No normal between those of the corners is farther from the triangle's own than the worst corner.
    """
    mesh = small.whole
    normals = small.normals[mesh.corners]
    behind = (np.einsum("mkj,mj->mk", normals, mesh.triangle_normals) < _FACING).any(axis=1)
    behind &= touched[mesh.corners].any(axis=1)
    return [int(face) for face in np.flatnonzero(behind)]
