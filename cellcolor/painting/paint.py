"""A solution painted: a color for every vertex of a surface, refined where it must be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from heapq import heapify, heappop, heappush

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.checker.dart_lists import WholeSubCell
from cellcolor.checker.vertex_plan import check_plan
from cellcolor.data.cells_and_edges import Strand
from cellcolor.data.plan import Plan
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.value import WithArrays
from cellcolor.data.wording import count, segments_and_lift_offs
from cellcolor.deadline import NEVER, Deadline
from cellcolor.decomposition import Decomposition
from cellcolor.decomposition.borders import Borders
from cellcolor.errors import InputError, RefusedResult
from cellcolor.painting.refined import (
    Refined,
    choose_gates,
    interpolated,
    steps_by_edge,
    subcells_on_surface,
    unrefined,
)
from cellcolor.painting.trees import TooNarrow, Trees


@dataclass(frozen=True, repr=False, eq=False)
class Painted(WithArrays):
    """A painted solution.

    Attributes:
        surface: the labelled surface, refined where it had to be; the vertices that were there
            before come first.
        plan: one color per vertex of that surface.
        segments: how many the plan has, counted by the checker on the mesh.
        segment_of: (n,) the solution's segment that each vertex is in, -1 where it has no color.
        stands_for: (n,) the vertex of the given surface whose colors each vertex has.
        between: (n, 2) the two earlier vertices in whose middle each new vertex lies; a vertex of
            the given surface lies between itself and itself.
        merged: segments of the solution that have one color and touch, so that they are one when
            painted; only where the solution has more than are needed.
        minima: of a scene that was asked about its painting the segments of each surface that was
            solved. There are several if the scene refused a painting.
        refused: vertices, ascending, at which the scene refuses the painting all the same: a new
            one that the color does not reach, or the end of a mesh edge along which it does not
            lead on.
    """

    surface: LabelledSurface
    plan: Plan
    segments: int
    segment_of: Index
    stands_for: Index
    between: Index
    merged: tuple[tuple[int, ...], ...]
    minima: tuple[int, ...] = ()
    refused: tuple[int, ...] = ()

    def interpolated(self, values: Array) -> Array:
        """Values (m, ...) at the given surface's vertices, carried over to all (n, ...).

        A new vertex gets the mean of the two that it lies between. Unit normals are no longer of
        length 1 then.

        Raises:
            InputError: there is not one row for each vertex of the given surface.
        """
        given = int((self.between[:, 0] == self.between[:, 1]).sum())
        if len(values) != given:
            message = f"has {len(values)} rows for {count(given, 'vertex', 'vertices')}"
            raise InputError(None, "values", message)
        return interpolated(self.between, values)

    def __str__(self) -> str:
        vertices = count(len(self.surface.vertices), "vertex", "vertices")
        segments = segments_and_lift_offs(self.segments)
        return f"{self.surface.name}: painted in {segments}, on {vertices}"

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self}>"

    def __hash__(self) -> int:  # type: ignore[override]
        return hash((self.surface, self.plan))


def paint(
    surface: LabelledSurface,
    decomposition: Decomposition,
    solution: Solution,
    deadline: Deadline = NEVER,
) -> Painted:
    """Paint every vertex of a surface in the colors of a solution (docs/motion.md).

    A cell that is not divided is painted as a whole. In a divided one a tree for each sub-cell
    connects the places where it crosses the cell's border, and every other vertex goes with the
    tree that is nearest. Where the mesh leaves too little room it is refined; new vertices copy
    the colors of old ones, so that the topological graph stays what it was.

    Args:
        decomposition: its topological graph, and where that lies on it.
        solution: a valid solution of that graph.

    Returns:
        A valid plan with at most as many segments as the solution, and exactly as many if these
        are proved to be the fewest for the surface.

    Raises:
        InputError: the solution has no division, or it is not known where the graph's edges lie.
        TooLarge: the refined mesh would not fit into memory.
        RefusedResult: the checker counts other segments than the solution says.
    """
    if solution.cells is None or solution.segments is None:
        raise InputError(None, "cells", "contains no division to paint")
    if len(decomposition.curves) < len(decomposition.instance.edges):
        raise InputError(None, "edges", "are not numbered in the order in which they lie")
    cell_of = np.array(decomposition.vertex_cell, dtype=np.int64)
    seams = {seam.id for seam in solution.seams}
    subcells = [subcells_on_surface(cell, seams) for cell in solution.cells]
    divided = {number for number, own in enumerate(subcells) if len(own) > 1}
    refined = unrefined(surface)
    while True:
        deadline.check()
        mesh = _Mesh(refined, cell_of, deadline)
        curves = mesh.borders.curves(deadline)
        steps = steps_by_edge(refined, decomposition.curves, curves)
        gates, short = choose_gates(subcells, divided, steps)
        narrow = np.zeros(len(refined.mesh.points), dtype=bool)
        for edge in short:
            ends = [vertex for step in steps[edge] for vertex in step]
            narrow[ends] = True
        trees: dict[int, int] = {}
        for cell in sorted(divided):
            deadline.check()
            found = mesh.trees(cell, subcells[cell], gates)
            if found is None:
                narrow |= mesh.cell_of == cell
            else:
                trees |= found
        if not narrow.any():
            return _painted(mesh, subcells, divided, trees, solution)
        refined = refined.halved(narrow, deadline)


class _Mesh:
    """One refinement of a surface, on which divided cells may leave room or not."""

    def __init__(self, refined: Refined, cell_of: Index, deadline: Deadline) -> None:
        self.refined = refined
        self.deadline = deadline
        self.surface = refined.surface(deadline)
        deadline.check()
        self.cell_of = cell_of[refined.stands_for]
        self.borders = Borders(self.surface, self.cell_of.tolist())
        self.third = self.borders.mesh.third
        self.around: dict[int, list[int]] = {}
        for a, b in deadline.watch(self.third):
            self.around.setdefault(a, []).append(b)

    def cracked(self, a: int, b: int) -> bool:
        """Whether any color is cracked along a mesh edge."""
        return bool(self.surface.cracked(a, b))

    def within_cell(self, a: int, b: int) -> bool:
        """Whether a mesh edge from a vertex to whatever is beside it lies within one cell."""
        inside = b < len(self.cell_of) and self.cell_of[a] == self.cell_of[b]
        return bool(inside) and not self.cracked(a, b)

    def trees(
        self, cell: int, subcells: Sequence[WholeSubCell], gates: dict[Strand, int]
    ) -> dict[int, int] | None:
        """The segment of each vertex on the trees of a cell; None if it is too narrow for them."""
        if any(strand not in gates for subcell in subcells for strand in subcell.strands):
            return {}  # an edge is too short, and will be refined for that
        own = np.flatnonzero(self.cell_of == cell).tolist()
        terminals = [[gates[strand] for strand in sorted(subcell.strands)] for subcell in subcells]
        try:
            trees = Trees(
                own, self.around, self.third, self.cracked, terminals, self.deadline
            ).grown()
        except TooNarrow:
            return None
        return {vertex: subcells[number].segment for vertex, number in trees.items()}


def _painted(
    mesh: _Mesh,
    subcells: Sequence[Sequence[WholeSubCell]],
    divided: set[int],
    trees: dict[int, int],
    solution: Solution,
) -> Painted:
    """The painting, with what the checker finds in it."""
    segment_of = np.full(len(mesh.cell_of), -1, dtype=np.int64)
    for cell, own in enumerate(subcells):
        if cell not in divided:
            segment_of[mesh.cell_of == cell] = own[0].segment
    for vertex, segment in _spread(mesh, trees).items():
        segment_of[vertex] = segment
    color = {sub.segment: sub.color for cell in solution.cells or () for sub in cell.subcells}
    plan = Plan(tuple([color.get(segment) for segment in segment_of.tolist()]))
    mesh.deadline.check()
    report = check_plan(mesh.surface, plan)
    mesh.deadline.check()
    if report.segments is None:
        raise RefusedResult(f"a painting is not valid: {report.problems[0]}")
    # The segments of the solution in each that the checker counts.
    counted: list[set[int]] = [set() for _ in range(report.segments)]
    for segment, number in zip(segment_of.tolist(), report.segment_of, strict=True):
        if number >= 0:
            counted[number].add(segment)
    fallen_apart = sum(map(len, counted)) > len(set().union(*counted))
    fewer = report.segments < (solution.segments or 0)
    if fallen_apart or (solution.proved_for_surface and fewer):
        raise RefusedResult(
            f"a painting has {report.segments} segments, its solution {solution.segments}"
        )
    return Painted(
        surface=mesh.surface,
        plan=plan,
        segments=report.segments,
        segment_of=segment_of,
        stands_for=mesh.refined.stands_for,
        between=mesh.refined.between,
        merged=tuple(sorted(tuple(sorted(group)) for group in counted if len(group) > 1)),
    )


def _spread(mesh: _Mesh, trees: dict[int, int]) -> dict[int, int]:
    """The segment of every vertex of the divided cells: that of the tree nearest along the mesh."""
    places, done = mesh.surface.vertices, set[int]()
    # Trees keep their vertices, even where others lie at the very same place.
    segment = dict(trees)
    queue = [(0.0, vertex, number) for vertex, number in trees.items()]
    heapify(queue)
    while queue:
        mesh.deadline.check()
        far, vertex, number = heappop(queue)
        if segment.setdefault(vertex, number) != number or vertex in done:
            continue
        done.add(vertex)
        for other in mesh.around[vertex]:
            if other not in segment and mesh.within_cell(vertex, other):
                length = float(np.linalg.norm(places[vertex] - places[other]))
                heappush(queue, (far + length, other, number))
    return segment
