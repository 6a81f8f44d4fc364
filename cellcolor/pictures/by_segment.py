"""A labelled surface by the segments of a solution.

A solution says which borders the sub-cells of a divided cell own, not where the cutting path
runs. What is drawn is its painting (:mod:`cellcolor.painting.paint`): one of the ways in which the
cut can run, on a mesh that is refined where it has to be.
"""

from __future__ import annotations

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.shares import percent, shares_of
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count, listed
from cellcolor.decomposition import Decomposition
from cellcolor.painting.paint import paint
from cellcolor.pictures.by_cell_and_color import bare_classes, bare_labels, neighboring, shares
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, assign
from cellcolor.pictures.picture import Picture3D

_CUT = "#666666"


class SegmentPicture:
    """The surface by the segments of a solution."""

    needs: tuple[Source, ...] = ("surface", "decomposition", "solution")
    takes: tuple[Source, ...] = ()

    def draw(self, given: Given) -> Picture3D:
        """Every segment in a color of its own."""
        return draw_surface(*by_solution(given.surface, given.decomposition, given.solution))


def by_solution(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> tuple[LabelledSurface, SurfaceView]:
    """Every segment in a color of its own, and the surface to draw that on.

    Args:
        surface: the surface.
        decomposition: its topological graph, on the mesh.
        solution: a valid solution of the graph, one that was found.

    Raises:
        TooLarge: a painting would need too many vertices.
    """
    instance = decomposition.instance
    segments = solution.segments or 0
    divided = [
        cell.id for cell in solution.cells or () if len({sub.segment for sub in cell.subcells}) > 1
    ]
    fine, stands_for, segment_of = _painted(surface, decomposition, solution)
    labels = np.where(segment_of >= 0, segment_of, bare_labels(fine, segments + 1))
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    uncolored = np.where(cells == OUTSIDE, bare_labels(surface, 1), 0)
    bare = shares(surface, uncolored, 3)[1:]
    if not decomposition.curves:
        labels[np.isin(cells, divided)] = segments
    color = {sub.segment: sub.color for cell in solution.cells or () for sub in cell.subcells}
    share = shares_of(instance, solution)
    fills = assign(neighboring(fine, labels, segments))
    classes = [
        VertexClass(
            f"segment {number}: {instance.colors[color[number]]}  "
            f"{percent(*share.segments[number])}",
            fills[number],
            str(number),
        )
        for number in range(segments)
    ]
    classes.append(VertexClass("cut between segments", _CUT))
    classes += bare_classes(*bare)
    notes = [f"Status: {solution.status}. Shares of the surface. Black lines: borders of cells."]
    if not share.certain:
        notes.append("Ranges: the cut through a divided cell may run anywhere.")
    if segments > len(AREAS):
        notes.append("Fills repeat: the numbers identify the segments.")
    if divided:
        named = f"{'cell' if len(divided) == 1 else 'cells'} {listed(divided)}"
        drawn = "One possible cut is drawn, also in black."
        way = drawn if decomposition.curves else "Not painted."
        notes.append(f"Divided: {named}. {way}")
    if added := len(fine.vertices) - len(surface.vertices):
        notes.append(f"The mesh is refined for this: {count(added, 'vertex', 'vertices')} more.")
    lift_offs = count(solution.lift_offs or 0, "lift-off")
    title = f"{surface.name}: {count(segments, 'segment')}, {lift_offs}"
    view = SurfaceView(
        title,
        labels,
        classes,
        borders=_pieces(cells[stands_for], labels),
        cracks=fine.crack_colors,
        notes=tuple(notes),
    )
    return fine, view


def _pieces(cells: Labels, labels: Labels) -> Labels:
    """A number for each part of a cell that is in one segment, so that cuts are drawn as well."""
    return cells * (int(labels.max(initial=0)) + 1) + labels


def _painted(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> tuple[LabelledSurface, Labels, Labels]:
    """The painted surface, what each vertex stands for, and its segment.

    Where it is not known where the edges lie, each cell has the first of its segments.
    """
    if decomposition.curves or not decomposition.instance.edges:
        painted = paint(surface, decomposition, solution)
        return painted.surface, painted.stands_for, painted.segment_of
    first = np.array([cell.subcells[0].segment for cell in solution.cells or ()] + [-1])
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    return surface, np.arange(len(cells)), first[cells]
