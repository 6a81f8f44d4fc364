"""The arm along samples of a tool path: one branch, its angles unwound, every sample judged.

Samples are evenly spaced, at most 1 mm and 1 degree apart. Where a joint is fast, beside a
singularity, :mod:`~cellcolor.motion.segment` puts more between. The degree is measured with the
path's own normals. With those of the surface, which the samples get, neighbors beside a sharp edge
can be a little farther apart: 1.13 degrees at most on the parts of docs/parts.md. The judge of
trajectories tests between them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask, angles_between, cuts, to_nearest
from cellcolor.data.candidate_table import VALID
from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.parts.surface import Surface
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.smooth import follow_edges
from cellcolor.mesh.triangle_mesh import TriangleMesh

DISTANCE = 0.001  # m, at most from one sample to the next
TURN = float(np.deg2rad(1.0))  # rad, the same for the normal
_NEAR = 0.025  # of both; so near to a corner that is asked for no other sample is needed
_ROOM = 0.95  # of both, for rounding and for normals that are not a path's own


@dataclass(frozen=True)
class Samples:
    """Points of a tool path, in its order.

    Attributes:
        points: (k, 3) m.
        normals: (k, 3) outward unit normals.
        faces: (k,) a triangle that each point lies in.
    """

    points: Array
    normals: Array
    faces: Index

    def __len__(self) -> int:
        return len(self.points)


def normals_at(mesh: TriangleMesh, normals: Array, faces: Index, points: Array) -> Array:
    """The unit normals (k, 3) that a surface has at points (k, 3) of its triangles (k,).

    Those of a path are interpolated from point to point. Where a normal turns quickly, as beside a
    sharp edge, they are a degree or more off those of the triangles.

    Args:
        normals: (n, 3) outward, at its vertices; of any length, which counts between them.
    """
    shares = mesh.shares(faces, points)
    turned = np.einsum("ki,kij->kj", shares, normals[mesh.corners[faces]])
    return np.asarray(turned / np.linalg.norm(turned, axis=1, keepdims=True))


def even_places(path: ToolPath, corners: Index | None = None) -> Array:
    """Places (k,) of samples all along a path, both ends among them.

    A place is the way from the path's beginning, in shares of what samples may be apart, along the
    path or by the turn of the normal; the larger share counts. Corners of the path are samples only
    where they are asked for: a chord cuts them by less than half a millimeter.

    Args:
        corners: numbers of points of the path.
    """
    passed = np.concatenate([[0.0], np.cumsum(_shares(path))])
    even = np.linspace(0.0, passed[-1], max(int(np.ceil(passed[-1])), 1) + 1)
    if corners is None or not len(corners):
        return even
    at = np.unique(passed[corners])
    needed = to_nearest(even, at) > _NEAR
    needed[[0, -1]] = True
    return np.union1d(even[needed], at)


def sampled(path: ToolPath, places: Array) -> tuple[Array, Index]:
    """The points (k, 3) at places on a path, and the triangle (k,) that each lies in."""
    share = _shares(path)
    passed = np.concatenate([[0.0], np.cumsum(share)])
    step = np.clip(np.searchsorted(passed, places, side="right") - 1, 0, len(share) - 1)
    part = ((places - passed[step]) / np.where(share[step] > 0, share[step], 1.0))[:, None]
    return (1 - part) * path.points[step] + part * path.points[step + 1], path.faces[step]


def _shares(path: ToolPath) -> Array:
    """The way between neighbors of a path, as a share of what samples may be apart."""
    lengths = np.linalg.norm(np.diff(path.points, axis=0), axis=1)
    turns = angles_between(path.normals[:-1], path.normals[1:])
    # A chord between unit normals is passed fastest, as an angle, in its middle.
    fastest = 2 * np.tan(np.minimum(turns, 0.99 * np.pi) / 2)
    return np.asarray(np.maximum(lengths / DISTANCE, fastest / TURN) / _ROOM)


_BOW = 0.3  # of the way between two samples, for the tip: where normals turn fast, steps are short
_BOW_ANGLE = float(np.deg2rad(0.5))  # of the tool's axis
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
    prepared: PreparedScene,
    samples: Samples,
    branch: int,
    deadline: Deadline = NEVER,
    together: int | None = None,
) -> Followed:
    """Follow a branch, and judge every sample by the tests of the cells.

    The test for jumps between two samples is that for mesh edges (``docs/frontend.md``,
    "Continuity"), so no jump is ever smoothed over.

    Args:
        together: so many samples are a way of their own; None for one way.
    """
    branches = np.full(len(samples), branch, dtype=np.intp)
    found = prepared.arm.follow(samples.points, -samples.normals, branches)
    verdicts = prepared.judge(found, deadline)
    valid = verdicts.reasons == VALID
    both = np.flatnonzero(valid[:-1] & valid[1:])
    if together is not None:  # a straight line from one way to the next can pass a singularity
        both = both[(both + 1) % together != 0]
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


def bowed(robot: Robot, joints: Array) -> Mask:
    """Steps (k - 1,) of samples (k, joints) in whose middle the tool is off its way.

    Between two samples every joint moves evenly. Beside a singularity, where joints turn by much on
    a millimeter, the tool bows off the way from one sample to the next.
    """
    ends, middle = forward(robot, joints), forward(robot, (joints[:-1] + joints[1:]) / 2)
    off = np.linalg.norm(middle.tip - (ends.tip[:-1] + ends.tip[1:]) / 2, axis=1)
    too_far = _BOW * np.linalg.norm(np.diff(ends.tip, axis=0), axis=1) + _ROUNDING
    axis = ends.tool_axis[:-1] + ends.tool_axis[1:]
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return np.asarray((off > too_far) | (angles_between(middle.tool_axis, axis) > _BOW_ANGLE))


def off_way(
    robot: Robot, joints: Array, points: Array, normals_of: Callable[[Array], Array]
) -> Mask:
    """Which configurations (k, joints) have tip or axis off the points (k, 3) they are meant for.

    Of the tip only the distance along the normal counts. The axis is compared with the normal where
    the tip is: beside a sharp edge a normal turns by degrees on a tenth of a millimeter.

    Args:
        normals_of: gives unit normals of the surface at points (k, 3) near these.
    """
    poses = forward(robot, joints)
    normals = normals_of(poses.tip)
    off = np.abs(np.einsum("ij,ij->i", poses.tip - points, normals)) > _OFF
    if robot.task.direction:
        off |= angles_between(poses.tool_axis, -normals) > _TILT
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
    return JointSpace(robot.slides, *limits, prepared.arm.kinematics.reach)
