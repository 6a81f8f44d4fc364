"""Newton's method on the arm as its URDF has it: candidates of a closed form become solutions.

The task has five rows, the tip's position and the tool's direction, and the last of six joints is
locked, so that five joints are left. Of a calibrated arm a closed form only knows the ideal
geometry; from there a few steps lead to the true one.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.arm.kinematics import (
    TASK_JOINTS,
    Poses,
    forward,
    task_jacobian,
)
from cellcolor.frontend.arm.robot import Robot, TaskSpace
from cellcolor.frontend.arm.signs import BRANCHES, Signs
from cellcolor.memory import chunks

REACHED = 1e-9  # m, and for the unit vector of the tool's direction: what counts as a solution
_STEPS = 25
_GOOD = 1e-12  # m and rad; nothing is gained from there on
_LARGEST = 0.3  # rad; no step moves a joint farther
SAME = 1e-6  # rad; two solutions nearer than this are one
_FOLDED = 0.05  # smallest singular value; below it two solutions are about to meet
_APART = 0.1  # rad, to both sides of there


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
        steps: how many are made at most.

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


def both_sides_of_folds(robot: Robot, candidates: Array) -> Array:
    """Candidates (k, s, joints), and two more beside each that is next to a singularity.

    There two solutions meet, and where the ideal arm just does not reach the true one may have
    both. They lie on both sides, in the direction in which the task does not move.

    Returns:
        (k, 3 s, joints) in rad, NaN where there is none.
    """
    shape = candidates.shape
    flat = candidates.reshape(-1, shape[2])
    beside = np.full((2, *flat.shape), np.nan)
    there = np.flatnonzero(~np.isnan(flat[:, 0]))
    rows, _ = task_jacobian(forward(robot, flat[there]))
    _, sizes, turned = np.linalg.svd(rows)
    folded = sizes[:, -1] < _FOLDED
    for side, way in zip(beside, (_APART, -_APART), strict=True):
        side[there[folded]] = flat[there[folded]]
        side[there[folded], :TASK_JOINTS] += way * turned[folded, -1]
    return np.concatenate([candidates, *beside.reshape(2, *shape)], axis=1)


def nearest(solutions: Array, others: Array) -> Array:
    """How far each of some solutions (n, s, joints) is from the nearest of others (n, t, joints).

    Returns:
        The largest difference of a joint, of the first five, modulo full circles, (n, s) in rad.
        It is infinite where there is no other, and where there is no solution.
    """
    found = np.full(solutions.shape[:2], np.inf)
    for other in range(others.shape[1]):
        off = solutions[:, :, :TASK_JOINTS] - others[:, other, None, :TASK_JOINTS]
        found = np.fmin(found, _largest_turn(off))
    return found


def _largest_turn(angles: Array) -> Array:
    """The largest of the last axis, absolute and modulo full circles."""
    largest: Array = np.abs(np.remainder(angles + np.pi, 2 * np.pi) - np.pi).max(axis=-1)
    return largest


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
            off = _largest_turn(five[:, :later] - five[:, later : later + 1])
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


_EXACT = 1e-4  # m, and for unit vectors; by how much a closed form's candidate may miss


def exact_solutions(
    robot: Robot, candidates: Array, points: Array, directions: Array, signs: Signs | None
) -> Array:
    """Solutions of an arm whose closed form is its own.

    Args:
        candidates: (n, s, joints) in rad, NaN where there is none.
        points: (n, 3) where the tip has to be, m.
        directions: (n, 3) unit vectors of the tool.
        signs: what names them.

    Returns:
        (n, 8, joints) by branch, or (n, s, joints) without signs, each solution once.
    """
    solutions = polished(robot, candidates, points, directions, _EXACT)
    if signs is None:
        return merged(solutions)
    named, solved, slots, _ = named_slots(robot, solutions, signs)
    # The first of those with one name: of a pair that meets the signs are chance.
    named[slots[::-1]] = solved[::-1]
    return named.reshape(len(points), len(BRANCHES), robot.joints)


def followed_solutions(
    robot: Robot,
    candidates: Array,
    points: Array,
    directions: Array,
    signs: Signs,
    branches: NDArray[np.intp],
) -> Array:
    """The solution (n, joints) of one branch (n,) a pose; the others are not polished.

    Only where the signs of a candidate are not those of its solution, or none has the branch's, are
    all solutions found. See :func:`exact_solutions`.
    """
    pose, number = np.nonzero(~np.isnan(candidates[:, :, 0]))
    own = signs.branches(robot, candidates[pose, number])[0] == branches[pose]
    rows, first = np.unique(pose[own], return_index=True)
    starts = candidates[rows, number[own][first]][:, None]
    ends = polished(robot, starts, points[rows], directions[rows], _EXACT)[:, 0]
    known = np.flatnonzero(~np.isnan(ends[:, 0]))
    known = known[signs.branches(robot, ends[known])[0] == branches[rows[known]]]
    found = np.empty((len(points), robot.joints))
    found[rows[known]] = ends[known]
    left = np.setdiff1d(np.arange(len(points)), rows[known])
    every = exact_solutions(robot, candidates[left], points[left], directions[left], signs)
    found[left] = every[np.arange(len(left)), branches[left]]
    return found


def named_slots(robot: Robot, solutions: Array, signs: Signs) -> tuple[Array, Array, Index, Array]:
    """Room for the solutions (n, s, joints) by name, and where each of them belongs.

    Returns:
        An empty table (n * 8, joints), and of each solution that there is, pose by pose, the angles
        (k, joints), the row of the table that its signs lead to, and its determinant.
    """
    pose, number = np.nonzero(~np.isnan(solutions[:, :, 0]))
    solved = solutions[pose, number]
    sign, determinants = signs.branches(robot, solved)
    empty = np.full((len(solutions) * len(BRANCHES), solutions.shape[2]), np.nan)
    return empty, solved, pose * len(BRANCHES) + sign, determinants
