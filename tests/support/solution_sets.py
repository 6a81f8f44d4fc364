"""All solutions of poses, by a family of arms and by solvers that share no code with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from independent import set_distance, wrapped
from other_solver import Ssik

from cellcolor.arrays import Array, Mask
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import forward, task_determinant, tip_jacobian
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup

REGULAR = 1e-5  # of reach^3; nearer to a singularity two solutions are about to meet
SAME = 1e-5  # rad


@dataclass(frozen=True)
class Compared:
    """How two solvers agree.

    Attributes:
        poses, solutions: how many were compared.
        different: poses whose sets differ, modulo full turns, either way.
        farthest: largest difference of an angle within a pair, rad, where sets are the same.
    """

    poses: int
    solutions: int
    different: int
    farthest: float


@dataclass(frozen=True)
class Arm:
    """An arm with its tool and its inverse kinematics."""

    robot: Robot
    family: InverseKinematics

    @classmethod
    def of(cls, setup: Setup) -> Arm:
        """The one that a setup names."""
        arm = prepare_arm(setup)
        return cls(arm.robot, arm.kinematics)

    def solved(self, points: Array, directions: Array) -> list[Array]:
        """Joints 1 to 5 (s, 5) of all solutions of each pose, rad."""
        found = self.family.solve(points, directions)
        return [each[~np.isnan(each[:, 0]), :5] for each in found]

    def regular(self, five: Array) -> Array:
        """Those of some solutions (s, 5) that are not about to meet another one."""
        return five[self.is_regular(five)]

    def is_regular(self, five: Array) -> Mask:
        """Which of some solutions (s, 5) are not about to meet another one, (s,)."""
        poses = forward(self.robot, np.column_stack([five, np.zeros(len(five))]))
        determinant = task_determinant(*tip_jacobian(poses), poses.tool_axis)
        return np.asarray(determinant > REGULAR * self.family.reach**3)

    def compared(self, q: Array) -> Compared:
        """With ssik, on the poses of configurations (n, 6), with a turn by chance each."""
        ssik, random = Ssik(self.robot), np.random.default_rng(3)
        poses = forward(self.robot, q)
        return self.held_against(
            (
                ssik.solutions(point, direction, random.uniform(0, 2 * np.pi))
                for point, direction in zip(poses.tip, poses.tool_axis, strict=True)
            ),
            q,
        )

    def held_against(self, every: Iterable[Array], q: Array) -> Compared:
        """With all solutions (s, 5) that another solver has for the poses of configurations."""
        poses = forward(self.robot, q)
        solutions = different = 0
        farthest = 0.0
        for ours, theirs in zip(self.solved(poses.tip, poses.tool_axis), every, strict=True):
            ours, theirs = self.regular(ours), self.regular(theirs)
            apart = set_distance(ours, theirs)
            solutions += len(ours)
            different += apart > SAME
            farthest = max(farthest, apart if apart <= SAME else 0.0)
        return Compared(len(q), solutions, different, farthest)

    def lost(self, q: Array, within: float) -> int:
        """How many of configurations (n, 6) are not among the solutions of their own poses."""
        poses = forward(self.robot, q)
        return sum(
            wrapped(ours - own[:5]).max(axis=1).min(initial=np.inf) > within
            for own, ours in zip(q, self.solved(poses.tip, poses.tool_axis), strict=True)
        )
