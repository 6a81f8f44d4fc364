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

from cellcolor.errors import InputError
from cellcolor.frontend.collision import Collider, Mask, hits_ground, hits_itself
from cellcolor.frontend.kinematics import (
    forward,
    manipulability,
    static_torques,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.robot import Array, Robot
from cellcolor.frontend.scene import Scene, Setup
from cellcolor.frontend.surfaces import Surface

__all__ = ["Candidates", "Reason", "judge", "within_limits"]

Rows = NDArray[np.intp]


class Reason(IntEnum):
    """Why a candidate is not valid: the first test that it fails, in the order of the tests."""

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
        seconds: time spent on each test.
    """

    configurations: Array
    reasons: NDArray[np.uint8]
    determinants: Array
    seconds: dict[str, float]

    @property
    def valid(self) -> Mask:
        """(n, 8)."""
        valid: Mask = self.reasons == Reason.VALID
        return valid


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


def judge(
    robot: Robot, setup: Setup, scene: Scene, surface: Surface, solutions: Array
) -> Candidates:
    """Test all inverse-kinematic solutions (n, 8, 6) of a surface's vertices.

    Raises:
        InputError: the object stands in a link that cannot move.
    """
    n, branches, joints = solutions.shape
    flat = solutions.reshape(-1, joints).copy()
    reasons = np.full(len(flat), Reason.VALID, dtype=np.uint8)
    determinants = np.full(len(flat), np.nan)
    seconds: dict[str, float] = {}
    collider = Collider.of_mesh(robot, surface.vertices, surface.faces)
    obstacles = [Collider.of_obstacle(robot, obstacle) for obstacle in scene.obstacle]
    blocked = collider.hits_fixed()
    if blocked is not None:
        raise InputError(None, "placement", f"the object stands in the robot's {blocked!r}")

    reasons[np.isnan(flat[:, 0])] = Reason.NO_SOLUTION
    solved = np.flatnonzero(reasons == Reason.VALID)
    flat[solved], inside = within_limits(robot, flat[solved])
    reasons[solved[~inside]] = Reason.JOINT_LIMITS

    posed = np.flatnonzero(reasons == Reason.VALID)
    started = time.perf_counter()
    poses = forward(robot, flat[posed])
    linear, angular = tip_jacobian(poses)
    determinant = task_determinant(linear, angular, poses.tool_axis)
    determinants[posed] = determinant
    seconds["forward kinematics"] = time.perf_counter() - started

    force, gravity = setup.task.normal_force_n, np.array(setup.task.gravity_m_per_s2)
    limits = setup.thresholds

    def too_weak(rows: Rows) -> Mask:
        torques = static_torques(robot, poses.take(rows), linear[rows], gravity, force)
        weak: Mask = np.any(np.abs(torques) > robot.effort, axis=1)
        return weak

    def in_ground(rows: Rows) -> Mask:
        if scene.ground is None:
            return np.zeros(len(rows), dtype=bool)
        exempt = setup.robot.may_touch_ground
        return hits_ground(robot, poses.take(rows), scene.ground.height_m, exempt)

    def in_obstacle(rows: Rows) -> Mask:
        hit = np.zeros(len(rows), dtype=bool)
        for obstacle in obstacles:
            hit[~hit] = obstacle.hits(poses.take(rows[~hit]))
        return hit

    # Each test sees the rows of `poses` that have passed the ones before it.
    tests: tuple[tuple[Reason, Callable[[Rows], Mask]], ...] = (
        (Reason.TORQUE, too_weak),
        (
            Reason.MANIPULABILITY,
            lambda rows: manipulability(linear[rows]) < limits.min_manipulability_m3,
        ),
        (
            Reason.TASK_DETERMINANT,
            lambda rows: determinant[rows] < limits.min_task_determinant_m3,
        ),
        (Reason.GROUND, in_ground),
        (Reason.SELF_COLLISION, lambda rows: hits_itself(robot, poses.take(rows))),
        (Reason.OBSTACLE_COLLISION, in_obstacle),
        (Reason.OBJECT_COLLISION, lambda rows: collider.hits(poses.take(rows))),
    )
    passed = np.arange(len(posed))
    for reason, test in tests:
        started = time.perf_counter()
        failed = test(passed)
        reasons[posed[passed[failed]]] = reason
        passed = passed[~failed]
        seconds[reason.text] = time.perf_counter() - started
    return Candidates(
        flat.reshape(n, branches, joints),
        reasons.reshape(n, branches),
        determinants.reshape(n, branches),
        seconds,
    )
