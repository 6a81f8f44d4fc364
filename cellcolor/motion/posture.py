"""The best posture among divisions with as few segments (docs/motion.md, "Posture")."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cellcolor.arrays import Array, Mask
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.solution import Preference, Solution
from cellcolor.deadline import Deadline
from cellcolor.decomposition import Decomposition
from cellcolor.errors import InputError, naming
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.reach.validity_tests import Verdicts
from cellcolor.motion.following import joint_space
from cellcolor.solvers.interface import Options
from cellcolor.solvers.other_objectives import cost_of, preferred

_ROOMY = np.pi / 2
"""rad; a joint at least this far from its limits costs nothing."""
_FIRST = 1000.0
"""What a vertex costs more in a branch that is not named, rad."""
_SECONDS = 10.0
"""The most for a proof, which may take any time."""


def with_best_posture(
    built: BuildResult, decomposition: Decomposition, solution: Solution, options: Options
) -> Solution:
    """The solution of a scene with the posture that its setup prefers, and as many segments.

    Args:
        options: deadline, workers and seed; it takes no more than 10 seconds.

    Raises:
        InputError: no branch has the name that is preferred.
        RefusedResult: the checker refuses what was found.
    """
    if solution.cells is None:
        return solution
    prefer, motion = built.scene.setup.prefer, built.scene.setup.motion
    home = None if motion is None or motion.home is None else np.array(motion.home)
    if home is None or prefer.posture == "well-conditioned":
        branch = np.array(built.color_branch, dtype=np.intp)
        costs = color_costs(built.robot, built.verdicts)[:, branch]
    else:
        costs = _from_home(built, home)
    instance = decomposition.instance
    others = np.broadcast_to(np.where(_named(built, prefer.branch), 0.0, 1.0), costs.shape)
    both = _by_cell(built, decomposition, costs + _FIRST * others)
    deadline = Deadline(min(options.deadline.moment, Deadline.after(_SECONDS).moment))
    found, unproved = preferred(instance, solution, both, replace(options, deadline=deadline))
    cost = cost_of(found.cells or (), both)
    outside = cost_of(found.cells or (), _by_cell(built, decomposition, others))
    said = Preference(
        posture="well-conditioned" if home is None else prefer.posture or "near-home",
        cost=max(0.0, cost - _FIRST * outside),
        branch=prefer.branch,
        outside=outside,
        unproved=unproved,
    )
    return replace(found, preference=said)


def _named(built: BuildResult, words: str | None) -> Mask:
    """(colors,) those in branches whose names have all these words; all of them without words."""
    names = [set(built.branches[branch].split()) for branch in built.color_branch]
    found = np.array([set((words or "").split()) <= name for name in names], dtype=bool)
    if names and not found.any():
        with naming(built.prepared.setup.file):
            known = ", ".join(dict.fromkeys(built.branches[b] for b in built.color_branch))
            message = f"no branch that is in use has the words {words!r}; there are {known}"
            raise InputError(None, "prefer.branch", message)
    return found


def _by_cell(built: BuildResult, decomposition: Decomposition, costs: Array) -> Array:
    """(cells, colors) the share of the area of each cell, times its mean cost in each color."""
    cell, areas = np.array(decomposition.vertex_cell, dtype=np.intp), built.surface.vertex_areas
    inside = cell != OUTSIDE
    found = np.zeros((len(decomposition.instance.cells), costs.shape[1]))
    np.add.at(found, cell[inside], areas[inside, None] * costs[inside])
    return np.asarray(found / max(float(areas[inside].sum()), np.finfo(float).tiny))


def _from_home(built: BuildResult, home: Array) -> Array:
    """(n, colors) how far a joint is from home on average, rad; 0 where a color is not.

    A joint that may turn on by full circles is where it is nearest to home within its limits.
    """
    space = joint_space(built.prepared)
    found = []
    for color, branch in enumerate(built.color_branch):
        unwound = built.limits.positions.get(color)
        if unwound is None:
            at = home + space.step(home, built.configurations[:, branch])
            at = at + space.period * ((at < space.lower).astype(float) - (at > space.upper))
        else:
            at = unwound
        found.append(np.abs((at - home) / space.units).mean(axis=1))
    return np.asarray(np.nan_to_num(np.array(found).reshape(len(found), -1).T))


def color_costs(robot: Robot, candidates: Verdicts, greatest: float | None = None) -> Array:
    """How badly conditioned the arm is in each candidate (n, branches), from 0, best, to 1.

    Two things count, and the worse of them: the task determinant as a share of the greatest one,
    and :func:`joint_room`. Candidates that are not valid cost 1.

    Args:
        greatest: the greatest task determinant, m³; None for the greatest one of these candidates.
    """
    valid = candidates.valid
    determinants = np.where(valid, candidates.determinants, 0.0)
    if greatest is None:
        greatest = float(determinants.max(initial=0.0))
    good = determinants / greatest if greatest else determinants
    joints = np.where(valid[:, :, None], candidates.configurations, 0.0)
    return np.asarray(np.where(valid, 1.0 - np.minimum(good, joint_room(robot, joints)), 1.0))


def joint_room(robot: Robot, joints: Array) -> Array:
    """How far the joint that is nearest to its limits is from them, (…,) from 0 to 1.

    It is a share of a quarter turn, or of a quarter of the way between the limits of a prismatic
    joint. Joints may be turned by full circles.

    Args:
        joints: (…, joints) configurations, rad, or m of prismatic joints.
    """
    circle = 2 * np.pi
    # As far from both limits as full circles allow: the middle is the best place. A joint without
    # limits has room everywhere.
    endless = np.isinf(robot.lower)
    lower, upper = np.where(endless, 0.0, robot.lower), np.where(endless, 0.0, robot.upper)
    middle, half = (lower + upper) / 2, np.where(endless, np.inf, (upper - lower) / 2)
    off = np.abs(joints - middle)
    nearest = np.where(robot.slides, off, np.minimum(off % circle, circle - off % circle))
    roomy = np.where(robot.slides, half / 2, _ROOMY)
    return np.asarray(np.clip((half - nearest) / roomy, 0.0, 1.0).min(axis=-1))
