"""The small triangles of a painted mesh, and what the arm can do at their corners.

A small triangle (``cellcolor.mesh.dividing``) belongs to the segment of its first corner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import LeftOut
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.mesh.dividing import small_areas, small_triangles, unit_everywhere
from cellcolor.mesh.triangle_mesh import TriangleMesh
from cellcolor.motion.following import joint_space
from cellcolor.union_find import UnionFind

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
        """Those of a mesh with outward unit normals (n, 3) and the segment (n,) of each vertex."""
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
        reasons: (6 m,) codes of the judge: the first test that a corner fails.
        space: of the joints.
        wound: (6 m,) whether the angles do not return after one turn: the branch jumps inside.
    """

    joints: Array
    reasons: NDArray[np.uint8]
    space: JointSpace
    wound: Mask

    def bad(self, names: tuple[str, ...]) -> dict[int, str]:
        """The small triangles that no path may enter, and why; ``names`` are those of the codes."""
        found = {int(at): JUMP for at in np.flatnonzero(self.wound)}
        failed = np.flatnonzero(self.reasons != VALID)
        return found | {int(at): names[self.reasons[at]] for at in failed}


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
    at_corners, failed = found[place], verdicts.reasons[place]
    reasons = np.zeros(len(small.corners), dtype=np.uint8)
    first = np.argmax(failed != VALID, axis=1)  # 0, which is valid then, if none has failed
    reasons[own] = failed[np.arange(len(own)), first]
    one, two, three = at_corners.swapaxes(0, 1)
    space = joint_space(prepared)
    out, across, back = space.step(one, two), space.step(two, three), space.step(three, one)
    wound = np.zeros(len(small.corners), dtype=bool)
    wound[own] = (np.abs(space.periods(out + across + back)) > 0).any(axis=1)  # NaN is not
    joints = np.full((len(small.corners), 3, found.shape[1]), np.nan)
    joints[own] = np.stack([one, one + out, one - back], axis=1)
    return CornerStates(joints, reasons, space, wound)


def left_out_parts(small: SmallTriangles, reasons: dict[int, str]) -> tuple[LeftOut, ...]:
    """What is left out, as connected parts with one reason each; large ones first.

    Args:
        reasons: of each small triangle that is left out.
    """
    together: UnionFind[int] = UnionFind()
    at_corner: dict[tuple[int, int, str], int] = {}
    for number, reason in reasons.items():
        for corner in small.corners[number].tolist():
            key = (corner, int(small.segment[number]), reason)
            together.union(number, at_corner.setdefault(key, number))
    parts = []
    for group in together.sets():
        members = sorted(group)
        areas = small.areas[members]
        largest = members[int(np.argmax(areas))]
        x, y, z = small.points[small.corners[largest]].mean(axis=0).tolist()
        segment, reason = int(small.segment[largest]), reasons[largest]
        parts.append(LeftOut(segment, float(areas.sum()), reason, (x, y, z)))
    return tuple(sorted(parts, key=lambda part: (-part.area_m2, part.segment, part.place)))
