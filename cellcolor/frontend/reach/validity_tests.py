"""What makes a configuration valid: what tests look at, the kinds of ``[[validity_test]]`` that a
scene may add, and the tests of the paper's three constraints (section III-A).

These are: collision-free and kinematically possible, able to exert the force, well conditioned.
Cheap tests come first; each looks only at what is left.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.kinematics import (
    Poses,
    forward,
    manipulability,
    static_torques,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, Pair, pairs_of, pairs_with
from cellcolor.frontend.contact.tip import Tip, body_ends
from cellcolor.frontend.reach.prepared_arm import PreparedArm
from cellcolor.frontend.setup import Setup
from cellcolor.frontend.tables import Registry, Table


@dataclass(frozen=True, eq=False)
class Workplace:
    """An arm with a part before it, and what stands around them in the world.

    Attributes:
        arm: and what it has to do.
        ground: None without one.
        obstacles: see :class:`~cellcolor.frontend.arm.body.Shape`.
        target: the object, as what must not be hit.
        tip: the region where the tool works.
    """

    arm: PreparedArm
    ground: Shape | None
    obstacles: tuple[Shape, ...]
    target: Shape
    tip: Tip

    @property
    def robot(self) -> Robot:
        """Arm and tool."""
        return self.arm.robot

    @property
    def setup(self) -> Setup:
        """What the arm has to do."""
        return self.arm.setup

    @cached_property
    def contacts(self) -> dict[str, Contacts]:
        """What may not touch or come too near, by the name of the test that asks."""
        robot, margins, exempt = self.robot, self.setup.margins, self.setup.robot.may_touch_ground
        ground = [] if self.ground is None else [self.ground]
        free = [body for body in robot.bodies if body.link not in exempt]
        pairs: dict[str, Sequence[Pair]] = {
            "ground": [(body, it, margins.to_ground_m) for it in ground for body in free],
            "self collision": pairs_of(robot, margins.between_links_m),
            "obstacle collision": pairs_with(robot, self.obstacles, margins.to_obstacles_m),
            "object collision": pairs_with(robot, [self.target], margins.to_object_m),
        }
        return {name: Contacts(own, robot) for name, own in pairs.items()}


@dataclass(frozen=True, eq=False)
class Postures:
    """The arm in k configurations, all of them with a solution.

    Attributes:
        configurations: (k, joints) in rad, turned into the limits where possible.
        poses: of all joint frames in the world.
        linear: (k, 3, joints) how the tip moves with the joints, m per rad.
        determinant: (k,) the task determinant, m^3.
        ends: (bodies, 2, k, 3) the ends of the axes of all bodies, in the world, m.
    """

    workplace: Workplace
    configurations: Array
    poses: Poses
    linear: Array
    determinant: Array
    ends: Array

    @classmethod
    def of(cls, workplace: Workplace, configurations: Array) -> Postures:
        """The arm in configurations (k, joints) in rad."""
        poses = forward(workplace.robot, configurations)
        linear, angular = tip_jacobian(poses)
        task = workplace.robot.task
        determinant = task_determinant(linear, angular, poses.tool_axis, task)
        ends = body_ends(workplace.robot, poses)
        return cls(workplace, configurations, poses, linear, determinant, ends)

    def without(self, failed: Mask) -> Postures:
        """Those that have not failed, (k,)."""
        if not failed.any():
            return self
        left = np.flatnonzero(~failed)
        return Postures(
            self.workplace,
            self.configurations[left],
            self.poses.take(left),
            self.linear[left],
            self.determinant[left],
            self.ends[:, :, left],
        )

    def __len__(self) -> int:
        return len(self.configurations)


class ValidityTest(Table):
    """A test that candidates pass or fail.

    A kind that files can name has a key ``kind`` with its name, and is registered by an entry
    point of the group ``cellcolor.validity_tests``.

    Attributes:
        name: of the reason that a candidate has which fails here first, as ``joint limits``.
    """

    name: ClassVar[str]

    @abstractmethod
    def failed(self, postures: Postures) -> Mask:
        """Which of the postures fail, (k,)."""


VALIDITY_TESTS: Registry[ValidityTest] = Registry(
    "cellcolor.validity_tests",
    ValidityTest,  # type: ignore[type-abstract]
    {},
)


@dataclass(frozen=True)
class StandardTest:
    """A test that a setup can leave out by the constraint that it belongs to.

    Attributes:
        name, failed: as of a :class:`ValidityTest`.
        constraint: what it belongs to.
        remedy: what to try where it fails everywhere.
    """

    name: str
    constraint: Literal["collision", "force", "conditioning"]
    failed: Callable[[Postures], Mask]
    remedy: str


def _beyond_limits(postures: Postures) -> Mask:
    """A joint is beyond its upper limit; only prismatic ones are below the lower.

    The configurations have been turned into the limits where that is possible.
    """
    robot, joints = postures.workplace.robot, postures.configurations
    beyond = (joints > robot.upper) | (robot.slides & (joints < robot.lower))
    return np.asarray(beyond.any(axis=1))


def _tip_blocked(postures: Postures) -> Mask:
    """At a vertex this is so for all branches that have a solution, or for none."""
    return postures.workplace.tip.blocked(postures.poses.tip, postures.poses.tool_axis)


def _too_weak(postures: Postures) -> Mask:
    """A joint cannot hold the arm still while the tool presses; what accelerates is not asked."""
    robot, task = postures.workplace.robot, postures.workplace.setup.task
    gravity, push = np.array(task.gravity_m_per_s2), task.normal_force_n
    torques = static_torques(robot, postures.poses, postures.linear, gravity, push)
    return np.asarray(np.any(np.abs(torques) > robot.effort, axis=1))


def _hardly_manipulable(postures: Postures) -> Mask:
    """Near a singularity of the tip's position."""
    place = postures.workplace
    measure = manipulability(postures.linear, place.robot.task)
    return np.asarray(measure < place.arm.conditioning.min_manipulability)


def _near_singular(postures: Postures) -> Mask:
    """Near a singularity of the task, the aligned wrist included."""
    least = postures.workplace.arm.conditioning.min_task_determinant
    return np.asarray(postures.determinant < least)


def _contact(name: str, remedy: str) -> StandardTest:
    """The arm or the tool hits something; links next to each other may touch."""

    def hit(postures: Postures) -> Mask:
        return postures.workplace.contacts[name](postures.configurations)

    return StandardTest(name, "collision", hit, remedy)


STANDARD_TESTS = (
    StandardTest(
        "joint limits",
        "collision",
        _beyond_limits,
        "move or turn the part, or check the limits in the URDF",
    ),
    StandardTest(
        "tip blocked",
        "collision",
        _tip_blocked,
        "move what is in the tool's way, or the part: its surface lies below the ground"
        " or inside an obstacle",
    ),
    StandardTest(
        "torque",
        "force",
        _too_weak,
        "lower task.normal_force_n, move the part nearer, or check the efforts in the URDF",
    ),
    StandardTest(
        "manipulability",
        "conditioning",
        _hardly_manipulable,
        "move the part away from where the arm is stretched out, or lower"
        " thresholds.min_manipulability",
    ),
    StandardTest(
        "task determinant",
        "conditioning",
        _near_singular,
        "move or turn the part, or lower thresholds.min_task_determinant",
    ),
    _contact(
        "ground",
        "lift the part, or name the links that may touch the ground in robot.may_touch_ground",
    ),
    _contact(
        "self collision",
        "look at the shapes of the links, or name pairs that overlap anyway in robot.may_touch",
    ),
    _contact("obstacle collision", "move the part or the obstacles farther apart"),
    _contact("object collision", "use a longer or thinner tool, or turn the part"),
)
