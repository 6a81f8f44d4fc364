"""The small triangles of a painted mesh, the arm at their corners, and where paths may not go.

A small triangle (``cellcolor.mesh.dividing``) belongs to the segment of its first corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.mesh.dividing import small_triangles, unit_everywhere
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.following import joint_space
from cellcolor.tool_paths.refused import Codes
from cellcolor.tool_paths.region import Segments

JUMP = "discontinuity"
"""The reason where configurations are valid and the branch jumps between them."""


@dataclass(frozen=True)
class CornerStates:
    """What the arm can do at the corners of small triangles, in the color of their segment.

    Attributes:
        whole: the painted mesh, of m triangles.
        fine: the 6 m small ones, on vertices, middles of edges and centroids; of each a vertex of
            the painted mesh comes first.
        normals: outward unit normals at the points of the fine mesh.
        side: (6 m,) the edge of the painted mesh that each touches.
        segment: (6 m,) -1 where the vertex has no color.
        joints: (6 m, 3, joints) in rad or m, those of the second and the third corner unwound
            from the first; NaN without solution or segment.
        reasons: (6 m, 3) codes of the judge: the first test that each corner fails.
        wound: (6 m,) whether the angles do not return after one turn: the branch jumps inside.
    """

    whole: TriangleMesh
    fine: TriangleMesh
    normals: Array
    side: Index
    segment: Index
    joints: Array
    reasons: NDArray[np.uint8]
    wound: Mask

    @property
    def bad(self) -> Mask:
        """(6 m,) the small triangles that are not valid all over."""
        return np.asarray(self.wound | (self.reasons != VALID).any(axis=1))


def corner_states(
    prepared: PreparedScene, segments: Segments, branch_of: Index, deadline: Deadline = NEVER
) -> CornerStates:
    """Configurations at all corners of the small triangles of a painted surface, judged.

    Args:
        branch_of: (segments,) the branch of each segment's color.
    """
    whole = segments.surface.mesh
    fine, side = small_triangles(whole)
    normals = unit_everywhere(whole, segments.normals)
    segment, count = segments.segment_of[fine.corners[:, 0]], len(fine.corners)
    own = np.flatnonzero(segment >= 0)
    branches = int(branch_of.max(initial=0)) + 1
    pairs = fine.corners[own] * branches + branch_of[segment[own]][:, None]
    asked, place = np.unique(pairs, return_inverse=True)
    corner, branch = asked // branches, asked % branches
    found = prepared.arm.follow(fine.points[corner], -normals[corner], branch.astype(np.intp))
    verdicts = prepared.judge(found, deadline)
    place = place.reshape(-1, 3)
    reasons = np.full((count, 3), VALID, dtype=np.uint8)
    reasons[own] = verdicts.reasons[place]
    one, two, three = found[place].swapaxes(0, 1)
    space = joint_space(prepared)
    out, across, back = space.step(one, two), space.step(two, three), space.step(three, one)
    wound = np.zeros(count, dtype=bool)
    wound[own] = (np.abs(space.periods(out + across + back)) > 0).any(axis=1)  # NaN is not
    joints = np.full((count, 3, found.shape[1]), np.nan)
    joints[own] = np.stack([one, one + out, one - back], axis=1)
    return CornerStates(whole, fine, normals, side, segment, joints, reasons, wound)


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
        fine, self._whole = states.fine, states.whole
        self._folded = _folded(states, touched) if prepared.robot.task.direction else []
        self.doubtful = set(self._folded)
        self._failed: list[tuple[Array, int]] = []
        self._around = around
        own = np.flatnonzero(states.segment == segment)
        corners = fine.corners[own].ravel()
        rows = np.column_stack([fine.points[corners], states.normals[corners]])
        codes = states.reasons[own].ravel().tolist()
        self._known = dict(zip(map(bytes, rows), codes, strict=True))
        for number in own[states.wound[own]].tolist():
            self.add(number // 6, fine.points[fine.corners[number]].mean(axis=0), JUMP)

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
        mesh, behind = self._whole, np.zeros(len(points), dtype=bool)
        for face in self._folded:
            facing, corner = mesh.triangle_normals[face], mesh.points[mesh.corners[face, 0]]
            near = (normals @ facing < _FACING) & (np.abs((points - corner) @ facing) < _INSIDE)
            rows = np.flatnonzero(near)
            shares = mesh.shares(np.full(len(rows), face), points[rows])
            behind[rows[(shares > -_INSIDE).all(axis=1)]] = True
        return behind


def _folded(states: CornerStates, touched: Mask) -> list[int]:
    """The triangles beside some vertices (n,) where the normal may lead behind them, ascending.

    No normal between those of the corners is farther from the triangle's own than the worst corner.
    """
    mesh = states.whole
    normals = states.normals[mesh.corners]
    behind = (np.einsum("mkj,mj->mk", normals, mesh.triangle_normals) < _FACING).any(axis=1)
    behind &= touched[mesh.corners].any(axis=1)
    return [int(face) for face in np.flatnonzero(behind)]
