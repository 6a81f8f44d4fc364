"""A scene on finer and finer meshes, until minimum and graph stay the same.

Each step halves the mesh's edges, and quarters those where colors end: either alone makes about
four times as many vertices. The vertices of a step are the first ones of the next. Where two
borders cross, the mesh decides which two of four cells touch, and meshes without common vertices
would decide anew each time. A finer mesh may still decide otherwise, which counts as no change.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.decomposition.isomorphic import isomorphic, without_short_edges
from cellcolor.errors import InputError, TooLarge
from cellcolor.frontend.build import BuildResult, result_of
from cellcolor.frontend.finer_borders import with_finer_borders
from cellcolor.frontend.parts.surface import bisected
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.sizes import MOST_VERTICES
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.memory import check_memory
from cellcolor.questions.refinement import CROSSING, RefinedStep, Refinement

_GROWTH = 3  # of the vertices in a step, at least
_BYTES = 16_000  # for each vertex of a build
_KEY = "continuity.border_length_m"


def refined_until_stable(
    built: BuildResult,
    solve: Callable[[Instance], Solution],
    deadline: Deadline,
    progress: Callable[[str], None] | None = None,
) -> tuple[BuildResult, Refinement]:
    """The scene on finer meshes.

    Args:
        built: the scene on its own mesh.
        solve: solves a graph, by the deadline.
        deadline: when to be content with the steps so far.
        progress: told what is being done.

    Returns:
        The scene on the finest mesh that was solved, and all steps.

    Raises:
        InputError: the scene's own mesh cannot be decomposed.
        OutOfTime: the deadline came before the scene itself was solved.
    """
    surface = built.prepared.surface
    longest = float(surface.lengths(surface.edges()).max())
    given = built.scene.setup.continuity.border_length_m
    border = longest if given is None else min(given, longest)
    steps = [_step(built, solve, deadline, longest, border, None, time.monotonic())]
    refinement = Refinement(tuple(steps))
    while not refinement.stable:
        longest, border, began = longest / 2, border / 4, time.monotonic()
        try:
            _check_room(built)
            finer = _finer(built.prepared, longest, border)
            clock = StageClock(deadline, progress)
            built_finer = result_of(*with_finer_borders(finer, clock), clock)
            step = _step(built_finer, solve, deadline, longest, border, steps[-1], began)
        except OutOfTime:
            return built, Refinement(tuple(steps), "the time limit came first")
        except (InputError, TooLarge) as error:
            return built, Refinement(tuple(steps), f"the next mesh cannot be used, {error}")
        steps.append(step)
        built, refinement = built_finer, Refinement(tuple(steps))
    return built, refinement


def _finer(prepared: PreparedScene, longest: float, border: float) -> PreparedScene:
    """The scene with no mesh edge longer than ``longest``, and shorter ones at borders wanted."""
    surface = prepared.surface
    while (marked := surface.lengths(surface.edges()) > longest).any():
        surface = bisected(surface, marked, _KEY)
    scene = prepared.scene
    setup = scene.setup.varied(continuity={"border_length_m": border}, file=scene.setup.file)
    return replace(prepared, scene=scene.varied(setup=setup, file=scene.file), surface=surface)


def _check_room(built: BuildResult) -> None:
    """Refuse a step that will not fit, before it is begun.

    Raises:
        TooLarge: names the numbers.
    """
    vertices, tolerance = _GROWTH * len(built.surface.vertices), built.scene.tolerance
    if vertices > MOST_VERTICES:
        message = f"it would have {vertices:,} vertices or more, at most {MOST_VERTICES:,} fit"
        raise TooLarge(message)
    places = 1 if tolerance is None else 1 + tolerance.samples
    check_memory(vertices * places * _BYTES, f"{vertices:,} vertices or more")


def _step(
    built: BuildResult,
    solve: Callable[[Instance], Solution],
    deadline: Deadline,
    longest: float,
    border: float,
    before: RefinedStep | None,
    began: float,
) -> RefinedStep:
    """A mesh solved, and compared with the one before."""
    decomposition = decomposition_of(built.surface, deadline=deadline)
    instance = decomposition.instance
    solution = solve(instance)
    same_minimum = same_graph = same_but_crossings = None
    if before is not None:
        proved = all(one.status == "optimal" for one in (solution, before.solution))
        nothing = all(one.nothing_to_cover for one in (instance, before.instance))
        same_minimum = nothing or (proved and solution.segments == before.solution.segments)
        same_graph = isomorphic(before.instance, instance, deadline)
        shorter = CROSSING * before.border_m
        older, newer = (without_short_edges(one, shorter) for one in (before.instance, instance))
        same_but_crossings = same_graph or isomorphic(older, newer, deadline)
    return RefinedStep(
        built.surface,
        instance,
        tuple(decomposition.vertex_cell),
        solution,
        longest,
        border,
        same_minimum,
        same_graph,
        same_but_crossings,
        time.monotonic() - began,
    )
