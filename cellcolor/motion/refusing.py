"""Where the arm cannot touch a segment in its color, asked point by point and remembered."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.small_triangles import JUMP, CornerStates, SmallTriangles
from cellcolor.tool_paths.refused import Codes

FOLDED = "folded"
"""The reason where the normal leads behind the surface's own triangle, as on a sharp fold."""
_NEAR = 12  # nearest small triangles among which the one under a point is sought
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
        self._apart = 5 * around
        self._small, self._states = small, states
        self._inside: tuple[cKDTree, TriangleMesh, Array] | None = None
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
        codes[(codes == 0) & self._beyond(points, normals)] = self.names.index("joint limits")
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
        if any(test(point[None], normal[None])[0] for test in (self._behind, self._beyond)):
            return point
        failed = np.array([place for place, _ in self._failed])
        return np.asarray(failed[np.linalg.norm(failed - point, axis=1).argmin()])

    def keep_inside(self, part_of: Index, turns: Index) -> None:
        """Refuse points at which the arm, continued over its small triangle, is beyond its limits.

        Args:
            part_of: (6 m,) the part of each small triangle, or -1.
            turns: (p, joints) how many full circles to add to each joint in each part.
        """
        own = np.flatnonzero(part_of >= 0)
        joints = self._states.joints[own]
        joints = np.where(np.isfinite(joints), joints, joints[:, :1]).mean(axis=1)
        positions = joints + self._states.space.period * turns[part_of[own]]
        corners = self._small.corners[own]
        normals = self._small.normals[corners].mean(axis=1)
        tree = cKDTree(self._keys(self._small.points[corners].mean(axis=1), normals))
        self._inside = tree, TriangleMesh(self._small.points, corners), positions

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

    def _beyond(self, points: Array, normals: Array) -> Mask:
        """Which points (k, 3) :meth:`keep_inside` refuses."""
        if self._inside is None:
            return np.zeros(len(points), dtype=bool)
        tree, mesh, positions = self._inside
        near = tree.query(self._keys(points, normals), k=min(_NEAR, len(positions)))[1].reshape(
            len(points), -1
        )
        shares = mesh.shares(near.ravel(), np.repeat(points, near.shape[1], axis=0))
        lowest = shares.min(axis=1).reshape(near.shape)
        before = positions[np.take_along_axis(near, lowest.argmax(axis=1)[:, None], axis=1)[:, 0]]
        branches = np.full(len(points), self._branch, dtype=np.intp)
        space = self._states.space
        found = before + space.step(before, self._prepared.arm.follow(points, -normals, branches))
        return np.asarray(((found < space.lower) | (found > space.upper)).any(axis=1))

    def _keys(self, points: Array, normals: Array) -> Array:
        """Keys (k, 6) for nearest neighbors, which keep the two sides of a thin part apart."""
        return np.column_stack([points, self._apart * normals])


def _folded(small: SmallTriangles, touched: Mask) -> list[int]:
    """The triangles beside some vertices (n,) where the normal may lead behind them, ascending.

    No normal between those of the corners is farther from the triangle's own than the worst corner.
    """
    mesh = small.whole
    normals = small.normals[mesh.corners]
    behind = (np.einsum("mkj,mj->mk", normals, mesh.triangle_normals) < _FACING).any(axis=1)
    behind &= touched[mesh.corners].any(axis=1)
    return [int(face) for face in np.flatnonzero(behind)]
