"""How the minimum and the graph of a scene fare on finer meshes: one step after the other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count

ALIKE = 2
"""So many times in a row minimum and graph have to stay the same."""

CROSSING = 2.0
"""Edges up to so many times the length at borders may be a crossing that the mesh has parted."""


@dataclass(frozen=True, eq=False)
class RefinedStep:
    """A scene solved on one mesh.

    Attributes:
        surface: the labelled surface. Its first vertices are those of the step before.
        instance: its topological graph.
        vertex_cell: (n,) the cell of each vertex.
        solution: of the graph; the checker has passed it.
        mesh_edge_m: no mesh edge is longer.
        border_m: no mesh edge where a color ends is longer.
        same_minimum: whether the minimum is proved, here and in the step before, and the same;
            None for the first step.
        same_graph: whether the graph is isomorphic to that of the step before; None for the first.
        same_but_crossings: whether the graphs are isomorphic once edges are drawn together to
            points that are shorter than ``CROSSING`` times ``border_m`` of the step before.
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
        """Whether nothing has changed since the step before but which cells touch at crossings."""
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
        steps: one at least.
        ended_by: why there is no further step though minimum and graph have not stayed the same;
            "" if they have.
    """

    steps: tuple[RefinedStep, ...]
    ended_by: str = ""

    @property
    def stable(self) -> bool:
        """Whether minimum and graph have stayed the same so often as they have to."""
        return len(self.steps) > ALIKE and all(step.same for step in self.steps[-ALIKE:])

    @property
    def verdict(self) -> str:
        """What came of it, a sentence or two."""
        first, last = (len(self.steps[place].surface.vertices) for place in (0, -1))
        if not self.stable:
            return f"Not stable up to {last:,} vertices: {self.ended_by}."
        since = len(self.steps[-1 - ALIKE].surface.vertices)
        exact = all(step.same_graph for step in self.steps[-ALIKE:])
        crossings = "" if exact else " (but for which cells touch where borders cross)"
        over = count(len(self.steps), "mesh", "meshes")
        return (
            f"Minimum and graph{crossings} stayed the same from {since:,} to {last:,} vertices, "
            f"over the last {1 + ALIKE} of {over} from {first:,}. This is evidence that they are "
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
