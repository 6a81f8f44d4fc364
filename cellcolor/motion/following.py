"""The arm along samples of a tool path: one branch, its angles unwound, every sample judged."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.smooth import follow_edges
from cellcolor.motion.samples import Samples

__all__ = ["Followed", "follow", "joint_space", "unwound"]


@dataclass(frozen=True)
class Followed:
    """A branch of the arm along samples.

    Attributes:
        joints: (k, joints) in rad or m, unwound between neighbors; NaN without solution. Whole
            turns of all of them together are still to be chosen.
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
    motions = follow_edges(
        Surface(samples.points, np.empty((0, 3), dtype=np.int64), samples.normals),
        steps,
        branches[both],
        (found[both], found[both + 1]),
        (verdicts.determinants[both], verdicts.determinants[both + 1]),
        prepared.arm.measure,
        partial(prepared.arm.probe, deadline=deadline),
    )
    torn = np.zeros(len(samples) - 1, dtype=bool)
    torn[both[~motions.smooth]] = True
    return Followed(unwound(found, joint_space(prepared)), verdicts.reasons, torn)


def unwound(joints: Array, space: JointSpace) -> Array:
    """The same positions (k, joints) modulo full circles, each the nearest to the one before it.

    Where there is none (NaN) the next one goes on from the last that there is.
    """
    result = joints.copy()
    there = np.flatnonzero(~np.isnan(joints[:, 0]))
    if len(there):
        result[there] = space.unwrap(joints[there])
    return result


def joint_space(prepared: PreparedScene) -> JointSpace:
    """The joints of a scene's arm; without limits if the setup leaves collisions out."""
    robot, limits = prepared.robot, (prepared.robot.lower, prepared.robot.upper)
    if not prepared.setup.constraints.collision:
        limits = np.full(robot.joints, -np.inf), np.full(robot.joints, np.inf)
    return JointSpace.of(robot.slides, *limits, prepared.kinematics.reach)
