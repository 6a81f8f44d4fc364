"""All solutions of poses by Newton's method from many random starts, which knows no closed form.

Five joints put the tip on a point and the tool along a direction. Forward kinematics is a product
of exponentials: what is known of the arm with all joints at zero is moved by a turn about the axis
of each joint, as it is at zero (Brockett, Robotic manipulators and the product of exponentials
formula, 1984). Axes, tip and tool at zero are asked of Pinocchio, and nothing of the product.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from independent import wrapped

from cellcolor.arrays import Array, Index

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
