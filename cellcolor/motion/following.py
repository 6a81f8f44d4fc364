"""The arm along samples of a tool path: one branch, its angles unwound, every sample judged."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Mask, angles_between, cuts
from cellcolor.data.candidate_table import VALID
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.smooth import follow_edges
from cellcolor.motion.samples import Samples

_ROUNDING = 1e-6  # m
_OFF = 4e-4  # m, of the tip off the surface; the judge allows a millimeter
_FAR_TURN, _FAR_SLIDE = float(np.deg2rad(1.0)), 0.001  # rad, m; what no joint passes untested
_TILT = float(np.deg2rad(0.6))  # of the tool's axis off the normal; the judge allows a degree


@dataclass(frozen=True)
class Followed:
    """A branch of the arm along samples.

    Attributes:
        joints: (k, joints) in rad or m, unwound between neighbors; NaN without solution. Whole
            turns of all of them together are chosen later.
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

    The test for jumps between two samples is that for mesh edges (``docs/frontend.md``,
    "Continuity"), so no jump is ever smoothed over.

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


def off_way(robot: Robot, joints: Array, samples: Samples) -> Mask:
    """Which configurations (k, joints) have tip or axis off the sample (k) that they are meant for.

    Of the tip only the distance along the normal counts.
    """
    poses = forward(robot, joints)
    lifted = np.einsum("ij,ij->i", poses.tip - samples.points, samples.normals)
    off = np.abs(lifted) > _OFF
    if robot.task.direction:
        off |= angles_between(poses.tool_axis, -samples.normals) > _TILT
    return np.asarray(off)


def blocked(prepared: PreparedScene, joints: Array, asked: Mask, deadline: Deadline) -> Mask:
    """Steps (k - 1,) of samples (k, joints) between which a configuration fails a test.

    Where a joint moves far on a step, the arm passes configurations that no sample has.

    Args:
        asked: (k - 1,) the steps to be tested; none has a missing end.
    """
    farthest = np.where(prepared.robot.slides, _FAR_SLIDE, _FAR_TURN)
    ways = np.diff(joints, axis=0)
    sizes = (np.abs(ways) / farthest).max(axis=1, initial=0.0) - _ROUNDING
    step, place = cuts(np.where(asked, sizes, 0.0))
    between = joints[step] + place[:, None] * ways[step]
    found = np.zeros(len(ways), dtype=bool)
    found[step[prepared.judge(between, deadline).reasons != VALID]] = True
    return found


def unwound(joints: Array, space: JointSpace) -> Array:
    """The same positions (k, joints) modulo full circles, each the nearest to the one before it.

    After a missing position (NaN) the next one continues from the last known one.
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
    return JointSpace.of(robot.slides, *limits, prepared.arm.kinematics.reach)
