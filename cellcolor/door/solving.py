"""``cellcolor.build``, ``cellcolor.decompose`` and ``cellcolor.solve``."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import TYPE_CHECKING, Any

from cellcolor.checker.division import check_solution
from cellcolor.data.instance import Instance
from cellcolor.data.solution import SearchSpace, Solution
from cellcolor.deadline import Deadline, TimeLimit
from cellcolor.door.result import Result
from cellcolor.door.subject import (
    Solvable,
    build_scene,
    open_subject,
    scene_or_file,
)
from cellcolor.errors import InputError
from cellcolor.solvers import checked
from cellcolor.solvers.interface import Options, Start

if TYPE_CHECKING:
    from cellcolor.frontend import BuildResult, Scene
from dataclasses import replace

from cellcolor.deadline import OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.door.subject import Subject
from cellcolor.solvers.registry import DEFAULT

__all__ = ["build", "decompose", "solve", "start_from"]


_RAW_SECONDS = 10.0  # there are many small cells, and the proof may take for ever


def build(
    scene: str | PathLike[str] | Scene,
    *,
    time_limit: TimeLimit = None,
    progress: Callable[[str], None] | None = None,
) -> BuildResult:
    """Compute which colors reach each point of a robot scene's object.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value.
        time_limit: seconds, None for as long as it takes.
        progress: told the name of each stage as it begins.

    Returns:
        The labelled surface, and what became of every candidate on the way to it.

    Raises:
        InputError: the scene, its setup, a URDF or a mesh cannot be used; names file and field.
        OutOfTime: the time limit came first.
    """
    deadline = Deadline.of(time_limit)
    return build_scene(scene_or_file(scene), deadline, progress)


def decompose(source: Solvable, *, time_limit: TimeLimit = None) -> Instance:
    """The topological graph of a labelled surface or a scene: what ``solve`` solves.

    Args:
        source: its file, its shipped name, or the value; an instance is returned as it is.
        time_limit: seconds, None for as long as it takes.

    Raises:
        InputError: it cannot be used; a cell of the surface is not planar.
        OutOfTime: the time limit came first.
    """
    deadline = Deadline.of(time_limit)
    return open_subject(source, deadline).graph(deadline)


def solve(
    source: Solvable,
    *,
    solver: str = "cp-sat",
    search_space: SearchSpace = "paper",
    strands: int | None = None,
    time_limit: TimeLimit = None,
    workers: int | None = None,
    seed: int = 0,
    fewest_cuts: bool = False,
    start: Solution | Result | str | PathLike[str] | None = None,
    progress: Callable[[int | None, int], None] | None = None,
) -> Result:
    """Find the fewest segments of a scene, a labelled surface or an instance.

    A scene is built and a surface decomposed on the way; the checker sees every result. Where a
    scene's slivers were given up, a note says how many segments there are with them.

    Args:
        source: what to solve: its file, its shipped name (``cellcolor.library``), the value.
        solver: the solver's name; ``dfs`` is the paper's depth-first search, for small instances.
        search_space: ``paper`` for no more than one corridor of a color across an edge, ``surface``
            for several.
        strands: how many, in the search space ``surface``; None for 2.
        time_limit: seconds for all of it, None for as long as it takes.
        workers: CP-SAT's search workers, None for its portfolio.
        seed: of everything random.
        fewest_cuts: of the divisions with the fewest segments find one with the fewest cutting
            paths.
        start: a solution to start from, or its file.
        progress: called with the segments of the best division so far, None before there is one,
            and the lower bound.

    Raises:
        InputError: what is to be solved, or an option, cannot be used.
        OutOfTime: the time limit came before any division was known.
    """
    deadline = Deadline.of(time_limit)
    subject = open_subject(source, deadline)
    instance = subject.graph(deadline)
    given: dict[str, Any] = {} if strands is None else {"strands": strands}
    options = Options(
        search_space,
        **given,
        deadline=deadline,
        workers=workers,
        seed=seed,
        start=None if start is None else start_from(start, instance, strands),
        fewest_cuts=fewest_cuts,
    )
    solution = checked.solve(instance, options, solver, progress)
    solution = _with_raw_minimum(solution, subject, options)
    return Result(solution, subject)


def start_from(
    source: Solution | Result | str | PathLike[str], instance: Instance, strands: int | None
) -> Start:
    """A solution as what a solver starts from.

    Args:
        source: the solution, or its file.
        instance: what is about to be solved.
        strands: those wanted; None for any.

    Raises:
        InputError: it is not a valid solution of this instance with these strands.
    """
    file, solution = None, source
    if isinstance(solution, Result):
        solution = solution.solution
    if not isinstance(solution, Solution):
        file = str(solution)
        solution = Solution.read(solution)
    problems = check_solution(instance, solution).problems
    if problems:
        raise InputError(file, None if file else "start", f"is not valid: {problems[0]}")
    if solution.cells is None:
        raise InputError(file, "cells", "holds no division to start from")
    if strands is not None and solution.strands != strands:
        raise InputError(file, "strands", f"is {solution.strands}, wanted are {strands}")
    return Start(solution.cells, solution.seams)


def _with_raw_minimum(solution: Solution, subject: Subject, options: Options) -> Solution:
    """The solution with a note on the whole surface, where a scene's slivers were given up.

    Args:
        solution: of the scene without its slivers.
        subject: what was solved.
        options: how; the raw surface gets ten seconds of the time that is left.
    """
    raw = None if subject.built is None else subject.built.raw_surface
    coverage = subject.graph().coverage
    if raw is None or coverage is None:
        return solution
    deadline = Deadline(min(options.deadline.moment, Deadline.after(_RAW_SECONDS).moment))
    asked = replace(options, deadline=deadline, start=None, fewest_cuts=False)
    try:
        graph = decomposition_of(raw, deadline=deadline).instance
        found = str(checked.solve(graph, asked, DEFAULT))
    except OutOfTime:
        found = "no division was found in time"
    except InputError as error:
        found = f"it cannot be solved, {error}"
    note = (
        f"{coverage.given_up:.1%} of the area was given up as slivers; with nothing given up: "
        f"{found}"
    )
    return replace(solution, notes=(*solution.notes, note))
