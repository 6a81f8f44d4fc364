"""Why fewer segments are not enough: what the certificate of a bound names, on the surface.

Of a conflict between two segments these are its four areas, and a connection of either segment:
the second would have to cross the first. Of a set cover, of tangles alone or of hubs they are the
cells.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from cellcolor.arrays import Mask
from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.color_regions import regions_on_surface
from cellcolor.data.bound import Bound
from cellcolor.data.instance import OUTSIDE
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.data.wording import count, listed
from cellcolor.decomposition import Decomposition
from cellcolor.errors import InputError
from cellcolor.pictures.interface import Given, Source
from cellcolor.pictures.mesh_picture import Labels, SurfaceView, VertexClass, draw_surface
from cellcolor.pictures.palette import AREAS, FAINT, LINES, WARNING
from cellcolor.pictures.picture import Picture3D

__all__ = ["WhyNotFewerPicture"]

_REST = "#F2F2F2"
"""What says nothing here but can be covered."""


class WhyNotFewerPicture:
    """What proves that no division of the surface has fewer segments."""

    needs: tuple[Source, ...] = ("surface", "decomposition", "solution")
    takes: tuple[Source, ...] = ()

    def draw(self, given: Given) -> Picture3D:
        """The cells, or one conflict, that the certificate of the greatest bound names.

        Raises:
            InputError: no certificate of the solution proves more than one segment.
        """
        surface, decomposition = given.surface, given.decomposition
        bound = _proving(surface, decomposition, given.solution)
        certificate = bound.certificate or {}
        parts: list[dict[str, Any]] = certificate.get("parts", [certificate])
        conflicts = [conflict for part in parts for conflict in part.get("conflicts", ())]
        tangles = [tangle for part in parts for tangle in part.get("tangles", ())]
        title = f"{surface.name}: why {count(bound.value, 'segment')} at least"
        if conflicts:
            view = _of_conflict(surface, decomposition, title, conflicts, len(tangles))
        else:
            cells = sorted({cell for part in parts for cell in part["cells"]})
            hubs = sorted({cell for part in parts for cell in part.get("hubs", ())})
            view = _of_cells(
                surface, decomposition, title, bound, cells, hubs, tangled=bool(tangles)
            )
        return draw_surface(surface, view)


def _proving(surface: LabelledSurface, decomposition: Decomposition, solution: Solution) -> Bound:
    """The greatest bound for any division that a certificate proves.

    Raises:
        InputError: there is none above 1.
    """
    regions = regions_on_surface(surface, decomposition.vertex_cell)
    bounds = [b for b in solution.bounds or () if b.holds_for == "surface" and b.value > 1]
    for bound in sorted(bounds, key=lambda bound: -bound.value):
        if verify_bound(decomposition.instance, bound, regions).outcome == "verified":
            return bound
    raise InputError(None, "bounds", "none above 1 has a certificate, so there is nothing to see")


def _of_cells(
    surface: LabelledSurface,
    decomposition: Decomposition,
    title: str,
    bound: Bound,
    cells: Sequence[int],
    hubs: Sequence[int],
    *,
    tangled: bool,
) -> SurfaceView:
    """Cells that fewer color regions or segments do not touch, and hubs that save no more."""
    instance = decomposition.instance
    marked = [(cell, f"cell {cell}") for cell in cells] + [(cell, f"hub {cell}") for cell in hubs]
    classes = []
    for number, (cell, name) in enumerate(marked):
        colors = listed([instance.colors[color] for color in instance.cells[cell].colors])
        rgb = LINES[0] if cell in hubs else AREAS[number % len(AREAS)]
        classes.append(VertexClass(f"{name}: {colors}", rgb, str(cell)))
    labels = _labelled(decomposition, [[cell] for cell, _ in marked], len(marked))
    notes: tuple[str, ...]
    if hubs:
        notes = (
            "Without the hubs no two of the cells can share a segment,",
            "and the hubs join no more.",
        )
    elif tangled:
        fewer = count(bound.value - 1, "segment")
        notes = (f"No {fewer} that touch all of these cells", "can be drawn side by side.")
    elif len(cells) == bound.value:
        notes = (
            "No two of these cells can share a segment:",
            "no color leads from one to another.",
        )
    else:
        notes = (f"No {count(bound.value - 1, 'color region')} touch all of these cells.",)
    return _view(surface, title, labels, classes, notes)


def _of_conflict(
    surface: LabelledSurface,
    decomposition: Decomposition,
    title: str,
    conflicts: Sequence[dict[str, Any]],
    tangles: int,
) -> SurfaceView:
    """One conflict: its areas, and two connections, of which the second crosses the first."""
    shown = conflicts[0]
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    ways, classes = [], []
    sides = zip(shown["colors"], (shown["one"], shown["other"]), "ab", strict=True)
    areas = [*shown["one"], *shown["other"]]
    for number, (color, (near, far), letter) in enumerate(sides):
        name = surface.colors[color]
        for place, area in enumerate((near, far), start=1):
            which = f"{'cell' if len(area) == 1 else 'cells'} {listed(area)}"
            text = f"{letter}{place}: {which}, to be connected in {name}"
            classes.append(VertexClass(text, AREAS[number], f"{letter}{place}"))
        ways.append(_way(surface, color, np.isin(cells, near), np.isin(cells, far)))
    labels = _labelled(decomposition, areas, 7)
    inside = labels < len(areas)
    for number, way in enumerate(ways):
        path = np.array(way, dtype=np.int64)
        labels[path[~inside[path]]] = 4 + number
    labels[sorted(set(ways[0]) & set(ways[1]))] = 6
    for number, letter in enumerate("ab"):
        color = surface.colors[shown["colors"][number]]
        rgb = LINES[0] if number == 0 else LINES[5]
        classes.append(VertexClass(f"a connection of {letter}1 and {letter}2 in {color}", rgb))
    classes.append(VertexClass("where they cross", WARNING))
    more = len(conflicts) - 1
    notes = [
        "A segment that touches a1 and a2 and one that touches b1",
        "and b2 would cross, wherever they run. Two are drawn.",
    ]
    if more:
        notes.append(f"The certificate names {count(more, 'conflict')} more.")
    if tangles:
        notes.append(f"It names {count(tangles, 'tangle')} of several segments, too.")
    return _view(surface, title, labels, classes, tuple(notes))


def _labelled(decomposition: Decomposition, areas: Sequence[Collection[int]], rest: int) -> Labels:
    """The class of each vertex: its area's number, ``rest``, or one more without a color."""
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    labels = np.where(cells == OUTSIDE, rest + 1, rest)
    for number, area in enumerate(areas):
        labels[np.isin(cells, list(area))] = number
    return labels


def _view(
    surface: LabelledSurface,
    title: str,
    labels: Labels,
    classes: Sequence[VertexClass],
    notes: tuple[str, ...],
) -> SurfaceView:
    rest = [VertexClass("other cells", _REST), VertexClass("not covered", FAINT)]
    return SurfaceView(title, labels, [*classes, *rest], cracks=surface.crack_colors, notes=notes)


def _way(surface: LabelledSurface, color: int, near: Mask, far: Mask) -> list[int]:
    """Vertices of a shortest way in one color from one area to another; none if there is none."""
    beside: dict[int, list[int]] = {}
    for a, b in surface.left_of:
        both = color in surface.vertex_colors[a] and color in surface.vertex_colors[b]
        if both and color not in surface.cracked(a, b):
            beside.setdefault(a, []).append(b)
            beside.setdefault(b, []).append(a)
    starts = [int(vertex) for vertex in np.flatnonzero(near)]
    came = {vertex: vertex for vertex in starts}
    todo = deque(starts)
    while todo:
        vertex = todo.popleft()
        if far[vertex]:
            way = [vertex]
            while came[way[-1]] != way[-1]:
                way.append(came[way[-1]])
            return way
        for other in beside.get(vertex, ()):
            if other not in came:
                came[other] = vertex
                todo.append(other)
    return []
