"""All solutions of poses by Newton's method from many random starts, which knows no closed form.

Five joints put the tip on a point and the tool along a direction. Forward kinematics is a product
of exponentials: what is known of the arm with all joints at zero is moved by a turn about the axis
of each joint, as it is at zero (Brockett, Robotic manipulators and the product of exponentials
formula, 1984). Axes, tip and tool at zero are asked of Pinocchio, and nothing of the product.

Configurations of six-axis arms next to a singular wrist, elbow or shoulder.

Inverse kinematics by ssik, which shares no code with the product: all solutions of a pose.

All solutions of poses, by a family of arms and by solvers that share no code with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
import pytest
from independent import set_distance, wrapped
from scipy.optimize import brentq

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.arm.calibrated import CALIBRATION
from cellcolor.frontend.arm.inverse import InverseKinematics
from cellcolor.frontend.arm.kinematics import (
    forward,
    signed_task_determinant,
    task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.signs import signs_of
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup

JOINTS = 5
STEPS = 50
DAMPED = 0.05  # times the squared error, added to the normal equations (Levenberg, Marquardt)
LARGEST = 1.0  # rad; no step moves a joint farther
DONE, REACHED = 1e-13, 1e-11  # m, and for the unit vector; steps end, and what is a solution
ONE = 1e-6  # rad; solutions nearer than this are one
TOGETHER = 20  # poses, whose starts fit into the processor's cache


@dataclass(frozen=True)
class Found:
    """Solutions of a pose.

    Attributes:
        joints: (k, 5) rad.
        hits: (k,) from how many starts each was found.
    """

    joints: Array
    hits: Index


@dataclass(frozen=True)
class ManyStarts:
    """An arm with all joints at zero, in the world.

    Attributes:
        axes, points: (5, 3) direction of each joint's axis, and a point on it in m.
        tip, tool: (3,) the tip in m, and the tool's z axis.
    """

    axes: Array
    points: Array
    tip: Array
    tool: Array

    @classmethod
    def of(cls, model: pin.Model) -> ManyStarts:
        """The arm and tool of a model, its tip's frame ``tool_tip``."""
        data, zero = model.createData(), np.zeros(model.nv)
        jacobian = pin.computeJointJacobians(model, data, zero)
        pin.framesForwardKinematics(model, data, zero)
        tip = data.oMf[model.getFrameId("tool_tip")]
        points = np.array([data.oMi[joint].translation for joint in range(1, JOINTS + 1)])
        axes = jacobian[3:, :JOINTS].T.copy()
        return cls(axes, points, tip.translation.copy(), tip.rotation[:, 2].copy())

    def posed(self, joints: Array) -> tuple[Array, Array, Array]:
        """Tips and tools (n, 3), and how both move with the joints (n, 6, 5), of joints (n, 5)."""
        turn, shift = np.tile(np.eye(3), (len(joints), 1, 1)), np.zeros((len(joints), 3))
        axes, points = np.empty((2, len(joints), JOINTS, 3))
        for joint, (at_zero, point) in enumerate(zip(self.axes, self.points, strict=True)):
            axes[:, joint] = turn @ at_zero
            points[:, joint] = turn @ point + shift
            x, y, z = at_zero
            cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
            angle = joints[:, joint, None, None]
            once, twice = (
                (turn.reshape(-1, 3) @ each).reshape(-1, 3, 3) for each in (cross, cross @ cross)
            )
            turn = turn + np.sin(angle) * once + (1 - np.cos(angle)) * twice
            shift = points[:, joint] - turn @ point
        tip, tool = turn @ self.tip + shift, turn @ self.tool
        moved = np.cross(axes, tip[:, None] - points), np.cross(axes, tool[:, None])
        return tip, tool, np.concatenate(moved, axis=2).transpose(0, 2, 1)

    def reached(self, joints: Array, points: Array, directions: Array) -> Array:
        """Where Newton's method gets from some joints (n, 5), NaN where to no solution."""
        joints, off = joints.copy(), np.empty(len(joints))
        rows = np.arange(len(joints))
        for _ in range(STEPS):
            tip, tool, jacobian = self.posed(joints[rows])
            error = np.concatenate([points[rows] - tip, directions[rows] - tool], axis=1)
            off[rows] = np.abs(error).max(axis=1)
            going = off[rows] > DONE
            rows, error, jacobian = rows[going], error[going], jacobian[going]
            if not len(rows):
                break
            across = jacobian.transpose(0, 2, 1)
            damping = DAMPED * np.einsum("ni,ni->n", error, error) + 1e-15
            normal = across @ jacobian + damping[:, None, None] * np.eye(JOINTS)
            step = np.linalg.solve(normal, across @ error[:, :, None])[:, :, 0]
            most = np.abs(step).max(axis=1, keepdims=True)
            joints[rows] += step * np.minimum(1.0, LARGEST / np.maximum(most, 1e-30))
        joints[off > REACHED] = np.nan
        return joints

    def solutions(
        self,
        points: Array,
        directions: Array,
        starts: int,
        seed: int,
        progress: Callable[[int], None] = lambda _: None,
    ) -> list[Found]:
        """All solutions of poses (n, 3) each, from so many random starts.

        Args:
            progress: told how many poses are done.
        """
        random, found = np.random.default_rng(seed), []
        for first in range(0, len(points), TOGETHER):
            rows = np.arange(first, min(first + TOGETHER, len(points)))
            every = np.repeat(rows, starts)
            begin = random.uniform(-np.pi, np.pi, (len(every), JOINTS))
            ends = self.reached(begin, points[every], directions[every])
            found += [each_once(own) for own in ends.reshape(len(rows), starts, JOINTS)]
            progress(len(found))
        return found


def each_once(ends: Array) -> Found:
    """Joints (s, 5), NaN for none, with equal ones counted."""
    left, joints, hits = ends[~np.isnan(ends[:, 0])], [], []
    while len(left):
        same = wrapped(left - left[0]).max(axis=1) < ONE
        joints.append(left[0])
        hits.append(int(same.sum()))
        left = left[~same]
    return Found(np.array(joints).reshape(-1, JOINTS), np.array(hits, dtype=np.int64))


def estimated_missing(hits: Index) -> float:
    """How many solutions no start has found, at least, by how often the others were.

    From those found once and twice (Chao, Nonparametric estimation of the number of classes in a
    population, 1984; the form without bias).
    """
    once, twice = np.count_nonzero(hits == 1), np.count_nonzero(hits == 2)
    return once * (once - 1) / (2 * (twice + 1))


KINDS = {"wrist": (4, 2), "elbow": (2, 1), "shoulder": (1, 0)}  # joint that leads there, factor
BESIDE = (
    0.05  # rad from where a factor vanishes; the determinant of a calibrated arm does so between
)


def near_singular(robot: Robot, reach: float, kind: str, off: float, count: int) -> Array:
    """Configurations (count, 6) that are ``off`` rad in one joint from a singularity.

    Of a calibrated arm the factors vanish beside its singularities only, where the task determinant
    changes its sign.

    Args:
        robot: an arm whose branches signs tell apart.
        reach: of the arm, m.
        kind: one of ``KINDS``.
    """
    exact = signs_of(robot, reach, 1e-6)
    signs = exact or signs_of(robot, reach, 2 * CALIBRATION)
    assert signs is not None
    joint, number = KINDS[kind]

    def determinant(angle: float, row: Array) -> float:
        turned = np.array(row)
        turned[joint] = angle
        poses = forward(robot, turned[None])
        return float(signed_task_determinant(*tip_jacobian(poses), poses.tool_axis)[0])

    def factor(angle: float, row: Array) -> float:
        turned = np.array(row)
        turned[joint] = angle
        factors = signs.factors(forward(robot, turned[None]))[0]
        # The elbow's factor changes its sign with the shoulder's as well.
        return float(factors[number] * (np.sign(factors[0]) if number == 1 else 1.0))

    rows, found = np.random.default_rng(29).uniform(-np.pi, np.pi, (20 * count, 6)), []
    for row in rows:
        turns = np.linspace(-3.1, 3.0, 20)
        values = np.array([factor(turn, row) for turn in turns])
        crossed = np.flatnonzero(values[1:] * values[:-1] < 0)
        if len(crossed):
            low, high = turns[crossed[0]], turns[crossed[0] + 1]
            zero = brentq(factor, low, high, args=(row,), xtol=1e-14)
            if exact is None:
                low, high = zero - BESIDE, zero + BESIDE
                if determinant(low, row) * determinant(high, row) >= 0:
                    continue  # another factor changes its sign as well
                zero = brentq(determinant, low, high, args=(row,), xtol=1e-14)
            row[joint] = zero + off
            found.append(row)
        if len(found) == count:
            break
    assert len(found) == count
    return np.array(found)


ssik = pytest.importorskip("ssik")


class Ssik:
    """ssik's arm from Pinocchio's joint axes at zero."""

    def __init__(self, robot: Robot) -> None:
        data = robot.model.createData()
        jacobian = pin.computeJointJacobians(robot.model, data, np.zeros(6))
        origins = np.array([data.oMi[i].translation for i in range(1, 7)])
        steps = np.diff(origins, axis=0, prepend=np.zeros((1, 3)))
        self._arm = ssik.Manipulator.from_axes(jacobian[3:].T, np.vstack([steps, np.zeros((1, 3))]))
        self._at_zero, self._tip = data.oMi[6].rotation, robot.tip

    def solutions(self, point: Array, direction: Array, roll: float) -> Array:
        """Joints 1 to 5 (s, 5) of all solutions, each once; any roll must give the same."""
        x = np.cross(direction, np.eye(3)[np.argmin(np.abs(direction))])
        x /= np.linalg.norm(x)
        x = np.cos(roll) * x + np.sin(roll) * np.cross(direction, x)
        return _once(self.whole_solutions(point, direction, x)[:, :5])

    def whole_solutions(self, point: Array, direction: Array, x: Array) -> Array:
        """All joints (s, 6) of all solutions with the tool's z and x axis so, each once."""
        turned = np.column_stack([x, np.cross(direction, x), direction]) @ self._tip[:3, :3].T
        pose = np.eye(4)
        pose[:3, :3] = turned @ self._at_zero.T
        pose[:3, 3] = point - turned @ self._tip[:3, 3]
        found = self._arm.solve(pose, respect_limits=False, enumerate_windings=False)
        return _once(np.array([np.asarray(each.q) for each in found]).reshape(-1, 6))


def _once(solutions: Array) -> Array:
    """Solutions (s, joints) modulo full circles, each once."""
    kept: list[Array] = []
    for q in solutions:
        if all(wrapped(q - other).max() > 1e-6 for other in kept):
            kept.append(q)
    return np.array(kept).reshape(-1, solutions.shape[1])


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
