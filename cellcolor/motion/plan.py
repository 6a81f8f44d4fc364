"""From a painting to a trajectory: tool paths that the arm can follow, and the arm on them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.stage_clock import Progress, StageClock
from cellcolor.motion.assembly import assembled
from cellcolor.motion.courses import Course, Courses, courses_of
from cellcolor.motion.following import joint_limits
from cellcolor.motion.limits import home_of, motion_of, speeds_of
from cellcolor.motion.order import ordered
from cellcolor.motion.small_triangles import corner_states, left_out_parts, small_triangles
from cellcolor.motion.strokes import Parting, Stroke, cut_where_full, trimmed
from cellcolor.motion.transfers import Transfers
from cellcolor.painting.paint import Painted
from cellcolor.tool_paths.cover import Covered, cover
from cellcolor.tool_paths.registry import DEFAULT_PATTERN

__all__ = ["MotionPlan", "plan_motion"]


@dataclass(frozen=True)
class MotionPlan:
    """A motion over a painted surface.

    Attributes:
        paths: the tool paths that the trajectory follows.
        measures: of these paths, see :mod:`cellcolor.tool_paths`.
        trajectory: the arm on them.
        seconds: wall time of each stage.
    """

    paths: ToolPaths
    measures: Any
    trajectory: Trajectory
    seconds: dict[str, float] = field(compare=False)


def plan_motion(
    prepared: PreparedScene,
    built: BuildResult,
    painted: Painted,
    normals: Array,
    *,
    pattern: str = DEFAULT_PATTERN,
    seed: int = 0,
    deadline: Deadline = NEVER,
    progress: Progress | None = None,
) -> MotionPlan:
    """Plan a motion that covers a painted surface (docs/motion.md).

    Args:
        prepared: the scene.
        built: what was built of it.
        painted: its surface in segments.
        normals: (n, 3) outward unit normals at the vertices of the painted surface.
        pattern: of the tool paths.
        seed: of the sampling planner; the same seed gives the same motion.
        deadline: when to give up.
        progress: told the name of each stage as it begins.

    Raises:
        InputError: the setup has no motion, or one that does not fit the arm, or the arm can
            follow no path at all.
        OutOfTime: the deadline came first.
    """
    motion = motion_of(prepared)
    clock = StageClock(deadline, progress)
    surface, segment_of = painted.surface, painted.segment_of
    color_of = _colors(painted)
    branch_of = built.stages.cleaned.coloring.branch
    with clock.timed("corners of small triangles"):
        small = small_triangles(surface.vertices, surface.faces, normals, segment_of)
        own_branch = np.array([branch_of[color] for color in color_of], dtype=np.int64)
        states = corner_states(prepared, small, own_branch)

    def lay(walls: Collection[tuple[int, int]], left_out: Index) -> Covered:
        return cover(
            surface,
            segment_of,
            color_of,
            normals,
            pattern=pattern,
            spacing_m=motion.spacing_m,
            tool_radius_m=motion.tool_radius_m,
            walls=walls,
            left_out=left_out,
            deadline=deadline,
        )

    with clock.timed("tool paths"):
        reasons = states.bad(prepared.judge.reason_names)
        courses = courses_of(prepared, surface, branch_of, lay, (), reasons)
    strokes = _strokes(prepared, courses, branch_of, motion.spacing_m)
    if not strokes:
        raise InputError(None, "segment_of", "the arm can follow no path on any segment")
    with clock.timed("order of strokes"):
        speeds, home = speeds_of(motion, prepared.robot), home_of(motion)
        limits = joint_limits(prepared)
        strokes = ordered(strokes, limits, speeds.velocities, home, deadline)
    with clock.timed("transfers"):
        planner = Transfers(prepared, motion, speeds.velocities, seed, deadline)
        strokes, transfers = planner.between_strokes(strokes)
    with clock.timed("times"):
        trajectory = assembled(
            surface.name,
            prepared.robot,
            strokes,
            transfers,
            speeds,
            motion.speed_m_per_s,
            left_out_parts(small, courses.reasons),
            {"pattern": pattern, "seed": seed},
            deadline,
        )
    covered = courses.covered
    return MotionPlan(covered.paths, covered.measures, trajectory, clock.seconds)


def _colors(painted: Painted) -> list[int]:
    """The color of each segment, 0 for numbers that no vertex has."""
    colors = [0] * (int(painted.segment_of.max(initial=-1)) + 1)
    for segment, color in zip(painted.segment_of.tolist(), painted.plan.vertex_colors, strict=True):
        if segment >= 0 and color is not None:
            colors[segment] = color
    return colors


def _strokes(
    prepared: PreparedScene, courses: Courses, branch_of: Sequence[int], shortest: float
) -> list[Stroke]:
    """The strokes on all paths: what fails is cut out, and what overruns a limit is cut there."""
    limits, robot = joint_limits(prepared), prepared.robot
    found: list[Stroke] = []
    for course in courses.courses:
        color, segment = course.path.color, course.path.segment
        parts = trimmed(
            segment,
            branch_of[color],
            course.samples,
            course.followed,
            shortest,
            prepared.judge.reason_names,
        )
        if parts and any(stroke.segment == segment for stroke in found):
            parts[0] = replace(parts[0], parting=_apart(course))
        for part in parts:
            found += cut_where_full(part, *limits, robot.joint_names)
    return found


def _apart(course: Course) -> Parting:
    """Why a segment has a second path."""
    x, y, z = course.path.points[0].tolist()
    text = "places that no sample may touch part the segment"
    return Parting("trimmed", text, (x, y, z))
