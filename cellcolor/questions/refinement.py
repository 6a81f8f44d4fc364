"""Solves a scene on finer and finer meshes until minimum and graph stay the same.

Each step halves the largest edge length of the mesh, and quarters it where colors end. Either alone
makes about four times as many vertices. The first vertices of each mesh are those of the one
before. Where two borders cross, the mesh decides which two of the four cells touch; with new
vertices throughout, each mesh would decide that again. If a finer mesh still decides differently,
that does not count as a change.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
from cellcolor.deadline import Deadline, OutOfTime
from cellcolor.decomposition import decomposition_of
from cellcolor.decomposition.isomorphic import isomorphic, without_short_edges
from cellcolor.errors import InputError, TooLarge
from cellcolor.frontend.build import BuildResult, result_of
from cellcolor.frontend.parts.surface import bisected
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.sizes import MOST_VERTICES
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import with_finer_borders
from cellcolor.memory import check_memory

_ALIKE = 2
"""How many times in a row minimum and graph have to stay the same."""

_CROSSING = 2.0
"""Topological edges shorter than this many times ``border_m`` count as one point, a crossing of
borders that the mesh has pulled apart."""

_GROWTH = 3  # least factor by which a step multiplies the vertices
_BYTES = 16_000  # memory for each vertex of a build
_KEY = "continuity.border_length_m"


@dataclass(frozen=True, eq=False)
class RefinedStep:
    """A scene solved on one mesh.

    Attributes:
        surface: the labelled surface. Its first vertices are those of the step before.
        instance: its topological graph.
        vertex_cell: (n,) the cell of each vertex.
        solution: of the graph, accepted by the checker.
        mesh_edge_m: length of the longest mesh edge allowed, m.
        border_m: the same for mesh edges where a color ends, m.
        same_minimum: whether both this step's minimum and that of the step before are proved, and
            they are equal; None for the first step.
        same_graph: whether the graph is isomorphic to that of the step before; None for the first.
        same_but_crossings: whether the two graphs are isomorphic after contracting every edge that
            is shorter than ``_CROSSING`` times ``border_m`` of the step before; None for the first.
        seconds: wall time of building, decomposing and solving.
    """

    surface: LabelledSurface
    instance: Instance
    vertex_cell: tuple[int, ...]
    solution: Solution
    mesh_edge_m: float
    border_m: float
    same_minimum: bool | None
    same_graph: bool | None
    same_but_crossings: bool | None
    seconds: float

    @property
    def same(self) -> bool:
        """Whether nothing changed since the step before, except which cells touch at crossings."""
        return bool(self.same_minimum and self.same_but_crossings)

    def __str__(self) -> str:
        found, bound = self.solution.segments, self.solution.lower_bound
        minimum = "no division" if found is None else count(found, "segment")
        if found != bound:
            minimum += f" (at least {bound})"
        text = (
            f"{len(self.surface.vertices):,} vertices, edges to {1e3 * self.mesh_edge_m:.3g} mm, "
            f"at borders to {1e3 * self.border_m:.3g} mm: {count(len(self.instance.cells), 'cell')}"
            f", {count(len(self.instance.edges), 'edge')}, {minimum}"
        )
        if self.same_graph is None:
            return text
        if self.same:
            return f"{text}; the same{'' if self.same_graph else ' but where borders cross'}"
        known = self.same_minimum or found == bound
        changed = [] if self.same_minimum else ["another minimum" if known else "minimum not known"]
        changed += [] if self.same_but_crossings else ["another graph"]
        return f"{text}; {', '.join(changed)}"

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "vertices": len(self.surface.vertices),
            "mesh_edge_m": self.mesh_edge_m,
            "border_m": self.border_m,
            "cells": len(self.instance.cells),
            "edges": len(self.instance.edges),
            "segments": self.solution.segments,
            "lower_bound": self.solution.lower_bound,
            "same_minimum": self.same_minimum,
            "same_graph": self.same_graph,
            "same_but_crossings": self.same_but_crossings,
            "seconds": self.seconds,
        }


@dataclass(frozen=True, eq=False)
class Refinement:
    """Steps from the scene's own mesh to finer ones.

    Attributes:
        steps: one or more.
        ended_by: why there are no further steps although the result is not stable; "" if it is.
    """

    steps: tuple[RefinedStep, ...]
    ended_by: str = ""

    @property
    def stable(self) -> bool:
        """Whether minimum and graph stayed the same over the last ``_ALIKE`` steps."""
        return len(self.steps) > _ALIKE and all(step.same for step in self.steps[-_ALIKE:])

    @property
    def verdict(self) -> str:
        """The outcome in a sentence or two."""
        first, last = (len(self.steps[place].surface.vertices) for place in (0, -1))
        if not self.stable:
            return f"Not stable up to {last:,} vertices: {self.ended_by}."
        since = len(self.steps[-1 - _ALIKE].surface.vertices)
        exact = all(step.same_graph for step in self.steps[-_ALIKE:])
        crossings = "" if exact else " (but for which cells touch where borders cross)"
        over = count(len(self.steps), "mesh", "meshes")
        return (
            f"Minimum and graph{crossings} stayed the same from {since:,} to {last:,} vertices, "
            f"over the last {1 + _ALIKE} of {over} from {first:,}. This is evidence that they are "
            "those of the part; what is proved is proved of the last mesh."
        )

    def __str__(self) -> str:
        lines = [f"step {number}: {step}" for number, step in enumerate(self.steps)]
        return "\n".join([*lines, self.verdict])

    def to_document(self) -> dict[str, Any]:
        """The JSON object."""
        return {
            "stable": self.stable,
            "ended_by": self.ended_by,
            "steps": [step.to_document() for step in self.steps],
        }


def refined_until_stable(
    built: BuildResult, solve: Callable[[Instance], Solution], deadline: Deadline
) -> tuple[BuildResult, Refinement]:
    """Solve the scene on finer and finer meshes.

    Args:
        built: the scene on its own mesh.
        solve: solves a graph by the deadline.
        deadline: when to return the steps so far.

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
            clock = StageClock(deadline, None)
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
    """The scene with no mesh edge longer than ``longest``, and a setup that asks for ``border``."""
    surface = prepared.surface
    while (marked := surface.lengths(surface.edges()) > longest).any():
        surface = bisected(surface, marked, _KEY)
    scene = prepared.scene
    setup = scene.setup.varied(continuity={"border_length_m": border}, file=scene.setup.file)
    return replace(prepared, scene=scene.varied(setup=setup, file=scene.file), surface=surface)


def _check_room(built: BuildResult) -> None:
    """Refuse a step that would be too large, before it begins."""
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
    """Solve a mesh and compare it with the one before."""
    decomposition = decomposition_of(built.surface, deadline=deadline)
    instance = decomposition.instance
    solution = solve(instance)
    same_minimum = same_graph = same_but_crossings = None
    if before is not None:
        proved = all(one.status == "optimal" for one in (solution, before.solution))
        nothing = all(one.nothing_to_cover for one in (instance, before.instance))
        same_minimum = nothing or (proved and solution.segments == before.solution.segments)
        same_graph = isomorphic(before.instance, instance, deadline)
        shorter = _CROSSING * before.border_m
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
