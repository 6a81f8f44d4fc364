"""Where the tool works: the region at its tip that needs room on the surface.

Bodies end short of the tip, since the tip touches the object. Obstacles and
the ground must leave room for it (``docs/frontend.md``, "Validity"). The region depends
only on the tool's pose, whatever the arm does.
"""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Mask, numbered
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.collision import HalfSpace, longest_steps
from cellcolor.frontend.contact.solids import Solid
from cellcolor.frontend.parts.surface import Faces, Surface, along_edges
from cellcolor.memory import batches

_POINT = 1_024  # bytes that a point on an edge takes


class Tip:
    """All points within the contact radius of the tool's axis, from the tip to the tool's body.

    Attributes:
        body: the region as a shape fixed to the last joint.
    """

    def __init__(
        self, robot: Robot, radius: float, obstacles: list[Solid], ground: HalfSpace | None
    ) -> None:
        """``radius`` in m, and the ground if there is one."""
        point, axis = robot.tip[:3, 3], robot.tip[:3, 2]
        # How far behind the tip the axis of each body on the last link begins, or a solid itself.
        behind = []
        for body in robot.bodies:
            if body.joint == robot.joints:
                ends = [body.start, body.end] if body.solid is None else body.solid.outline
                behind.append(float(((point - ends) @ axis).min()))
        length = max(min(behind, default=0.0), 0.0)
        self.body = Body("tool tip", robot.joints, point, point - length * axis, radius, flat=False)
        self._obstacles, self._ground = obstacles, ground

    def blocked(self, points: Array, directions: Array) -> Mask:
        """Whether something is in the way, (k,).

        Args:
            points: (k, 3) where the tip is, m.
            directions: (k, 3) unit vectors along the tool, from the flange to the tip.
        """
        ends = np.stack([points, points - self.body.length * directions])
        hit = np.zeros(len(points), dtype=bool)
        if self._ground is not None:
            lower = self._ground.along(ends).min(axis=0)
            hit |= lower - self.body.radius < self._ground.offset_m
        for obstacle in self._obstacles:
            hit[~hit] = obstacle.touched_by(self.body, ends[:, ~hit])
        return hit

    def free_along(self, surface: Surface, edges: Faces) -> Mask:
        """Whether obstacles leave room all along mesh edges (k, 2), (k,).

        Tested at points so close together that at most 0.65 mm of an overlap with the region is
        missed. The ground is flat, so the vertices are enough.
        """
        free = np.ones(len(edges), dtype=bool)
        if not self._obstacles:
            return free
        body, lengths = self.body, surface.lengths(edges)
        ends = surface.vertices[edges.ravel()]
        near = np.min([solid.at_least(ends) for solid in self._obstacles], axis=0)
        # No point of an edge is farther from the nearer end than half its length.
        doubtful = near.reshape(-1, 2).min(axis=1) <= body.radius + body.length + lengths / 2
        rows = np.flatnonzero(doubtful)
        way = lengths[rows] + body.length * surface.turns(edges[rows])
        step = float(longest_steps(np.array([body.radius]))[0])
        pieces = np.maximum(np.ceil(way / step).astype(int), 1)
        for part in batches(pieces, _POINT):
            which, number = numbered(pieces[part])
            row = rows[part][which]
            points, directions = along_edges(surface, edges[row], number / pieces[part][which])
            free[row[self.blocked(points, directions)]] = False
        return free
