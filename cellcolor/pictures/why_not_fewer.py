"""Why fewer segments are not enough: what the certificate of a bound names, on the surface.

What that is each kind of bound says (:mod:`cellcolor.data.bounds`): cells, and connections that
cross each other.
"""

from __future__ import annotations

from itertools import combinations
from typing import Any

import networkx as nx
import numpy as np

from cellcolor.arrays import Index, Mask
from cellcolor.checker.certificates import BoundVerdict
from cellcolor.data.bounds import Shown, certificate_of
from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count
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
    if bound is None or certificate is None:
        message = "none above 1 has a certificate, so there is nothing to see"
        raise InputError(None, "bounds", message)
    title = f"{surface.name}: why {count(bound.value, 'segment')} at least"
    shown = certificate.shown(bound.value, decomposition.instance)
    return draw_surface(surface, view_of(surface, decomposition, title, shown))


def view_of(
    surface: LabelledSurface, decomposition: Decomposition, title: str, shown: Shown
) -> SurfaceView:
    """The marked cells, the connections, and where these cross each other."""
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    marks, ways = shown.marks, shown.connections
    rest = len(marks) + len(ways) + (1 if ways else 0)
    labels: Index = np.where(cells == OUTSIDE, rest + 1, rest)
    for number, mark in enumerate(marks):
        labels[np.isin(cells, list(mark.cells))] = number
    drawn = [
        set(_way(surface, way.color, np.isin(cells, list(way.near)), np.isin(cells, list(way.far))))
        for way in ways
    ]
    marked = labels < len(marks)
    for number, path in enumerate(drawn):
        labels[[vertex for vertex in path if not marked[vertex]]] = len(marks) + number
    for one, other in combinations(drawn, 2):
        labels[list(one & other)] = rest - 1
    classes = [VertexClass(m.text, fill_of(surface, m.colors), m.label) for m in marks]
    classes += [VertexClass(way.text, fill_of(surface, [way.color])) for way in ways]
    if ways:
        classes.append(VertexClass("where they cross", WARNING))
    classes += [VertexClass("other cells", OTHERS), VertexClass("not covered", FAINT)]
    return SurfaceView(title, labels, classes, cracks=surface.crack_colors, notes=shown.notes)


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
