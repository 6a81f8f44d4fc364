"""Which configurations are valid, and the first reason why the others are not.

The paper's three constraints (section III-A): collision-free and kinematically possible, able to
exert the force, well conditioned. Cheap tests come first; each looks only at what is left.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.conditioning import Conditioning
from cellcolor.frontend.arm.kinematics import (
    Poses,
    forward,
    manipulability,
    static_torques,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.contact.collision import body_ends, hits_ground, hits_itself
from cellcolor.frontend.contact.solids import Solid
from cellcolor.frontend.contact.tip import Tip
from cellcolor.frontend.setup import Setup

__all__ = ["Candidates", "Judge", "Reason", "Verdicts", "within_limits"]

_AT_ONCE = 2_048  # configurations; so few that their poses stay in the processor's cache

Rows = NDArray[np.intp]
Test = Callable[[Rows], Mask]


class Reason(IntEnum):
    """Why a candidate is not valid: the first test that it fails.

    The numbers are in the order of the tests, but for the last: the tip is tested after the joint
    limits. It is blocked for all branches of a vertex or for none.
    """

    VALID = 0
    NO_SOLUTION = 1
    JOINT_LIMITS = 2
    TORQUE = 3
    MANIPULABILITY = 4
    TASK_DETERMINANT = 5
    GROUND = 6
    SELF_COLLISION = 7
    OBSTACLE_COLLISION = 8
    OBJECT_COLLISION = 9
    TIP_BLOCKED = 10

    @property
    def text(self) -> str:
        """The reason in words."""
        return self.name.lower().replace("_", " ")


@dataclass(frozen=True)
class Candidates:
    """All branches on all vertices.

    Attributes:
        configurations: (n, 8, 6) in rad, inside the limits where possible; NaN without solution.
        reasons: (n, 8) uint8, see :class:`Reason`.
        determinants: (n, 8) task determinant in m^3, NaN where the tests ended before it.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array

    @property
    def valid(self) -> Mask:
        """(n, 8)."""
        valid: Mask = self.reasons == Reason.VALID
        return valid


@dataclass(frozen=True)
class Verdicts:
    """What became of configurations.

    Attributes:
        configurations: (k, 6) in rad, turned into the limits where possible.
        reasons: (k,) uint8, see :class:`Reason`.
        determinants: (k,) task determinant in m^3, NaN where the tests ended before it.
        ends: (ends, k, 3) of the axes of the bodies that can move, in the world, m; NaN as above.
        seconds: wall time of forward kinematics and of each test.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array
    ends: Array
    seconds: dict[str, float]


def within_limits(robot: Robot, configurations: Array) -> tuple[Array, Mask]:
    """Turn joints by full circles into their limits.

    An angle inside its limits stays as it is; another one takes the smallest equivalent inside
    them, if there is one.

    Returns:
        the configurations (n, 6), and whether all joints are inside (n,).
    """
    circle = 2 * np.pi
    turned = configurations + circle * np.ceil((robot.lower - configurations) / circle)
    inside = (configurations >= robot.lower) & (configurations <= robot.upper)
    moved: Array = np.where(inside, configurations, turned)
    reachable: Mask = np.all(moved <= robot.upper, axis=1)
    return moved, reachable


class Judge:
    """The tests of one robot, setup and scene."""

    def __init__(
        self,
        robot: Robot,
        setup: Setup,
        limits: Conditioning,
        ground: float | None,
        obstacles: list[Solid],
        target: Solid,
        tip: Tip,
        deadline: Deadline = NEVER,
    ) -> None:
        """``obstacles``, ``target``, the object, and what ``tip`` knows stand in the world.

        ``ground`` is its height in m, if there is one.

        ``deadline`` is when to give up, asked in between (:class:`OutOfTime`).
        ``end_radii`` (ends,) are those of the bodies of :attr:`Verdicts.ends`, m.
        """
        self._robot, self._setup, self._ground = robot, setup, ground
        self._limits, self._deadline = limits, deadline
        self._obstacles, self._target, self._tip = obstacles, target, tip
        self._moving = [index for index, body in enumerate(robot.bodies) if body.joint > 0]
        self.end_radii = np.repeat([robot.bodies[index].radius for index in self._moving], 2)

    def __call__(self, configurations: Array) -> Verdicts:
        """Test configurations (k, 6) in rad, NaN where there is none."""
        count = len(configurations)
        # Of millions the ends of all bodies are a gigabyte: there is to be no second copy.
        whole = Verdicts(
            np.empty_like(configurations),
            np.empty(count, dtype=np.uint8),
            np.empty(count),
            np.empty((len(self.end_radii), count, 3)),
            {},
        )
        for first in range(0, count, _AT_ONCE):
            self._deadline.check()
            rows = slice(first, first + _AT_ONCE)
            part = self._judged(configurations[rows])
            whole.configurations[rows], whole.reasons[rows] = part.configurations, part.reasons
            whole.determinants[rows], whole.ends[:, rows] = part.determinants, part.ends
            for name, seconds in part.seconds.items():
                whole.seconds[name] = whole.seconds.get(name, 0.0) + seconds
        return whole

    def _judged(self, configurations: Array) -> Verdicts:
        robot, on, limits = self._robot, self._setup.constraints, self._limits
        reasons = np.full(len(configurations), Reason.VALID, dtype=np.uint8)
        reasons[np.isnan(configurations[:, 0])] = Reason.NO_SOLUTION
        moved = configurations.copy()
        solved = np.flatnonzero(reasons == Reason.VALID)
        moved[solved], inside = within_limits(robot, moved[solved])
        if on.collision:
            reasons[solved[~inside]] = Reason.JOINT_LIMITS
        posed = np.flatnonzero(reasons == Reason.VALID)

        seconds, started = {}, time.perf_counter()
        poses = forward(robot, moved[posed])
        linear, angular = tip_jacobian(poses)
        determinant = task_determinant(linear, angular, poses.tool_axis)
        determinants = np.full(len(reasons), np.nan)
        determinants[posed] = determinant
        ends = body_ends(robot, poses)
        seconds["forward kinematics"] = time.perf_counter() - started

        # Each test sees the rows of `poses` that have passed the ones before it.
        tests: list[tuple[Reason, Test]] = []
        if on.collision:
            tip, along = poses.tip, poses.tool_axis
            tests += [(Reason.TIP_BLOCKED, lambda rows: self._tip.blocked(tip[rows], along[rows]))]
        if on.force:
            tests += [(Reason.TORQUE, lambda rows: self._too_weak(poses.take(rows), linear[rows]))]
        if on.conditioning:
            tests += [
                (
                    Reason.MANIPULABILITY,
                    lambda rows: manipulability(linear[rows]) < limits.min_manipulability,
                ),
                (
                    Reason.TASK_DETERMINANT,
                    lambda rows: determinant[rows] < limits.min_task_determinant,
                ),
            ]
        if on.collision:
            tests += [
                (Reason.GROUND, lambda rows: self._in_ground(ends[:, :, rows])),
                (Reason.SELF_COLLISION, lambda rows: hits_itself(robot, ends[:, :, rows])),
                (Reason.OBSTACLE_COLLISION, lambda rows: self._in_obstacle(ends[:, :, rows])),
                (Reason.OBJECT_COLLISION, lambda rows: self._target.hits(robot, ends[:, :, rows])),
            ]
        passed = np.arange(len(posed))
        for reason, test in tests:
            started = time.perf_counter()
            failed = test(passed)
            reasons[posed[passed[failed]]] = reason
            passed = passed[~failed]
            seconds[reason.text] = time.perf_counter() - started
        places = np.full((2 * len(self._moving), len(reasons), 3), np.nan)
        places[:, posed] = ends[self._moving].reshape(len(places), len(posed), 3)
        return Verdicts(moved, reasons, determinants, places, seconds)

    def _too_weak(self, poses: Poses, linear: Array) -> Mask:
        task = self._setup.task
        gravity = np.array(task.gravity_m_per_s2)
        torques = static_torques(self._robot, poses, linear, gravity, task.normal_force_n)
        weak: Mask = np.any(np.abs(torques) > self._robot.effort, axis=1)
        return weak

    def _in_ground(self, ends: Array) -> Mask:
        exempt = self._setup.robot.may_touch_ground
        if self._ground is None:
            return np.zeros(ends.shape[2], dtype=bool)
        return hits_ground(self._robot, ends, self._ground, exempt)

    def _in_obstacle(self, ends: Array) -> Mask:
        hit = np.zeros(ends.shape[2], dtype=bool)
        for obstacle in self._obstacles:
            hit[~hit] = obstacle.hits(self._robot, ends[:, :, ~hit])
        return hit
