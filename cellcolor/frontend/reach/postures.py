"""What the tests of validity look at: the arm in some configurations, and where it stands."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.kinematics import Poses, forward, task_determinant, tip_jacobian
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.collision import body_ends
from cellcolor.frontend.contact.plane import HalfSpace
from cellcolor.frontend.contact.solids import Solid
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.reach.prepared_arm import PreparedArm
from cellcolor.frontend.setup import Setup


@dataclass(frozen=True, eq=False)
class Workplace:
    """An arm with a part before it, and what stands around them in the world.

    Attributes:
        arm: and what it has to do.
        ground: None without one.
        obstacles: see :class:`~cellcolor.frontend.contact.solids.Solid`.
        target: the object, as what must not be hit.
        tip: the region where the tool works.
    """

    arm: PreparedArm
    ground: HalfSpace | None
    obstacles: tuple[Solid, ...]
    target: Solid
    tip: Tip

    @property
    def robot(self) -> Robot:
        """Arm and tool."""
        return self.arm.robot

    @property
    def setup(self) -> Setup:
        """What the arm has to do."""
        return self.arm.setup


@dataclass(frozen=True)
class _Arm:
    """The arm in a batch of configurations, k of them."""

    configurations: Array
    poses: Poses
    linear: Array
    determinant: Array
    ends: Array


class Postures:
    """The arm in k configurations, all of them with a solution.

    Attributes:
        workplace: where it stands.
    """

    def __init__(self, workplace: Workplace, arm: _Arm, rows: NDArray[np.intp]) -> None:
        """Those of a batch that the rows (k,) name; :meth:`of` makes a whole batch."""
        self.workplace, self._arm, self._rows = workplace, arm, rows

    @classmethod
    def of(cls, workplace: Workplace, configurations: Array) -> Postures:
        """The arm in configurations (k, joints) in rad."""
        poses = forward(workplace.robot, configurations)
        linear, angular = tip_jacobian(poses)
        task = workplace.robot.task
        determinant = task_determinant(linear, angular, poses.tool_axis, task)
        ends = body_ends(workplace.robot, poses)
        arm = _Arm(configurations, poses, linear, determinant, ends)
        return cls(workplace, arm, np.arange(len(configurations)))

    def without(self, failed: Mask) -> Postures:
        """Those that have not failed, (k,)."""
        return Postures(self.workplace, self._arm, self._rows[~failed])

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def configurations(self) -> Array:
        """(k, joints) in rad, turned into the limits where possible."""
        return self._arm.configurations[self._rows]

    @cached_property
    def poses(self) -> Poses:
        """Of all joint frames, in the world."""
        return self._arm.poses.take(self._rows)

    @property
    def tip(self) -> Array:
        """(k, 3) where the tool's tip is, in the world, m."""
        return self._arm.poses.tip[self._rows]

    @property
    def tool_axis(self) -> Array:
        """(k, 3) unit vectors from the flange to the tip, in the world."""
        return self._arm.poses.tool_axis[self._rows]

    @property
    def linear(self) -> Array:
        """(k, 3, joints) how the tip moves with the joints, m per rad."""
        return self._arm.linear[self._rows]

    @property
    def determinant(self) -> Array:
        """(k,) the task determinant, m^3."""
        return self._arm.determinant[self._rows]

    def ends_of(self, robot: Robot) -> Array:
        """The ends of the axes of all bodies of the same robot, or of a wider one."""
        if robot is self.workplace.robot:
            return self.ends
        return body_ends(robot, self.poses)

    @property
    def ends(self) -> Array:
        """(bodies, 2, k, 3) the ends of the axes of all bodies, in the world, m."""
        return self._arm.ends[:, :, self._rows]
