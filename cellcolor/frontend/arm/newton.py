"""Newton's method on the arm as its URDF has it: candidates of a closed form become solutions.

The task has five rows, the tip's position and the tool's direction, and the last of six joints is
locked, so that five joints are left. Of a calibrated arm a closed form only knows the ideal
geometry; from there a few steps lead to the true one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.matching import farthest as largest_turn
from cellcolor.frontend.arm.kinematics import TASK_JOINTS, Poses, forward, task_jacobian
from cellcolor.frontend.arm.robot import Robot, TaskSpace
from cellcolor.frontend.arm.signs import BRANCHES, Signs
from cellcolor.memory import chunks

REACHED = 1e-9  # m, and for the unit vector of the tool's direction: what counts as a solution
_STEPS = 25
_GOOD = 1e-12  # m and rad; nothing is gained from there on
_LARGEST = 0.3  # rad; no step moves a joint farther
SAME = 1e-6  # rad; two solutions nearer than this are one
_ELBOW_AND_WRIST = 3  # the bits of both in a branch's index


def misses(poses: Poses, points: Array, directions: Array) -> Array:
    """By how much poses miss their targets, (k,): the larger of position in m and direction."""
    off = np.linalg.norm(poses.tip - points, axis=1)
    return np.asarray(np.maximum(off, np.linalg.norm(poses.tool_axis - directions, axis=1)))


def polished(
    robot: Robot,
    starts: Array,
    points: Array,
    directions: Array,
    farthest: float,
    steps: int = _STEPS,
) -> Array:
    """The solutions that starts lead to, in (-pi, pi].

    Steps are damped by the square of what is left to go (Levenberg and Marquardt), which near a
    singularity keeps them short and elsewhere leaves the convergence quadratic. The last joint is
    locked, and keeps its angle wherever that is.

    Args:
        starts: (n, s, joints) in rad, NaN where there is none.
        points: (n, 3) where the tip has to be, m.
        directions: (n, 3) unit vectors of the tool.
        farthest: what misses by more at the start is not tried; see :func:`misses`.

    Returns:
        (n, s, joints) in rad, NaN where the tip or the direction misses by more than ``REACHED``.
    """
    found = np.full_like(starts, np.nan)
    there = np.nonzero(~np.isnan(starts[:, :, 0]))
    for part in chunks(len(there[0])):
        pose, number = (index[part] for index in there)
        start = starts[pose, number]
        end = _polished(robot, start, points[pose], directions[pose], farthest, steps)
        turned = np.pi - np.mod(np.pi - end, 2 * np.pi)
        turned[:, -1] = np.where(np.isnan(end[:, 0]), np.nan, start[:, -1])
        found[pose, number] = turned
    return found


def _polished(
    robot: Robot, start: Array, points: Array, directions: Array, farthest: float, steps: int
) -> Array:
    q, missed = start.copy(), np.empty(len(start))
    rows, most = np.arange(len(start)), farthest
    for step in range(steps + 1):
        poses = forward(robot, q[rows])
        wanted = directions[rows] if robot.task.direction else poses.tool_axis
        missed[rows] = misses(poses, points[rows], wanted)
        going = np.flatnonzero((missed[rows] > _GOOD) & (missed[rows] <= most))
        if step == steps or not len(going):
            break
        rows, poses, most = rows[going], poses.take(going), np.inf
        q[rows, :TASK_JOINTS] += _step(poses, points[rows], wanted[going], robot.task)
    q[~(missed <= REACHED)] = np.nan
    return q


def _step(poses: Poses, points: Array, directions: Array, task: TaskSpace) -> Array:
    rows, across = task_jacobian(poses)
    turn = np.cross(poses.tool_axis, directions)
    error = np.concatenate([points - poses.tip, np.einsum("nij,nj->ni", across, turn)], axis=1)
    if not task.direction:
        rows, error = rows[:, :3], error[:, :3]
    # A half turn has no unique axis, and its cross product is zero: that is no solution.
    damping = np.minimum(np.einsum("ni,ni->n", error, error), 1e-3)
    gram = rows @ rows.transpose(0, 2, 1) + (damping + 1e-14)[:, None, None] * np.eye(rows.shape[1])
    step = (rows.transpose(0, 2, 1) @ np.linalg.solve(gram, error[:, :, None]))[:, :, 0]
    longest = np.abs(step).max(axis=1, keepdims=True)
    return np.asarray(step * np.minimum(1.0, _LARGEST / np.maximum(longest, _LARGEST)))


def nearest(solutions: Array, others: Array) -> Array:
    """How far each of some solutions (n, s, joints) is from the nearest of others (n, t, joints).

    Returns:
        The largest difference of a joint, of the first five, modulo full circles, (n, s) in rad.
        It is infinite where there is no other, and where there is no solution.
    """
    found = np.full(solutions.shape[:2], np.inf)
    for other in range(others.shape[1]):
        there = others[:, other, None, :TASK_JOINTS]
        found = np.fmin(found, largest_turn(there, solutions[:, :, :TASK_JOINTS]))
    return found


def merged(solutions: Array) -> Array:
    """Solutions (n, s, joints) with each once, those that there are first, NaN after them.

    Angles are compared modulo full circles, and the first of equal ones stays. Joints after the
    fifth only turn the tool about its axis, and are not compared.
    """
    packed = _packed(solutions, ~np.isnan(solutions[:, :, 0]))
    kept = ~np.isnan(packed[:, :, 0])
    for rows in chunks(len(packed), packed.shape[1]):
        five, own = packed[rows, :, :TASK_JOINTS], kept[rows]
        for later in range(1, five.shape[1]):
            off = largest_turn(five[:, later : later + 1], five[:, :later])
            own[:, later] &= ~((off < SAME) & own[:, :later]).any(axis=1)
    return _packed(packed, kept)


def _packed(solutions: Array, kept: Mask) -> Array:
    """Those of the solutions that are kept, first ones first, NaN after them."""
    order: NDArray[np.intp] = np.argsort(~kept, axis=1, kind="stable")
    order = order[:, : int(kept.sum(axis=1).max(initial=0))]
    rows = np.arange(len(kept))[:, None]
    packed = solutions[rows, order]
    packed[~kept[rows, order]] = np.nan
    return np.asarray(packed)


@dataclass(frozen=True, kw_only=True)
class Polished:
    """All solutions of an arm, from candidates that are next to them.

    Attributes:
        closed_form: points (k, 3) in m and unit vectors (k, 3) to candidates (k, s, joints) in rad,
            NaN where there is none. Given ``branches`` (k,) it may leave out all others.
        farthest: by how much a candidate may miss, m, and for unit vectors.
        signs: what names the solutions; None if they have no names.
        at_a_time: how many configurations a pose takes while it is solved.
    """

    robot: Robot
    closed_form: Callable[..., Array]
    farthest: float
    signs: Signs | None = None
    at_a_time: int = 16

    def solve(self, points: Array, directions: Array, branches: Index | None = None) -> Array:
        """See :meth:`cellcolor.frontend.arm.inverse.InverseKinematics.solve`."""
        if branches is None or self.signs is None:
            return self._every(points, directions)
        return self._one_each(points, directions, branches, self.signs)[:, None]

    def remarks(self, points: Array, directions: Array) -> tuple[str, ...]:  # noqa: ARG002
        """See :meth:`cellcolor.frontend.arm.inverse.InverseKinematics.remarks`."""
        return ()

    def starts(self, points: Array, directions: Array) -> Array:
        """Configurations (n, s, joints) in rad that lead to all solutions, NaN for none."""
        return self.closed_form(points, directions)

    def _named(self, solutions: Array, signs: Signs) -> Array:
        """Solutions (n, s, joints) under their names (n, 8, joints), as many as there is room for.

        Round an aligned wrist a pose of a calibrated arm can have two with the same signs, and more
        than eight in all. The one with the larger determinant has the name. The other one takes
        that of the same shoulder and the same sign of the determinant if it is free.
        """
        pose, number = np.nonzero(~np.isnan(solutions[:, :, 0]))
        solved = solutions[pose, number]
        branches, determinants = signs.branches(self.robot, solved)
        slots = pose * len(BRANCHES) + branches
        found = np.full((len(solutions) * len(BRANCHES), solutions.shape[2]), np.nan)
        left = np.argsort(-determinants, kind="stable")
        for flipped in (0, _ELBOW_AND_WRIST):
            slot, first = np.unique(slots[left] ^ flipped, return_index=True)
            free = np.isnan(found[slot, 0])
            found[slot[free]] = solved[left[first[free]]]
            there = found[slots[left], None]
            left = left[nearest(solved[left, None], there)[:, 0] > SAME]
        return found.reshape(len(solutions), len(BRANCHES), -1)

    def _every(self, points: Array, directions: Array) -> Array:
        """All solutions, (n, 8, joints) by their names or (n, s, joints) without."""
        parts = [np.empty((0, len(BRANCHES) if self.signs else 0, self.robot.joints))]
        for rows in chunks(len(points), self.at_a_time):
            asked = points[rows], directions[rows]
            found = polished(self.robot, self.starts(*asked), *asked, self.farthest)
            parts.append(merged(found) if self.signs is None else self._named(found, self.signs))
        return stacked(parts)

    def _one_each(self, points: Array, directions: Array, branches: Index, signs: Signs) -> Array:
        """The solution (n, joints) of one branch of each pose; the others are not polished.

        Only where the branch of a candidate is not that of its solution, or none has the one asked
        for, are all solutions found.
        """
        candidates = self.closed_form(points, directions, branches=branches)
        pose, number = np.nonzero(~np.isnan(candidates[:, :, 0]))
        own = signs.branches(self.robot, candidates[pose, number])[0] == branches[pose]
        rows, first = np.unique(pose[own], return_index=True)
        starts = candidates[rows, number[own][first]][:, None]
        ends = polished(self.robot, starts, points[rows], directions[rows], self.farthest)[:, 0]
        known = np.flatnonzero(~np.isnan(ends[:, 0]))
        known = known[signs.branches(self.robot, ends[known])[0] == branches[rows[known]]]
        found = np.empty((len(points), self.robot.joints))
        found[rows[known]] = ends[known]
        left = np.setdiff1d(np.arange(len(points)), rows[known])
        if len(left):
            every = self._every(points[left], directions[left])
            found[left] = every[np.arange(len(left)), branches[left]]
        return found


def stacked(parts: Sequence[Array]) -> Array:
    """Solutions (k, s, joints) of parts of the poses, one part after the other, NaN for none."""
    most = max(part.shape[1] for part in parts)
    widened = [
        np.pad(part, ((0, 0), (0, most - part.shape[1]), (0, 0)), constant_values=np.nan)
        for part in parts
    ]
    return np.concatenate(widened)
