"""Why fewer segments are not enough: what the certificate of a bound names, on the surface.

That is cells, each by itself, or a conflict: two pairs of areas whose connections cross each other.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import combinations
from typing import Any

import networkx as nx
import numpy as np

from cellcolor.arrays import Index, Mask
from cellcolor.checker.certificates import BoundVerdict
from cellcolor.data.bounds import CertifiedCells, CertifiedCrossing, CertifiedParts, certificate_of
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count, listed
from cellcolor.decomposition import Decomposition
from cellcolor.errors import InputError
from cellcolor.pictures.mesh_picture import SurfaceView, draw_surface
from cellcolor.pictures.picture import FAINT, WARNING, Picture3D, VertexClass
from cellcolor.pictures.surface_pictures import OTHERS, fill_of


def draw_why(
    surface: LabelledSurface,
    decomposition: Decomposition,
    solution: Solution,  # noqa: ARG001 - the verdicts are of its bounds
    verdicts: tuple[BoundVerdict, ...],
) -> Picture3D:
    """The cells, or one conflict, that the certificate of the greatest bound names.

    Raises:
        InputError: no certificate of the solution proves more than one segment.
    """
    proved = [v.bound for v in verdicts if v.outcome == "verified" and v.bound.value > 1]
    surface_bounds = [b for b in proved if b.holds_for == "surface"]
    bound = max(surface_bounds, key=lambda bound: bound.value, default=None)
    certificate = None if bound is None else certificate_of(bound)
    if bound is None or not isinstance(certificate, CertifiedCells | CertifiedParts):
        message = "none above 1 has a certificate, so there is nothing to see"
        raise InputError(None, "bounds", message)
    title = f"{surface.name}: why {count(bound.value, 'segment')} at least"
    conflicts: list[CertifiedCrossing] = []
    if isinstance(certificate, CertifiedParts):
        conflicts = [conflict for part in certificate.parts for conflict in part.conflicts]
        cells = {cell for part in certificate.parts for cell in part.cells}
    else:
        cells = set(certificate.cells)
    if conflicts:
        return draw_surface(surface, _conflict(surface, decomposition, title, conflicts))
    notes: tuple[str, ...] = (
        "No two of these cells can share a segment:",
        "no color leads from one to another.",
    )
    if len(cells) != bound.value:
        notes = (f"No {count(bound.value - 1, 'color region')} touch all of these cells.",)
    return draw_surface(surface, view_of_cells(surface, decomposition, title, sorted(cells), notes))


def view_of_cells(
    surface: LabelledSurface,
    decomposition: Decomposition,
    title: str,
    cells: Sequence[int],
    notes: tuple[str, ...] = (),
) -> SurfaceView:
    """Cells, each by itself, with their colors."""
    marks = []
    for cell in cells:
        colors = decomposition.instance.cells[cell].colors
        name = f"cell {cell}: {listed(surface.colors[color] for color in colors)}"
        marks.append((VertexClass(name, fill_of(surface, colors), str(cell)), (cell,)))
    return _view(surface, decomposition, title, marks, [], notes)


def _conflict(
    surface: LabelledSurface,
    decomposition: Decomposition,
    title: str,
    conflicts: Sequence[CertifiedCrossing],
) -> SurfaceView:
    """The four areas of one conflict, and two connections, which would cross."""
    first, cells = conflicts[0], np.array(decomposition.vertex_cell)
    marks, ways = [], []
    for letter, color, areas in zip("ab", first.colors, (first.one, first.other), strict=True):
        name, fill = surface.colors[color], fill_of(surface, [color])
        for place, area in enumerate(areas, start=1):
            which = f"{'cell' if len(area) == 1 else 'cells'} {listed(area)}"
            text = f"{letter}{place}: {which}, to be connected in {name}"
            marks.append((VertexClass(text, fill, f"{letter}{place}"), area))
        text = f"a connection of {letter}1 and {letter}2 in {name}"
        near, far = (np.isin(cells, area) for area in areas)
        ways.append((VertexClass(text, fill), set(_way(surface, color, near, far))))
    notes: tuple[str, ...] = (
        "A segment that touches a1 and a2 and one that touches b1",
        "and b2 would cross, wherever they run. Two are drawn.",
    )
    if len(conflicts) > 1:
        notes += (f"The certificate names {count(len(conflicts) - 1, 'conflict')} more.",)
    return _view(surface, decomposition, title, marks, ways, notes)


def _view(
    surface: LabelledSurface,
    decomposition: Decomposition,
    title: str,
    marks: Sequence[tuple[VertexClass, Collection[int]]],
    ways: Sequence[tuple[VertexClass, set[int]]],
    notes: tuple[str, ...],
) -> SurfaceView:
    """Marked cells, connections by their vertices, and where these cross each other.

    Of a cell with several marks the last one is to be seen.
    """
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    rest = len(marks) + len(ways) + (1 if ways else 0)
    labels: Index = np.where(cells == OUTSIDE, rest + 1, rest)
    for number, (_, own) in enumerate(marks):
        labels[np.isin(cells, list(own))] = number
    marked = labels < len(marks)
    for number, (_, path) in enumerate(ways, start=len(marks)):
        labels[[vertex for vertex in path if not marked[vertex]]] = number
    for (_, one), (_, other) in combinations(ways, 2):
        labels[list(one & other)] = rest - 1
    classes = [own for own, _ in (*marks, *ways)]
    if ways:
        classes.append(VertexClass("where they cross", WARNING))
    classes += [VertexClass("other cells", OTHERS), VertexClass("not covered", FAINT)]
    return SurfaceView(title, labels, classes, cracks=surface.crack_colors, notes=notes)


def _way(surface: LabelledSurface, color: int, near: Mask, far: Mask) -> list[int]:
    """Vertices of a shortest way in one color from one area to another; none if there is none."""
    graph: nx.Graph[Any] = nx.Graph(
        (a, b)
        for a, b in surface.left_of
        if color in surface.vertex_colors[a]
        and color in surface.vertex_colors[b]
        and color not in surface.cracked(a, b)
    )
    graph.add_edges_from(("near", vertex) for vertex in np.flatnonzero(near).tolist())
    graph.add_edges_from((vertex, "far") for vertex in np.flatnonzero(far).tolist())
    try:
        way: list[int] = nx.shortest_path(graph, "near", "far")[1:-1]
        return way
    except nx.NetworkXException:  # no way, or nothing to lead from or to
        return []
