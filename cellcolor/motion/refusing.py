"""Where the arm cannot touch a segment in its color, asked point by point and remembered."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.motion.small_triangles import JUMP, CornerStates, SmallTriangles
from cellcolor.tool_paths.refused import Codes


class ArmRefusals:
    """The tests of the cells in one branch, and places where a sample of a path has failed.

    Attributes:
        names: of the codes: those of the scene's judge, and one for a branch that jumps.
        doubtful: triangles of the surface with a sample that has failed.
    """

    def __init__(
        self,
        prepared: PreparedScene,
        branch: int,
        small: SmallTriangles,
        states: CornerStates,
        segment: int,
        around: float,
        deadline: Deadline,
    ) -> None:
        """What is known of the corners of the segment's small triangles is taken over.

        Args:
            around: so far from a sample that has failed everything is refused, m.
        """
        self._prepared, self._branch, self._deadline = prepared, branch, deadline
        self.names = (*prepared.judge.reason_names, JUMP)
        self.doubtful: set[int] = set()
        self._failed: list[tuple[Array, int]] = []
        self._around = around
        own = np.flatnonzero(small.segment == segment)
        corners = small.corners[own].ravel()
        rows = np.column_stack([small.points[corners], small.normals[corners]])
        codes = states.reasons[own].ravel().tolist()
        self._known = dict(zip(map(bytes, rows), codes, strict=True))
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
        failed = np.array([place for place, _ in self._failed])
        return np.asarray(failed[np.linalg.norm(failed - point, axis=1).argmin()])
