"""Where ``cellcolor.new`` puts the part before the arm, and where the arm begins and ends."""

from __future__ import annotations

from collections import Counter
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from cellcolor.deadline import Deadline
from cellcolor.errors import InputError

if TYPE_CHECKING:
    from cellcolor.arrays import Array, Index
    from cellcolor.frontend.prepared import PreparedScene
    from cellcolor.frontend.reach.prepared_arm import PreparedArm
    from cellcolor.frontend.reach.validity_tests import Verdicts
    from cellcolor.frontend.scene import Scene

_MOST_ASKED = 300  # vertices of the part, wherever it is tried
_FARTHER, _HIGHER = (0.45, 0.6, 0.75), (0.02, 0.2, 0.4)
"""Places that are tried: of the part's middle before the robot, and of its lowest point above the
ground, as shares of the arm's reach."""
_UP, _BELOW = 0.6, (0.8, 0.6, 0.4)
"""An arm whose first joint is higher than the first share hangs, or stands on something. Then the
part's highest point lies so far below that joint."""
_WORST = 0.1  # of the points count for how well they are reached
_ABOVE = (0.1, 0.15, 0.05, 0.2)  # m; so far over the part the arm waits, the first that is free
_NEARLY = 0.9  # of what the best posture covers


def best_place(
    scene: Scene, arm: PreparedArm, deadline: Deadline
) -> tuple[PreparedScene, Verdicts]:
    """The scene with the part where the arm reaches it best.

    Of nine places before the robot that is the one where most of the part can be reached, then most
    of it in one posture, then where this posture is farthest from limits and singularities at the
    worst tenth of the points.

    Args:
        scene: with the part's file in the origin.

    Returns:
        The scene, and the verdicts (n, branches) on some vertices there.

    Raises:
        InputError: nothing of it can be reached anywhere.
    """
    from cellcolor.frontend.arm.kinematics import forward
    from cellcolor.frontend.prepared import prepare

    vertices = scene.placement.placed(scene.object.surface(scene.folder, deadline).vertices)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    middle, reach = (low + high) / 2, arm.kinematics.reach
    x, y, z = forward(arm.robot, np.zeros((1, arm.robot.joints))).origin[0, 1].tolist()
    heights = [share * reach - low[2] for share in _HIGHER]
    if z > _UP * reach:
        heights = [max(z - share * reach - high[2], -low[2]) for share in _BELOW]
    tried: list[tuple[PreparedScene, Verdicts]] = []
    prepared: PreparedScene | None = None
    fault: InputError | None = None
    for far, height in product(_FARTHER, heights):
        position = x + far * reach - middle[0], y - middle[1], height
        try:
            place = scene.placement.varied(position_m=(np.round(position, 3) + 0.0).tolist())
            if prepared is None:
                prepared = prepare(scene.varied(placement=place), deadline)
            else:
                prepared = prepared.at(prepared.scene.varied(placement=place))
        except InputError as error:  # such as a part that would stand in the robot
            fault = error
            continue
        surface = prepared.surface
        step = -(-len(surface.vertices) // _MOST_ASKED)
        solved = prepared.arm.inverse(surface.vertices[::step], -surface.normals[::step], deadline)
        tried.append((prepared, prepared.judge(solved, deadline)))
    if not tried:
        assert fault is not None
        raise fault
    greatest = max(
        float(verdicts.determinants[verdicts.valid].max(initial=0.0)) for _, verdicts in tried
    )
    best, found = max(
        tried, key=lambda one: _merit(one[0], one[1], greatest)
    )  # the first of several
    if not found.valid.any():
        codes = Counter(code for _, verdicts in tried for code in verdicts.reasons.ravel().tolist())
        commonest = found.reason_names[codes.most_common(1)[0][0]]
        message = (
            "nothing of the part can be reached at any of nine places before the robot; most often "
            f"a posture fails by {commonest!r}: does the part's outside face the robot "
            "(--outside flip), and is its size one for this arm?"
        )
        raise InputError(None, None, "; ".join([message, *best.robot.warnings]))
    return best, found


def _merit(
    prepared: PreparedScene, verdicts: Verdicts, greatest: float
) -> tuple[float, float, float]:
    """What a better place has more of: reach, reach in one posture, and distance to limits.

    Args:
        greatest: task determinant of all places, m³.
    """
    from cellcolor.motion.posture import color_costs

    valid, good = verdicts.valid, 1.0 - color_costs(prepared.robot, verdicts, greatest)
    if not prepared.arm.named:  # columns are no postures
        valid = np.asarray(valid.any(axis=1, keepdims=True))
        good = good.max(axis=1, keepdims=True)
    shares, worst = valid.mean(axis=0).round(2), np.quantile(good, _WORST, axis=0)
    share = float(valid.any(axis=1).mean().round(2))
    return share, *max(zip(shares.tolist(), worst.tolist(), strict=True))


def home_over(prepared: PreparedScene, covers: Array) -> tuple[list[float], str] | None:
    """A free, well-conditioned position over the part's middle, rad, and its posture in words.

    The tool points at the part. Of the postures that cover nearly as much as the best one, the one
    whose joints are nearest to the middle of their limits. None if there is none.

    Args:
        covers: (branches,) the share of the part that each covers.
    """
    from cellcolor.motion.free_space import FreeSpace
    from cellcolor.motion.limits import motion_of

    surface, arm = prepared.surface, prepared.arm
    middle = (surface.vertices.min(axis=0) + surface.vertices.max(axis=0)) / 2
    nearest: Index = np.argsort(np.linalg.norm(surface.vertices - middle, axis=1))[:3]
    free = FreeSpace(prepared, motion_of(prepared).clearance_m)
    lower, upper = (np.clip(limit, -np.pi, np.pi) for limit in free.space.limits)
    names = arm.kinematics.branches if arm.named else ()
    for above in _ABOVE:
        points = surface.vertices[nearest] + above * surface.normals[nearest]
        found = arm.inverse(points, -surface.normals[nearest])
        branch = np.tile(np.arange(found.shape[1]), len(nearest))
        tried = np.round(found.reshape(-1, found.shape[2]), 2)
        good = ~np.isnan(tried[:, 0])
        if names:
            good &= (covers >= _NEARLY * covers.max())[branch]
        rows = np.flatnonzero(good)
        rows = rows[prepared.judge(tried[rows]).valid]
        rows = rows[free(tried[rows])]
        if len(rows):
            best = rows[np.argmin(free.space.largest(tried[rows] - (lower + upper) / 2))]
            where = f"{1e3 * above:g} mm over the part"
            posture = f"{names[branch[best]]}, {where}" if names else where
            return [float(angle) + 0.0 for angle in tried[best]], posture
    return None
