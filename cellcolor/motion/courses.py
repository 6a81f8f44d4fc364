"""Tool paths that the arm can follow: laid out, followed, judged, and laid out again."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.arrays import Array
from cellcolor.data.candidate_table import VALID
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.motion.following import (
    Followed,
    Samples,
    blocked,
    bowed,
    even_places,
    follow,
    joint_space,
    off_way,
    sampled,
    unwound,
    with_normals_of,
)
from cellcolor.motion.small_triangles import JUMP, ArmRefusals
from cellcolor.tool_paths.cover import Covered

_ROUNDS = 5  # of paths laid out; what still fails on the last ones is cut out of them
_FARTHEST = 0.4  # rad, m; of a joint from a sample to the next
_HALVINGS = 9  # of a step in which one goes farther, or the tool leaves its way
_BETWEEN = (0.25, 0.5, 0.75)  # of a step, where that is tested


@dataclass(frozen=True)
class Course:
    """A tool path, and the arm on it."""

    path: ToolPath
    samples: Samples
    followed: Followed


def laid_out(
    prepared: PreparedScene,
    surface: LabelledSurface,
    normals: Array,
    branch: int,
    lay: Callable[[], Covered],
    refusals: ArmRefusals,
    deadline: Deadline,
) -> tuple[Covered, list[Course]]:
    """Lay out the paths of a segment, and again without the places where a sample fails.

    Args:
        normals: (n, 3) outward, at its vertices; of any length, which counts between them.
        refusals: where these do not go; it is told where samples fail.

    Returns:
        What was laid out, and the arm on each path. Hardly any sample fails; the caller cuts out
        those that still do.
    """
    for left in reversed(range(_ROUNDS)):
        covered = lay()
        courses, good = [], True
        for path, corners in zip(covered.paths.paths, covered.along_border, strict=True):
            places = even_places(path, corners)
            course = _course(prepared, path, places, surface, normals, branch, deadline)
            samples = course.samples
            courses.append(course)
            good &= course.followed.good
            for at, why in _failures(course.followed, prepared.judge.reason_names):
                if left:
                    refusals.add(int(samples.faces[at]), samples.points[at], why)
        if good:
            break
    return covered, courses


def _course(
    prepared: PreparedScene,
    path: ToolPath,
    places: Array,
    surface: LabelledSurface,
    normals: Array,
    branch: int,
    deadline: Deadline,
) -> Course:
    """A branch along a path, with samples so close that joints may move evenly between them.

    A step is halved where a joint moves far, as beside a singularity, where the tool leaves its way
    or the surface's normal between the samples, as beside a sharp edge, and where a configuration
    between them fails a test. A step that still does on the last round is torn.
    """

    def at(places: Array) -> Samples:
        return with_normals_of(sampled(path, places), surface.mesh, normals)

    samples = at(places)
    followed = follow(prepared, samples, branch, deadline)
    for halvings in range(_HALVINGS + 1):
        joints, reasons, torn = followed.joints, followed.reasons, followed.torn
        valid = reasons == VALID
        bad = np.abs(np.diff(joints, axis=0)).max(axis=1) > _FARTHEST
        bad |= bowed(prepared.robot, joints)
        for share in _BETWEEN:
            way = joints[:-1] + share * np.diff(joints, axis=0)
            inner = places[:-1] + share * np.diff(places)
            bad |= off_way(prepared.robot, way, sampled(path, inner), surface.mesh, normals)
        ends = valid[:-1] & valid[1:] & ~torn
        bad &= ends
        if not bad.any():
            bad = blocked(prepared, joints, ends, deadline)
        rows = np.flatnonzero(bad)
        if not len(rows) or halvings == _HALVINGS:
            break
        # Only the new samples are followed, each between its neighbors.
        middle = (places[rows] + places[rows + 1]) / 2
        threes = np.column_stack([places[rows], middle, places[rows + 1]]).ravel()
        between = follow(prepared, at(threes), branch, deadline)
        places = np.insert(places, rows + 1, middle)
        joints = np.insert(joints, rows + 1, between.joints[1::3], axis=0)
        torn = torn.copy()
        torn[rows] = between.torn[::3]
        followed = Followed(
            unwound(joints, joint_space(prepared)),
            np.insert(reasons, rows + 1, between.reasons[1::3]),
            np.insert(torn, rows + 1, between.torn[1::3]),
        )
        samples = at(places)
    return Course(path, samples, replace(followed, torn=followed.torn | bad))


def _failures(followed: Followed, names: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """The samples that fail, and why; of two that are torn from each other both do."""
    for at in np.flatnonzero(followed.reasons != VALID).tolist():
        yield at, names[followed.reasons[at]]
    for at in np.flatnonzero(followed.torn).tolist():
        yield at, JUMP
        yield at + 1, JUMP
