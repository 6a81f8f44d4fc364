"""Where the tool works: the region at its tip that needs room on the surface.

Bodies end short of the tip, since the tip touches the object. Obstacles and
the ground must leave room for it (``docs/frontend.md``, "Validity"). The region depends
only on the tool's pose, whatever the arm does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask, numbered
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.shape import Shape
from cellcolor.frontend.contact.engine import Contacts, poses_along
from cellcolor.frontend.contact.movement import HalfSpace, longest_steps
from cellcolor.frontend.parts.surface import Faces, Surface, along_edges
from cellcolor.memory import batches


class Tip:
    """All points within the contact radius of the tool's axis, from the tip to the tool's body.

    Attributes:
        body: the region as a shape fixed to the last joint.
    """

    def __init__(
        self, robot: Robot, radius: float, obstacles: Sequence[Shape], ground: HalfSpace | None
    ) -> None:
        """``radius`` in m, and the ground if there is one."""
        point, axis = robot.tip[:3, 3], robot.tip[:3, 2]
        # How far behind the tip the axis of each body on the last link begins, or a solid itself.
        behind = []
        for body in robot.bodies:
            if body.joint == robot.joints:
                ends = [body.start, body.end] if body.solid is None else body.solid.vertices
                behind.append(float(((point - ends) @ axis).min()))
        length = max(min(behind, default=0.0), 0.0)
        self.body = Body("tool tip", robot.joints, point, point - length * axis, radius, flat=False)
        # Without a length it is a ball, whichever way its frame is turned.
        along = np.array([0.0, 0.0, -length])
        region = replace(self.body, joint=1, start=np.zeros(3), end=along)
        below: list[Shape] = [] if ground is None else [ground.shape]
        self._with_obstacles, self._with_ground = (
            Contacts([(region, thing, 0.0) for thing in things]) for things in (obstacles, below)
        )

    def blocked(self, points: Array, directions: Array) -> Mask:
        """Whether something is in the way, (k,).

        Args:
            points: (k, 3) where the tip is, m.
            directions: (k, 3) unit vectors along the tool, from the flange to the tip.
        """
        poses = poses_along(points, directions)
        return self._with_ground(poses) | self._with_obstacles(poses)

    def free_along(self, surface: Surface, edges: Faces) -> Mask:
        """Whether obstacles leave room all along mesh edges (k, 2), (k,).

        Tested at points so close together that at most 0.65 mm of an overlap with the region is
        missed. The ground is flat, so the vertices are enough.
        """
        free = np.ones(len(edges), dtype=bool)
        if not self._with_obstacles:
            return free
        way = surface.lengths(edges) + self.body.length * surface.turns(edges)
        step = float(longest_steps(np.array([self.body.radius]))[0])
        pieces = np.maximum(np.ceil(way / step).astype(int), 1)
        for part in batches(pieces):
            which, number = numbered(pieces[part])
            row = part.start + which
            points, directions = along_edges(surface, edges[row], number / pieces[part][which])
            free[row[self._with_obstacles(poses_along(points, directions))]] = False
        return free
