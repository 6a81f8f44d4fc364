"""``cellcolor.paint`` and ``cover``: a solution as a color per vertex, and as tool paths."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Unpack

import numpy as np

from cellcolor.checker.division import check_solution
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.asked import Work, begun
from cellcolor.door.installed import require_motion
from cellcolor.door.subject import Result, Solvable, open_subject, solution_of
from cellcolor.errors import InputError
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import Painted
from cellcolor.painting.paint import paint as paint_solution

if TYPE_CHECKING:
    from cellcolor.tool_paths.cover import Covered


def paint(
    source: Solvable,
    solution: Solution | Result | str | PathLike[str],
    *,
    time_limit: TimeLimit = None,
) -> Painted:
    """Paint every vertex of a surface in the colors of a solution (docs/motion.md).

    Args:
        source: what was solved: a labelled surface, a scene, or an instance that names its
            surface; its file, its shipped name, the value.
        solution: its solution, or the file of one.
        time_limit: seconds, None for no limit.

    Returns:
        A plan that the checker finds valid, on the surface refined where necessary. It has
        exactly as many segments as the solution if these are proved to be the fewest. For a scene
        the robot is asked about each new vertex. If it cannot reach one, the refined surface is
        solved and painted instead, with as many segments as that needs
        (:mod:`cellcolor.motion.scene_painting`).

    Raises:
        InputError: one of the two cannot be used, or they do not belong together.
        OutOfTime: the time limit came first.
        TooLarge: the refined mesh would not fit into memory.
    """
    deadline = Deadline.of(time_limit)
    solution = solution_of(solution)
    subject = open_subject(source, deadline)
    surface, decomposition = subject.surface, subject.decomposition
    problems = check_solution(decomposition.instance, solution).problems
    if problems:
        raise InputError(None, None, f"the solution is not valid: {problems[0]}")
    if subject.built is None:
        drawn = paint_solution(surface, decomposition, solution, deadline)
        return move_borders(drawn, deadline=deadline)
    from cellcolor.motion.scene_painting import paint_scene

    return paint_scene(subject.built, decomposition, solution, deadline=deadline).painted


def cover(
    surface: LabelledSurface | Painted | str | PathLike[str],
    plan: Plan | str | PathLike[str] | None = None,
    *,
    pattern: str = "contour",
    spacing_m: float,
    tool_radius_m: float,
    **work: Unpack[Work],
) -> Covered:
    """Lay one continuous path on every segment of a painted surface (docs/motion.md).

    Args:
        surface: the painted surface, or its file; or what ``cellcolor.paint`` returns.
        plan: one color for each vertex of it, or the file of that; None with a ``Painted``.
        pattern: of the tool paths: ``contour``; ``back-and-forth``, whose rows may run along a
            vector (``back-and-forth:X,Y,Z``), around an axis (``back-and-forth:around:X,Y,Z``) or
            so that they turn least (``back-and-forth:fewest-turns``); or what another package
            registers.
        spacing_m: desired distance between neighboring passes, m.
        tool_radius_m: of the tool's footprint, m.
        **work: :class:`~cellcolor.door.asked.Work`; told is the name of each stage as it begins.

    Returns:
        The paths, with the area they cover, how often they pass it and what stays uncovered.

    Raises:
        InputError: something cannot be used, or the plan does not fit the surface.
        OutOfTime: the time limit came first.
    """
    deadline, progress = begun(work)
    if isinstance(surface, Painted):
        if plan is not None:
            raise InputError(None, "plan", "is already set by what was painted")
        painted = surface
        surface, plan = painted.surface, painted.plan
    elif not isinstance(surface, LabelledSurface):
        surface = LabelledSurface.read(surface)
    if plan is None:
        raise InputError(None, "plan", "is missing")
    file = None if isinstance(plan, Plan) else str(plan)
    if not isinstance(plan, Plan):
        plan = Plan.read(plan)
    require_motion("tool paths", ("scipy", "potpourri3d"))

    from cellcolor.tool_paths.cover import check_spacing
    from cellcolor.tool_paths.cover import cover as cover_segments
    from cellcolor.tool_paths.region import Segments

    report = check_plan(surface, plan)
    if not report.valid:
        raise InputError(file, None, f"the plan is not valid: {report.problems[0]}")
    segment_of = np.array(report.segment_of, dtype=np.int64)
    colors = [0] * (report.segments or 0)
    for segment, color in zip(report.segment_of, plan.vertex_colors, strict=True):
        if color is not None:
            colors[segment] = color
    check_spacing(surface, segment_of, spacing_m)
    return cover_segments(
        Segments(surface, segment_of, colors, surface.vertex_normals),
        pattern=pattern,
        spacing_m=spacing_m,
        tool_radius_m=tool_radius_m,
        deadline=deadline,
        progress=progress,
    )
