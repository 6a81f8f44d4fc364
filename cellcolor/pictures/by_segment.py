"""A labelled surface by the segments of a solution.

A solution says which borders the sub-cells of a divided cell own, not where the cutting path
runs: any path between the right corners will do. So a divided cell's vertices are painted by the
nearest joined border, which shows the sub-cells' places and not the cut.
"""

from __future__ import annotations

from collections.abc import Mapping

import networkx as nx
import numpy as np

from cellcolor.data.darts import DartName, strand_of
from cellcolor.data.shares import percent, shares_of
from cellcolor.data.solution import CellDivision, Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import Decomposition
from cellcolor.decomposition.borders import Curve
from cellcolor.pictures.by_cell_and_color import bare_classes, bare_labels, neighboring, shares
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, assign
from cellcolor.pictures.picture import Picture3D

__all__ = ["SegmentPicture", "by_solution"]

_CUT = "#666666"


class SegmentPicture:
    """The surface by the segments of a solution."""

    needs: tuple[Source, ...] = ("surface", "decomposition", "solution")
    takes: tuple[Source, ...] = ()

    def draw(self, given: Given) -> Picture3D:
        """Every segment in a color of its own."""
        view = by_solution(given.surface, given.decomposition, given.solution)
        return draw_surface(given.surface, view)


def by_solution(
    surface: LabelledSurface, decomposition: Decomposition, solution: Solution
) -> SurfaceView:
    """Every segment in a color of its own.

    Args:
        surface: the surface.
        decomposition: its topological graph, on the mesh.
        solution: a valid solution of the graph, one that was found.
    """
    instance, curves = decomposition.instance, decomposition.curves
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    count = solution.segments or 0
    labels = bare_labels(surface, count + 1)
    color: dict[int, int] = {}
    near: list[int] = []
    cut: list[int] = []
    for cell in solution.cells or ():
        own = np.flatnonzero(cells == cell.id)
        color |= {sub.segment: sub.color for sub in cell.subcells}
        if len({sub.segment for sub in cell.subcells}) == 1:
            labels[own] = cell.subcells[0].segment
            continue
        painted = _nearest(surface, own, cell, solution.strands, curves)
        labels[own] = count if painted is None else painted
        (cut if painted is None else near).append(cell.id)
    share = shares_of(instance, solution)
    bare = shares(surface, labels, count + 3)[count + 1 :]
    fills = assign(neighboring(surface, labels, count))
    classes = [
        VertexClass(
            f"segment {number}: {instance.colors[color[number]]}  "
            f"{percent(*share.segments[number])}",
            fills[number],
            str(number),
        )
        for number in range(count)
    ]
    classes.append(VertexClass("cut between segments", _CUT))
    classes += bare_classes(*bare)
    notes = [f"Status: {solution.status}. Shares of the surface. Black lines: borders of cells."]
    if not share.certain:
        notes.append("Ranges: where the cut runs through a divided cell is free.")
    if count > len(AREAS):
        notes.append("Fills repeat: the numbers tell segments apart.")
    if near:
        notes += [
            f"Divided: {_listed(near)}. Each vertex there is painted as the",
            "nearest joined border.",
        ]
    if cut:
        notes.append(f"Divided, not painted: {_listed(cut)}.")
    lift_offs = solution.lift_offs or 0
    title = (
        f"{surface.name}: {count} segment{'' if count == 1 else 's'}, "
        f"{lift_offs} lift-off{'' if lift_offs == 1 else 's'}"
    )
    return SurfaceView(
        title, labels, classes, borders=cells, cracks=surface.crack_colors, notes=tuple(notes)
    )


def _listed(cells: list[int]) -> str:
    return ("cell " if len(cells) == 1 else "cells ") + ", ".join(map(str, cells))


def _nearest(
    surface: LabelledSurface,
    own: Labels,
    cell: CellDivision,
    strands: int,
    curves: Mapping[int, Curve],
) -> Labels | None:
    """The segment of each vertex of a divided cell, by the nearest joined dart.

    Distances are measured along mesh edges inside the cell. None if a sub-cell has no dart whose
    place is known: it hangs on a seam only, or no curve is known.
    """
    source: dict[int, int] = {}
    for sub in cell.subcells:
        vertices = {v for dart in sub.darts for v in _along(dart, strands, curves)}
        if not vertices:
            return None
        for vertex in sorted(vertices):
            source.setdefault(vertex, sub.segment)
    inside = set(own.tolist())
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(own.tolist())
    for a, b in surface.left_of:
        if a in inside and b in inside and not surface.cracked(a, b):
            length = float(np.linalg.norm(surface.vertices[a] - surface.vertices[b]))
            graph.add_edge(a, b, weight=length)
    regions = nx.voronoi_cells(graph, set(source), weight="weight")
    segment = {v: source[center] for center in source for v in regions.get(center, ())}
    return np.array([segment[vertex] for vertex in own.tolist()], dtype=np.int64)


def _along(dart: DartName, strands: int, curves: Mapping[int, Curve]) -> list[int]:
    """The vertices on a dart's own side of its edge, or of one of its strands; [] for a seam."""
    name, strand = strand_of(dart)
    steps = curves[abs(name)].steps if abs(name) in curves else ()
    count = len(steps)
    if strands > 1 and count:
        # Strands share the edge evenly; a short edge's strands share vertices.
        first = min((strand - 1) * count // strands, count - 1)
        steps = steps[first : max(strand * count // strands, first + 1)]
    return [step[0] if name > 0 else step[1] for step in steps]
