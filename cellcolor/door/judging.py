"""``check`` for solutions and trajectories; ``judge``, ``proven_range`` for others' plans."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from os import PathLike
from typing import Any, Unpack, overload

from cellcolor.checker.claimed_numbers import contradictions
from cellcolor.checker.division import Report, check_solution
from cellcolor.checker.groups import regions_on_surface
from cellcolor.data.solution import Solution
from cellcolor.data.trajectory import Trajectory, TrajectoryTable
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.data.wording import lift_offs_of
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.asked import Search
from cellcolor.door.installed import extras_for, find_claim
from cellcolor.door.oracle import SECONDS, AnyPlan, Oracle
from cellcolor.door.reading import ReadTrajectory, read_claim
from cellcolor.door.subject import Result, Solvable, Subject, open_subject, solution_of
from cellcolor.oracle import ProvenRange, Verdict, prove
from cellcolor.questions.places import Place


@overload
def check(
    instance: Solvable, solution: Solution | Result, *, left_alone: Place | None = None
) -> Report: ...


@overload
def check(
    instance: Solvable,
    solution: Trajectory,
    *,
    left_alone: Place | None = None,
    time_limit: TimeLimit = 60.0,
) -> TrajectoryVerdict: ...


@overload
def check(
    instance: Solvable,
    solution: str | PathLike[str],
    *,
    left_alone: Place | None = None,
    time_limit: TimeLimit = 60.0,
) -> Any: ...


def check(
    instance: Solvable,
    solution: Solution | Result | Trajectory | str | PathLike[str],
    *,
    left_alone: Place | None = None,
    time_limit: TimeLimit = 60.0,
) -> Report | TrajectoryVerdict:
    """Check a solution or judge a trajectory, by code that is independent of solver and planner.

    A solution's division is checked, and every number in it. It must not contradict what the
    instance says is known (``known``). Lower bounds are verified by their certificates; a bound
    without one is trusted unless something contradicts it (docs/semantics.md). An instance that
    names its surface is compared with it, if the surface is available. A trajectory is judged by
    its scene, and its lift-offs are compared with the proven minimum
    (docs/judging-trajectories.md).

    Args:
        instance: what was solved: an instance, a labelled surface or a scene; its file, its
            shipped name, the value. A scene for a trajectory.
        solution: the solution, the trajectory, or the file of one of them, of a shipped solution
            its name; tables of trajectories are told by their suffix, ``.csv``.
        left_alone: vertices of the surface that were left out on purpose: a mask (n,), a
            :class:`~cellcolor.questions.places.WorldBox`, or what a labelled surface gives up, such
            as ``instance.surface.json`` of a plan.
        time_limit: seconds for a trajectory, including building the scene; None for no limit.

    Returns:
        A solution's report has what is wrong (``problems``, each naming its element), the segments
        counted, and for each bound whether it was verified. For a trajectory it is the verdict.
        For a file the type is ``Any``.

    Raises:
        InputError: one of the two cannot be used.
        OutOfTime: the time limit came before there was a verdict on a trajectory.
    """
    claim: Any = solution
    if isinstance(solution, (str, PathLike)):
        claim = read_claim(find_claim(solution), (Solution, Trajectory))
    if isinstance(claim, (Trajectory, TrajectoryTable)):
        deadline = Deadline.of(time_limit)
        subject = open_subject(instance, deadline).left_alone(left_alone)
        return judge_trajectory(subject, claim, deadline)
    subject = open_subject(instance).left_alone(left_alone)
    subject.check_graph()
    graph = subject.graph()
    claim = solution_of(claim)
    regions = None
    if subject.given_surface is not None:
        cells = subject.decomposition.vertex_cell
        regions = regions_on_surface(subject.given_surface, cells)
    report = check_solution(graph, claim, regions)
    if not report.valid:
        return report
    return replace(report, problems=tuple(contradictions(graph, claim)))


def judge_trajectory(
    subject: Subject,
    given: ReadTrajectory,
    deadline: Deadline,
    progress: Callable[[str], None] | None = None,
) -> TrajectoryVerdict:
    """The verdict on a trajectory for a scene, with the proven minimum if it is found in time.

    Raises:
        InputError: the subject is no scene, or the trajectory is of another arm.
        OutOfTime: the deadline came before there was a verdict.
    """
    built = subject.build()
    with extras_for("the front end"):
        from cellcolor.trajectory_checker.check import check_trajectory
        from cellcolor.trajectory_checker.stated import completed

    report = progress or (lambda _: None)
    timed = isinstance(given, Trajectory) or "time_s" in given.columns
    silent = isinstance(given, TrajectoryTable)
    if isinstance(given, TrajectoryTable):
        given = completed(given, built.robot, deadline)
    report("proven minimum")
    # Half of the time is for the judge: it has a verdict whatever is proved.
    bounds = prove(built.surface, deadline.share(0.5)).bounds
    return check_trajectory(
        built,
        given,
        timed=timed,
        minimum_lift_offs=lift_offs_of(bounds.lower) if bounds.exact else None,
        silent=silent,
        deadline=deadline,
        progress=progress,
    )


def proven_range(surface: Solvable, **search: Unpack[Search]) -> ProvenRange:
    """The proven range of the fewest segments of a labelled surface.

    Args:
        surface: a labelled surface or a scene: its file, its shipped name, the value.
        **search: :class:`~cellcolor.door.asked.Search`. The time limit is 60 s if it is left out;
            both ends hold however early it ends.

    Raises:
        InputError: the surface or an option cannot be used.
        OutOfTime: the time limit came before there was a surface.
    """
    search["time_limit"] = Deadline.of(search.get("time_limit", SECONDS))  # one for all of it
    return Oracle(surface, **search).bounds


def judge(
    surface: Solvable,
    plan: AnyPlan,
    *,
    bounds: ProvenRange | None = None,
    time_limit: TimeLimit = 60.0,
) -> Verdict:
    """The verdict on a plan: is it valid, how many segments has it, can it be beaten?

    For several plans on one surface keep a
    :class:`cellcolor.Oracle <cellcolor.door.oracle.Oracle>`.

    Args:
        surface: a labelled surface, a scene, or an instance that names its surface; its file, its
            shipped name, the value.
        plan: one color per vertex, its number or its name, None exactly where the vertex has none;
            in an array of integers, which cannot hold None, -1. Or a plan, a solution, or the file
            of one; for a scene also a plan in joint angles
            (:meth:`cellcolor.Oracle.judge <cellcolor.door.oracle.Oracle.judge>`).
        bounds: this surface's ``cellcolor.proven_range``, if known already.
        time_limit: seconds for all of it, above all for finding the range otherwise; None for as
            long as it takes.

    Raises:
        BeatenBound: the plan is valid and beats the lower bound; cellcolor is wrong.
        InputError: surface or plan cannot be used.
        OutOfTime: the time limit came before there was a surface.
    """
    deadline = Deadline.of(time_limit)
    return Oracle(open_subject(surface, deadline), bounds=bounds).judge(plan, deadline=deadline)
