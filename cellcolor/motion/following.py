"""The arm along samples of a tool path: one branch, its angles unwound, every sample judged."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.smooth import Measure, follow_edges
from cellcolor.motion.samples import Samples

__all__ = ["CIRCLE", "Followed", "follow", "joint_limits", "unwound", "whole_turns"]

CIRCLE = 2 * np.pi
_ROUNDING = 1e-9  # rad; an angle on its limit is inside


@dataclass(frozen=True)
class Followed:
    """A branch of the arm along samples.

    Attributes:
        joints: (k, joints) in rad, unwound between neighbors; NaN without solution. Whole turns of
            all of them together are still to be chosen.
        reasons: (k,) codes of the judge: the first test that each sample fails.
        torn: (k - 1,) whether the branch jumps between a sample and the next one.
    """

    joints: Array
    reasons: NDArray[np.uint8]
    torn: Mask

    @property
    def good(self) -> bool:
        """Whether all samples are valid, and none is torn from the next."""
        return bool((self.reasons == VALID).all() and not self.torn.any())


def follow(
    prepared: PreparedScene, samples: Samples, branch: int, deadline: Deadline = NEVER
) -> Followed:
    """Follow a branch, and judge every sample by the tests of the cells.

    Whether the branch jumps between two samples is asked as it is asked of mesh edges
    (``docs/frontend.md``, "Continuity"), so that no jump is ever smoothed over.

    Raises:
        OutOfTime: the deadline came first.
    """
    branches = np.full(len(samples), branch, dtype=np.intp)
    found = prepared.arm.follow(samples.points, -samples.normals, branches)
    verdicts = prepared.judge(found, deadline)
    valid = verdicts.reasons == VALID
    both = np.flatnonzero(valid[:-1] & valid[1:])
    steps = np.column_stack([both, both + 1])
    measure = Measure(
        prepared.setup.continuity,
        prepared.arm.conditioning.near_singular_determinant,
        prepared.kinematics.lever,
    )
    motions = follow_edges(
        Surface(samples.points, np.empty((0, 3), dtype=np.int64), samples.normals),
        steps,
        branches[both],
        (found[both], found[both + 1]),
        (verdicts.determinants[both], verdicts.determinants[both + 1]),
        measure,
        partial(prepared.arm.probe, deadline=deadline),
    )
    torn = np.zeros(len(samples) - 1, dtype=bool)
    torn[both[~motions.smooth]] = True
    return Followed(unwound(found), verdicts.reasons, torn)


def unwound(joints: Array) -> Array:
    """The same angles (k, joints) modulo full circles, each the nearest to the one before it.

    Where there is none (NaN) the next one goes on from the last that there is.
    """
    result = joints.copy()
    there = np.flatnonzero(~np.isnan(joints[:, 0]))
    if len(there):
        result[there] = np.unwrap(joints[there], axis=0)
    return result


def joint_limits(prepared: PreparedScene) -> tuple[Array, Array]:
    """Lower and upper limits (joints,), rad; none if the setup leaves collisions out."""
    robot = prepared.robot
    if prepared.setup.constraints.collision:
        return robot.lower, robot.upper
    return np.full(robot.joints, -np.inf), np.full(robot.joints, np.inf)


def whole_turns(joints: Array, lower: Array, upper: Array) -> tuple[Index, ...] | None:
    """By how many full circles each joint can be turned so that all of a motion is in its limits.

    Args:
        joints: (k, joints) in rad, unwound.
        lower, upper: (joints,) rad.

    Returns:
        For each joint all numbers of circles, ascending; None if there is none for a joint. A joint
        without limits has those that bring its middle next to zero.
    """
    lowest, highest = joints.min(axis=0), joints.max(axis=0)
    choices = []
    for low, high, least, most in zip(lower, upper, lowest, highest, strict=True):
        middle = -np.rint((least + most) / 2 / CIRCLE)
        first = np.ceil((low - least - _ROUNDING) / CIRCLE) if np.isfinite(low) else middle
        last = np.floor((high - most + _ROUNDING) / CIRCLE) if np.isfinite(high) else middle
        if first > last:
            return None
        choices.append(np.arange(int(first), int(last) + 1))
    return tuple(choices)
