"""Which configurations are valid, and the first reason why the others are not.

What tests look at, the kinds of ``[[validity_test]]`` that a scene may add, the tests of the
paper's three constraints (section III-A), and the judge that makes them all. The constraints are:
collision-free and kinematically possible, able to exert the force, well conditioned.
Cheap tests come first; each looks only at what is left.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.body import Shape
from cellcolor.frontend.arm.kinematics import (
    Poses,
    forward,
    manipulability,
    static_torques,
    task_determinant,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.engine import Contacts, Pair, pairs_of, pairs_with
from cellcolor.frontend.contact.tip import Tip, body_ends, tracked_points, tracked_steps
from cellcolor.frontend.reach.prepared_arm import PreparedArm
from cellcolor.frontend.setup import Setup
from cellcolor.frontend.tables import Registry, Table
from cellcolor.memory import check_memory, chunks


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
        determinant: (k,) the task determinant, m^3.
    """

    workplace: Workplace
    configurations: Array
    poses: Poses
    determinant: Array

    @classmethod
    def of(cls, workplace: Workplace, configurations: Array) -> Postures:
        """The arm in configurations (k, joints) in rad."""
        poses = forward(workplace.robot, configurations)
        determinant = task_determinant(poses, workplace.robot.task)
        return cls(workplace, configurations, poses, determinant)

    @cached_property
    def ends(self) -> Array:
        """(bodies, 2, k, 3) the ends of the axes of all bodies, in the world, m."""
        return body_ends(self.workplace.robot, self.poses)

    def without(self, failed: Mask) -> Postures:
        """Those that have not failed, (k,)."""
        if not failed.any():
            return self
        left = np.flatnonzero(~failed)
        return Postures(
            self.workplace,
            self.configurations[left],
            self.poses.take(left),
            self.determinant[left],
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
    torques = static_torques(robot, postures.poses, gravity, push)
    return np.asarray(np.any(np.abs(torques) > robot.effort, axis=1))


def _hardly_manipulable(postures: Postures) -> Mask:
    """Near a singularity of the tip's position."""
    place = postures.workplace
    measure = manipulability(postures.poses, place.robot.task)
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

NO_SOLUTION = 1
"""The code where a branch does not reach the pose, so that there is nothing to test."""
STANDARD_REASONS = ("valid", "no solution", *(test.name for test in STANDARD_TESTS))
"""What the first codes mean."""


@dataclass(frozen=True, eq=False)
class Verdicts:
    """What became of configurations (k,), or of all branches at all vertices (n, branches).

    Attributes:
        configurations: (..., joints) in rad, turned into the limits where possible; NaN without
            solution.
        reasons: (...) uint8 codes, which index ``reason_names``.
        determinants: (...) task determinant in m^3, NaN without solution.
        tracked: (points, ..., 3) of the bodies that can move, in the world, m, see
            :func:`~cellcolor.frontend.contact.tip.tracked_points`; NaN as above.
        reason_names: valid, no solution, and the tests in the order of testing.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array
    tracked: Array
    reason_names: tuple[str, ...]

    @property
    def valid(self) -> Mask:
        """(...)."""
        return np.asarray(self.reasons == VALID)


def turned_into_limits(robot: Robot, configurations: Array) -> Array:
    """Turn joints by full circles into their limits; prismatic ones stay where they are.

    An angle inside its limits stays as it is; another one takes the smallest equivalent that is not
    below them, which is beyond them if none is inside.
    """
    circle = 2 * np.pi
    turned = configurations + circle * np.ceil((robot.lower - configurations) / circle)
    inside = (configurations >= robot.lower) & (configurations <= robot.upper)
    return np.where(inside | robot.slides, configurations, turned)


class Judge:
    """The tests of one workplace: the standard ones, then those that the scene adds.

    Attributes:
        reason_names: of the codes of verdicts: valid, no solution, and the tests in the order of
            testing, whether the setup leaves them out or not.
        tracked_steps: (points,) how far those of :attr:`Verdicts.tracked` may move between two
            tests, m.
    """

    def __init__(
        self,
        workplace: Workplace,
        added: tuple[ValidityTest, ...] = (),
        left_out: frozenset[str] = frozenset(),
    ) -> None:
        """The tests of a workplace."""
        self._workplace = workplace
        # Two tests of one kind, with other keys, are one reason.
        self.reason_names = tuple(dict.fromkeys([*STANDARD_REASONS, *(t.name for t in added)]))
        on = workplace.setup.constraints
        tests: list[StandardTest | ValidityTest] = [
            test for test in STANDARD_TESTS if getattr(on, test.constraint)
        ]
        self._tests = tuple(test for test in [*tests, *added] if test.name not in left_out)
        margins = workplace.setup.margins
        least = min(margins.to_object_m, margins.to_obstacles_m, margins.to_ground_m)
        self.tracked_steps = tracked_steps(workplace.robot, least, margins.between_links_m)

    def __call__(self, configurations: Array, deadline: Deadline = NEVER) -> Verdicts:
        """Test configurations (..., joints) in rad, NaN where there is none.

        Raises:
            TooLarge: the verdicts would not fit into the machine's memory.
        """
        *shape, joints = configurations.shape
        asked = configurations.reshape(-1, joints)
        count, points = len(asked), len(self.tracked_steps)
        # Of millions the ends of all bodies are a gigabyte: there is to be no second copy.
        # Solids have many points, which single precision makes up for: a tenth of a micrometer does
        # not matter to how far bodies move.
        place = np.float32 if self._workplace.robot.has_solids else np.float64
        kept = 8 * joints + 9 + 24 * points
        check_memory(count * kept, f"judging {count:,} configurations of the arm")
        moved = asked.copy()
        reasons = np.full(count, NO_SOLUTION, np.uint8)
        determinants, tracked = np.full(count, np.nan), np.full((points, count, 3), np.nan, place)
        robot = self._workplace.robot
        for part in chunks(count):
            deadline.check()
            rows = part.start + np.flatnonzero(~np.isnan(asked[part, 0]))
            moved[rows] = turned_into_limits(robot, asked[rows])
            postures = Postures.of(self._workplace, moved[rows])
            determinants[rows] = postures.determinant
            tracked[:, rows] = tracked_points(robot, postures.poses)
            reasons[rows] = self._first_failures(postures)
        return Verdicts(
            moved.reshape(configurations.shape),
            reasons.reshape(shape),
            determinants.reshape(shape),
            tracked.reshape(points, *shape, 3),
            self.reason_names,
        )

    def _first_failures(self, postures: Postures) -> NDArray[np.uint8]:
        """The code (k,) of the first test that each posture fails."""
        reasons = np.full(len(postures), VALID, dtype=np.uint8)
        left = np.arange(len(postures))
        for test in self._tests:
            failed = test.failed(postures)
            reasons[left[failed]] = self.reason_names.index(test.name)
            left, postures = left[~failed], postures.without(failed)
        return reasons
