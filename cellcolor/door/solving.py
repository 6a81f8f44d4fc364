"""``cellcolor.build``, ``cellcolor.decompose`` and ``cellcolor.solve``, of all or of a part."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from math import degrees
from os import PathLike
from typing import TYPE_CHECKING, Unpack

import numpy as np

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, SearchSpace, Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import check_share
from cellcolor.deadline import Deadline, OutOfTime, TimeLimit
from cellcolor.decomposition import decomposition_of
from cellcolor.door.asked import SearchOfAPart, Work, begun, options_of
from cellcolor.door.subject import Result, Solvable, Subject, open_subject, scene_of
from cellcolor.errors import InputError, TooLarge
from cellcolor.questions.places import Place
from cellcolor.solvers import checked
from cellcolor.solvers.interface import STRANDS, Options, Start
from cellcolor.solvers.registry import DEFAULT

if TYPE_CHECKING:
    from cellcolor.frontend import BuildResult, Scene

_FOR_FRONT = 0.5  # of the time that is left
_BESIDE_SECONDS = 10.0  # there are many small cells, and the proof may take for ever


def build(scene: str | PathLike[str] | Scene, **work: Unpack[Work]) -> BuildResult:
    """Compute which colors reach each point of a robot scene's object.

    Needs the extra ``frontend``.

    Args:
        scene: its file, its shipped name, or the value.
        **work: :class:`~cellcolor.door.asked.Work`; told is the name of each stage as it begins.

    Returns:
        The labelled surface, and what became of every candidate on the way to it.

    Raises:
        InputError: the scene, its setup, a URDF or a mesh cannot be used; names file and field.
        OutOfTime: the time limit came first.
    """
    deadline, progress = begun(work)
    return open_subject(scene_of(scene), deadline, progress).build()


def decompose(source: Solvable, *, time_limit: TimeLimit = None) -> Instance:
    """The topological graph of a labelled surface or a scene: what ``solve`` solves.

    Args:
        source: its file, its shipped name, or the value; an instance is returned as it is.
        time_limit: seconds, None for no limit.

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
    progress: Callable[[int | None, int], None] | None = None,
    **asked: Unpack[SearchOfAPart],
) -> Result:
    """Find the fewest segments of a scene, a labelled surface or an instance.

    A scene is built and a surface decomposed on the way; the checker sees every result. Where a
    scene's slivers were given up, a note says how many segments there are with them. Where
    something is left out on purpose, the result is of the rest, and so is its ``subject``.

    Args:
        source: what to solve: its file, its shipped name (``cellcolor.library``), the value.
        solver: the solver's name; ``dfs`` is the paper's depth-first search, for small instances,
            and ``dfs-cover`` the same search with a bound.
        search_space: ``paper`` for no more than one corridor of a color across an edge, ``surface``
            for several.
        strands: how many, in the search space ``surface``; None for 2.
        progress: called with the segments of the best division so far, None before there is one,
            and the lower bound.
        **asked: :class:`~cellcolor.door.asked.SearchOfAPart`.

    Raises:
        InputError: what is to be solved, or an option, cannot be used.
        OutOfTime: the time limit came before any division was found.
    """
    options = options_of(asked, SearchOfAPart)
    check_share("cover", asked.get("cover"))
    subject = open_subject(source, options.deadline)
    of = asked.get("cover"), asked.get("left_alone")
    subject, left_out, share = rest_of(subject, *of, options)
    instance = subject.graph(options.deadline)
    options = replace(
        options,
        search_space=search_space,
        strands=STRANDS.get(search_space, 1) if strands is None else strands,
    )
    solution = checked.solve(instance, options, solver, progress)
    if subject.built is not None:
        from cellcolor.motion.posture import with_best_posture

        solution = with_best_posture(subject.built, subject.decomposition, solution, options)
    notes = (*left_out, *solution.notes)
    if subject.built is not None:
        notes += tuple(_on_scene(subject.built, solution, options))
    return Result(replace(solution, notes=notes), subject, share)


def _on_scene(built: BuildResult, solution: Solution, options: Options) -> Iterator[str]:
    """Notes on what a scene's minimum depends on: tolerance, slivers, and cuts at joint limits.

    A color that winds around is cut in a few places. Wherever it is cut, the minimum without joint
    limits is a lower bound.
    """
    tolerance = built.scene.tolerance
    if tolerance is not None:
        yield (
            f"Colors hold where the part should stand and at a sample of {tolerance.samples} "
            f"displacements by {1e3 * tolerance.position_m:g} mm and "
            f"{degrees(tolerance.rotation_rad):g} degrees; between them nothing was asked."
        )
    if built.raw_surface is not None:
        areas = built.raw_surface.vertex_areas
        slivers = areas[built.slivers].sum() / areas.sum()
        found = _solved_beside(built.raw_surface, options)
        yield f"{slivers:.1%} of the area was given up as slivers; with nothing given up: {found}"
    if built.modulo_surface is not None:
        found = _solved_beside(built.modulo_surface, options)
        least = found.surface_lower_bound if isinstance(found, Solution) else 0
        needed = "as many segments are" if least == solution.segments else f"at least {least} are"
        note = "Colors that wind around are cut where the joint limits are; wherever they are cut, "
        yield f"{note}{needed} needed."


def _solved_beside(surface: LabelledSurface, options: Options) -> Solution | str:
    """The minimum of another surface, in at most ten seconds; or why there is none."""
    deadline = Deadline(min(options.deadline.moment, Deadline.after(_BESIDE_SECONDS).moment))
    asked = replace(options, deadline=deadline)
    try:
        graph = decomposition_of(surface, deadline=deadline).instance
        return checked.solve(graph, asked, DEFAULT)
    except OutOfTime:
        return "no division was found in time"
    except InputError as error:
        return f"it cannot be solved, {error}"


def rest_of(
    subject: Subject, cover: float | None, place: Place | None, options: Options
) -> tuple[Subject, tuple[str, ...], float]:
    """A subject without what is left out on purpose.

    Args:
        cover: the share of the area that can be covered and is not left alone which has to be, 0 to
            1; None for all of it. What is best left out is settled first, as by ``tradeoff``.
        place: what must not be covered, see ``Subject.left_alone``.
        options: deadline, workers and seed of the search for what is best left out, which takes
            half of the time that is left.

    Returns:
        What has to be covered, as a subject like any other; notes on what is left out, a sentence
        each; and the share that has to be covered.

    Raises:
        InputError: the place is of another mesh, or there is no surface for it to be on; or no
            division is known that covers as much.
        OutOfTime: the deadline came before any division was known.
    """
    notes: tuple[str, ...] = ()
    if place is not None:
        whole = subject.surface
        subject = subject.left_alone(place)
        left = sorted(set(subject.surface.given_up) - set(whole.given_up))
        share = whole.vertex_areas[left].sum() / whole.vertex_areas.sum()
        notes = (f"{share:.1%} of the surface can be covered and is left alone on purpose.",)
    if cover is None or subject.graph(options.deadline).nothing_to_cover:
        return subject, notes, 1.0
    from cellcolor.questions.tradeoff import front_of  # imports a solver

    options = replace(options, deadline=options.deadline.share(_FOR_FRONT))
    choice = front_of(subject.graph(options.deadline), options).fewest_for(cover)
    why = f"{100 * cover:.1f} % of what can be covered is asked for"
    notes += (f"{why}; covered with {choice}. The rest is left out on purpose.",)
    left_out = choice.point.left_out
    if left_out and subject.given_instance is not None:
        graph, _ = subject.given_instance.without_cells(left_out)
        subject = Subject(None, given_instance=graph)
    elif left_out:
        cells = subject.decomposition.vertex_cell
        subject = subject.without_vertices(np.isin(cells, left_out))
    return subject, notes, choice.point.covered_share


def with_schemes(
    instance: Instance,
    solution: Solution,
    solver: str,
    options: Options,
    most: int,
    take: Callable[[Division], None],
) -> Solution:
    """A solution with its optimal schemes counted.

    One more than the most that are wanted is looked for: only so is it known whether there are
    others. A solver may end the search at any moment by an ``OutOfTime``; schemes that were taken
    beyond ``schemes`` of the result do not count.

    Args:
        solution: of the instance, in the search space ``paper``. If its number is not proved, no
            scheme is looked for.
        most: how many are wanted.
        take: given each scheme.

    Raises:
        InputError: the solver lists no schemes, or none of this instance.
        RefusedResult: the checker refuses what the solver found.
    """
    if solution.status != "optimal" or solution.segments is None:
        return replace(solution, schemes=0, complete=False)
    started = time.monotonic()
    found, complete, notes = 0, True, solution.notes
    counted: list[int] = []
    known = None if solution.cells is None else Start(solution.cells, solution.seams)
    try:
        for division in checked.enumerate_schemes(
            instance, options, solver, solution.segments, known, counted.append
        ):
            if found == most:
                complete = False
                break
            take(division)
            found += 1
    except OutOfTime:
        complete = False
    except TooLarge as error:
        complete, notes = False, (*notes, str(error))
    if not complete and counted:
        notes = (*notes, f"There are {counted[0]:,} optimal schemes; {found:,} of them are listed.")
    seconds = solution.seconds + time.monotonic() - started
    return replace(solution, schemes=found, complete=complete, seconds=seconds, notes=notes)
