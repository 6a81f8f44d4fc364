"""A half space as an obstacle: a wall, a ceiling, a bench without end."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import fcl
import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.kinematics import Poses
from cellcolor.frontend.contact.fcl_bodies import body_poses, lowest_points
from cellcolor.frontend.contact.obstacle import Obstacle
from cellcolor.frontend.contact.plane import HalfSpace
from cellcolor.frontend.contact.solids import Distances, Solid
from cellcolor.frontend.parts.placement import rotation_from_rpy
from cellcolor.frontend.parts.shapes import grid_mesh
from cellcolor.frontend.parts.surface import Faces

_DRAWN, _VERTICES = 2.0, 441  # side of the square that is drawn, m, in squares of 0.1 m


class HalfSpaceObstacle(Obstacle):
    """Everything below its own plane z = 0, without end."""

    kind: Literal["half-space"] = "half-space"

    def shell(
        self,
        folder: Path = Path(),  # noqa: ARG002
        deadline: Deadline = NEVER,  # noqa: ARG002
    ) -> tuple[Array, Faces]:
        """What pictures show: a square of the plane, 2 m wide, about the position."""
        flat, faces = grid_mesh(_DRAWN, _DRAWN, _VERTICES, 0.0, 0)
        return np.column_stack([flat - _DRAWN / 2, np.zeros(len(flat))]), faces

    def solid(self, folder: Path = Path(), deadline: Deadline = NEVER) -> Solid:  # noqa: ARG002
        """The whole half space."""
        up = rotation_from_rpy(*self.rpy_rad)[:, 2]
        below = HalfSpace.through(np.array(self.position_m), up)

        def distances(points: Array) -> tuple[Array, Array]:
            distance = np.maximum(below.along(points) - below.offset_m, 0.0)
            return distance, distance

        shape = fcl.Halfspace(np.array(below.normal), below.offset_m)
        return _Below(shape, np.inf, distances, below)


class _Below(Solid):
    """A half space for bodies of all kinds; fcl crashes when asked for triangles near one."""

    def __init__(
        self, shape: fcl.CollisionGeometry, width: float, distances: Distances, below: HalfSpace
    ) -> None:
        super().__init__(shape, width, distances)
        self._below = below

    def meets(self, mesh: Solid) -> bool:  # noqa: ARG002
        """Not known of faces; who asks has vertices as well."""
        return False

    def _touches(self, body: Body, ends: Array, poses: Poses | None = None) -> Mask:
        if body.solid is None:
            return super()._touches(body, ends, poses)
        lowest = lowest_points(body.solid, body_poses(body, ends, poses), self._below)
        return np.asarray(lowest <= self._below.offset_m + body.skin)
