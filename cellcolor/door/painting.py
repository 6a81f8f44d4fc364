"""``cellcolor.paint``: from a solution to one color per vertex."""

from __future__ import annotations

from os import PathLike

from cellcolor.checker.division import check_solution
from cellcolor.data.solution import Solution
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.result import Result
from cellcolor.door.subject import Solvable, open_subject
from cellcolor.errors import InputError
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import Painted
from cellcolor.painting.paint import paint as paint_solution


def paint(
    source: Solvable,
    solution: Solution | Result | str | PathLike[str],
    *,
    tool_radius_m: float | None = None,
    time_limit: TimeLimit = None,
) -> Painted:
    """Paint every vertex of a surface in the colors of a solution (docs/painting.md).

    Args:
        source: what was solved: a labelled surface, a scene, or an instance that names its
            surface; its file, its shipped name, the value.
        solution: its solution, or the file of one.
        tool_radius_m: of the tool's footprint, for which borders between segments leave room; None
            for the radius of the scene's setup, or else for one mean mesh edge.
        time_limit: seconds, None for no limit.

    Returns:
        A plan that the checker finds valid, on the surface refined where necessary. It has
        exactly as many segments as the solution if these are proved to be the fewest. ``borders``
        says what moving its borders has changed. For a scene the robot is asked about each new
        vertex. If it cannot reach one, the refined surface is solved and painted instead, with as
        many segments as that needs (:mod:`cellcolor.motion.scene_painting`).

    Raises:
        InputError: one of the two cannot be used, they do not belong together, or the radius is not
            positive.
        OutOfTime: the time limit came first.
        TooLarge: the refined mesh would not fit into memory.
    """
    deadline = Deadline.of(time_limit)
    if isinstance(solution, Result):
        solution = solution.solution
    elif not isinstance(solution, Solution):
        solution = Solution.read(solution)
    subject = open_subject(source, deadline)
    surface, decomposition = subject.surface, subject.decomposition
    problems = check_solution(decomposition.instance, solution).problems
    if problems:
        raise InputError(None, None, f"the solution is not valid: {problems[0]}")
    if subject.built is None:
        drawn = paint_solution(surface, decomposition, solution, deadline)
        return move_borders(drawn, tool_radius_m, deadline=deadline)

    from cellcolor.motion.scene_painting import paint_scene

    return paint_scene(
        subject.built,
        decomposition,
        solution,
        tool_radius_m=tool_radius_m,
        deadline=deadline,
    ).painted
