"""What the page can show on the part: segments, reach, cells of the proof, points of a front."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import Decomposition
from cellcolor.frontend import BuildResult
from cellcolor.painting.paint import Painted
from cellcolor.pictures.mesh_picture import Labels, VertexClass
from cellcolor.pictures.palette import AREAS, assign
from cellcolor.pictures.surface_pictures import (
    bare_classes,
    bare_labels,
    by_reason,
    neighboring,
    segment_classes,
    shares,
)
from cellcolor.questions.front import FrontPoint

_LEFT_OUT, _DIVIDED, _OTHERS = "#CC3311", "#666666", "#F3F1EA"


@dataclass(frozen=True)
class SurfaceMode:
    """One way to fill the part.

    Attributes:
        name: what the button says.
        classes: of vertices, with their fills; those without a vertex are left out of the legend.
        labels: (n,) the class of each vertex of the surface.
        button: whether there is a button for it; if not, it is for a table's row to show.
    """

    name: str
    classes: tuple[VertexClass, ...]
    labels: Labels
    button: bool = True


def segment_fills(painted: Painted) -> tuple[str, ...]:
    """A fill for each segment, like ``#77AADD``; neighbors differ as long as there are enough."""
    count = int(painted.segment_of.max(initial=-1)) + 1
    return tuple(assign(neighboring(painted.surface, painted.segment_of, count)))


def segment_mode(painted: Painted) -> SurfaceMode:
    """Each segment in its fill, with its number, its color and its share of the surface."""
    surface, fills = painted.surface, segment_fills(painted)
    count = len(fills)
    labels = np.where(painted.segment_of >= 0, painted.segment_of, bare_labels(surface, count))
    share = shares(surface, labels, count + 2)
    names = []
    for number in range(count):
        own = np.flatnonzero(painted.segment_of == number)
        color = painted.plan.vertex_colors[int(own[0])] if len(own) else None
        names.append("empty" if color is None else surface.colors[color])
    classes = segment_classes(names, share[:count], fills, ", ")
    return SurfaceMode("Segments", (*classes, *bare_classes(*share[count:])), labels)


def reach_mode(built: BuildResult) -> SurfaceMode:
    """Points out of reach, by the first failed test of the branch that passed the most tests."""
    view = by_reason(built.surface, built.candidates)
    return SurfaceMode("Out of reach", tuple(view.classes), view.labels)


def proof_mode(
    surface: LabelledSurface, decomposition: Decomposition, witness: Sequence[int]
) -> SurfaceMode:
    """Cells no two of which can share a segment.

    Args:
        surface: the one that was solved.
        decomposition: its graph, with the cell of each vertex.
        witness: the cells.
    """
    others = len(witness)
    of_cell = np.full(len(decomposition.instance.cells), others)
    of_cell[list(witness)] = np.arange(others)
    labels = _on_vertices(surface, decomposition, of_cell, others + 1)
    share = shares(surface, labels, others + 3)
    classes = []
    for number, cell in enumerate(witness):
        colors = [surface.colors[color] for color in decomposition.instance.cells[cell].colors]
        text = f"cell {cell}, {share[number]}: only {' or '.join(colors)}"
        classes.append(VertexClass(text, AREAS[number % len(AREAS)], str(cell)))
    classes.append(VertexClass(f"other cells, {share[others]}", _OTHERS))
    classes += bare_classes(*share[others + 1 :])
    return SurfaceMode("Cells of the proof", tuple(classes), labels)


def front_mode(
    surface: LabelledSurface, decomposition: Decomposition, point: FrontPoint
) -> SurfaceMode:
    """What a point of a front covers: each cell by its segment.

    Where a cut would run within a cell is not drawn.
    """
    segments = point.segments
    divided, left_out = segments, segments + 1
    left = set(point.left_out)
    kept = [cell.id for cell in decomposition.instance.cells if cell.id not in left]
    of_cell = np.full(len(decomposition.instance.cells), left_out)
    colors: dict[int, int] = {}
    for division in point.solution.cells or ():
        own = {sub.segment for sub in division.subcells}
        colors |= {sub.segment: sub.color for sub in division.subcells}
        of_cell[kept[division.id]] = own.pop() if len(own) == 1 else divided
    labels = _on_vertices(surface, decomposition, of_cell, segments + 2)
    share = shares(surface, labels, segments + 4)
    classes = segment_classes(
        [surface.colors[colors[number]] for number in range(segments)],
        share[:segments],
        assign(neighboring(surface, np.where(labels < segments, labels, -1), segments)),
        ", ",
    )
    classes.append(VertexClass(f"divided between segments, {share[divided]}", _DIVIDED))
    classes.append(VertexClass(f"left out, {share[left_out]}", _LEFT_OUT))
    classes += bare_classes(*share[segments + 2 :])
    return SurfaceMode(point.in_short, tuple(classes), labels, button=False)


def _on_vertices(
    surface: LabelledSurface, decomposition: Decomposition, of_cell: Labels, bare: int
) -> Labels:
    """The classes (n,) of vertices whose cells have classes; ``bare`` and one more for the rest."""
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    if not len(of_cell):
        return bare_labels(surface, bare)
    return np.where(cells == OUTSIDE, bare_labels(surface, bare), of_cell[cells])
