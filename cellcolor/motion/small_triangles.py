"""The small triangles of a painted mesh, and what the arm can do at their corners.

A small triangle (``cellcolor.mesh.dividing``) belongs to the segment of its first corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.mesh.dividing import small_areas, small_triangles, unit_everywhere
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.following import joint_space

JUMP = "discontinuity"
"""The reason where configurations are valid and the branch jumps between them."""


@dataclass(frozen=True)
class SmallTriangles:
    """The small triangles of a painted mesh of k edges and m triangles.

    Attributes:
        whole: the painted mesh.
        points: (p, 3) vertices, middles of edges, centroids, m.
        normals: (p, 3) outward unit normals there.
        corners: (6 m, 3) which points each small triangle has; the mesh's vertex first.
        side: (6 m,) the edge of the mesh that it touches.
        segment: (6 m,) -1 where the vertex has no color.
        areas: (6 m,) m^2.
    """

    whole: TriangleMesh
    points: Array
    normals: Array
    corners: Index
    side: Index
    segment: Index
    areas: Array

    @classmethod
    def of(cls, whole: TriangleMesh, normals: Array, segment_of: Index) -> SmallTriangles:
        """Those of a mesh with outward normals (n, 3) and the segment (n,) of each vertex."""
        fine, side = small_triangles(whole)
        return cls(
            whole,
            fine.points,
            unit_everywhere(whole, normals),
            fine.corners,
            side,
            segment_of[fine.corners[:, 0]],
            small_areas(whole),
        )


@dataclass(frozen=True)
class CornerStates:
    """What the arm can do at the corners of small triangles, in the color of their segment.

    Attributes:
        joints: (6 m, 3, joints) in rad or m, those of the second and the third corner unwound
            from the first; NaN without solution or segment.
        reasons: (6 m, 3) codes of the judge: the first test that each corner fails.
        space: of the joints.
        wound: (6 m,) whether the angles do not return after one turn: the branch jumps inside.
    """

    joints: Array
    reasons: NDArray[np.uint8]
    space: JointSpace
    wound: Mask

    @property
    def bad(self) -> Mask:
        """(6 m,) the small triangles that are not valid all over."""
        return np.asarray(self.wound | (self.reasons != VALID).any(axis=1))


def corner_states(
    prepared: PreparedScene, small: SmallTriangles, branch_of: Index, deadline: Deadline = NEVER
) -> CornerStates:
    """Configurations at all corners of small triangles, judged.

    Args:
        branch_of: (segments,) the branch of each segment's color.

    Raises:
        OutOfTime: the deadline came first.
    """
    own = np.flatnonzero(small.segment >= 0)
    branches = int(branch_of.max(initial=0)) + 1
    pairs = small.corners[own] * branches + branch_of[small.segment[own]][:, None]
    asked, place = np.unique(pairs, return_inverse=True)
    corner, branch = asked // branches, asked % branches
    found = prepared.arm.follow(
        small.points[corner], -small.normals[corner], branch.astype(np.intp)
    )
    verdicts = prepared.judge(found, deadline)
    place = place.reshape(-1, 3)
    at_corners = found[place]
    reasons = np.full((len(small.corners), 3), VALID, dtype=np.uint8)
    reasons[own] = verdicts.reasons[place]
    one, two, three = at_corners.swapaxes(0, 1)
    space = joint_space(prepared)
    out, across, back = space.step(one, two), space.step(two, three), space.step(three, one)
    wound = np.zeros(len(small.corners), dtype=bool)
    wound[own] = (np.abs(space.periods(out + across + back)) > 0).any(axis=1)  # NaN is not
    joints = np.full((len(small.corners), 3, found.shape[1]), np.nan)
    joints[own] = np.stack([one, one + out, one - back], axis=1)
    return CornerStates(joints, reasons, space, wound)
