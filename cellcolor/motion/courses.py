"""Tool paths that the arm can follow: laid out, followed, judged, and laid out again."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Index
from cellcolor.data.candidate_table import VALID
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.tool_paths import ToolPath
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.motion.following import Followed, follow
from cellcolor.motion.samples import Samples, sampled
from cellcolor.motion.small_triangles import JUMP, small_triangle_at
from cellcolor.tool_paths.cover import Covered

__all__ = ["Course", "Courses", "Lay", "courses_of"]

_ROUNDS = 3  # of paths laid out; what still fails on the last ones is cut out of them

Lay = Callable[[Collection[tuple[int, int]], Index], Covered]
"""Tool paths, given walls and small triangles to leave out: ``cellcolor.tool_paths.cover``."""


@dataclass(frozen=True)
class Course:
    """A tool path, and the arm on it."""

    path: ToolPath
    samples: Samples
    followed: Followed


@dataclass(frozen=True)
class Courses:
    """The tool paths of all segments, and the arm on them.

    Attributes:
        covered: what was laid out.
        courses: one of each path.
        reasons: of each small triangle that a sample must not be in, the test that fails there.
    """

    covered: Covered
    courses: tuple[Course, ...]
    reasons: dict[int, str]


def courses_of(
    prepared: PreparedScene,
    surface: LabelledSurface,
    branch_of: Sequence[int],
    lay: Lay,
    walls: Collection[tuple[int, int]],
    reasons: dict[int, str],
) -> Courses:
    """Lay out paths, and lay them out again without the places where a sample fails.

    Args:
        prepared: the scene.
        surface: the painted one.
        branch_of: the branch of each color.
        lay: makes tool paths.
        walls: mesh edges that paths do not cross.
        reasons: of each small triangle that is known to be bad, the test that fails there.

    Returns:
        Paths on whose samples hardly anything fails; what still does has to be cut out of them.

    Raises:
        OutOfTime: the deadline of the scene came first.
    """
    reasons = dict(reasons)
    before: dict[tuple[int, bytes], Course] = {}
    for _ in range(_ROUNDS):
        prepared.deadline.check()
        covered = lay(walls, np.array(sorted(reasons), dtype=np.int64))
        courses = []
        for path in covered.paths.paths:
            course = before.get(_key(path))
            if course is None:
                samples = sampled(path)
                course = Course(path, samples, follow(prepared, samples, branch_of[path.color]))
            courses.append(course)
        before = {_key(course.path): course for course in courses}
        failing = {
            small_triangle_at(
                surface, int(course.samples.faces[at]), course.samples.points[at]
            ): why
            for course in courses
            for at, why in _failures(course.followed, prepared.judge.reason_names)
        }
        if failing.keys() <= reasons.keys():
            break
        reasons = failing | reasons
    return Courses(covered, tuple(courses), reasons)


def _key(path: ToolPath) -> tuple[int, bytes]:
    return path.color, path.points.tobytes()


def _failures(followed: Followed, names: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """The samples that fail, and why; of two that are torn from each other both do."""
    for at in np.flatnonzero(followed.reasons != VALID).tolist():
        yield at, names[followed.reasons[at]]
    for at in np.flatnonzero(followed.torn).tolist():
        yield at, JUMP
        yield at + 1, JUMP
