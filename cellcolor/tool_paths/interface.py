"""What a pattern is: it lays a path on a part of a segment."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import Deadline
from cellcolor.tool_paths.triangles import Triangles

_STRAIGHT = 1e-8  # m; a point this near to the straight way past it is left out
_NEAR_BORDER = 0.001  # m; as far as samples are apart


@dataclass(frozen=True, eq=False)
class Laid:
    """A path on a mesh.

    Attributes:
        mesh: a mesh made by cutting the triangles of the one that was to be covered.
        walk: its vertices along the path, each the neighbor of the one before, none on the mesh's
            border; empty if the part is too narrow for the pattern.
    """

    mesh: Triangles
    walk: list[int]

    @property
    def points(self) -> Array:
        """(k, 3) of the walk, m."""
        return self.mesh.points[self.walk]

    @property
    def normals(self) -> Array:
        """(k, 3) outward unit normals at these points."""
        return self.mesh.normals[self.walk]

    def path(self, segment: int, color: int) -> tuple[ToolPath, Index]:
        """The path in the world, without points on a straight way past them in one triangle.

        Returns:
            The path, and the numbers of its points near a border, beside which a chord would cut
            a corner.
        """
        mesh, walk, points = self.mesh, np.array(self.walk, dtype=np.int64), self.points
        triangle = np.empty(len(mesh.edges), dtype=np.int64)
        triangle[mesh.edge_of_side] = np.arange(len(mesh.corners))[:, None]
        faces = mesh.faces[triangle[mesh.find(np.stack([walk[:-1], walk[1:]], axis=1))]]
        needed = np.ones(len(walk), dtype=bool)
        steps = np.diff(points, axis=0)
        before, after = steps[:-1], steps[1:]
        off = np.linalg.norm(np.cross(before, after), axis=1)
        straight = off <= _STRAIGHT * np.linalg.norm(before + after, axis=1)
        straight &= (before * after).sum(axis=1) > 0
        needed[1:-1] = (faces[1:] != faces[:-1]) | ~straight
        near = np.zeros(len(walk), dtype=bool)
        if mesh.border.any():
            near = mesh.from_border[walk] < _NEAR_BORDER
        path = ToolPath(segment, color, points[needed], self.normals[needed], faces[needed[:-1]])
        return path, np.flatnonzero(near[needed])


Pattern = Callable[[Triangles, float, Deadline], Laid]
"""Lays a path on a connected part of a segment, given the wanted spacing between passes in m and a
deadline, which it looks at."""
