"""What the page can show on the part: segments, why points are out of reach, cells of the proof."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import Decomposition
from cellcolor.frontend import BuildResult
from cellcolor.painting.paint import Painted
from cellcolor.pictures.by_cell_and_color import bare_classes, bare_labels, neighboring, shares
from cellcolor.pictures.by_reason import by_reason
from cellcolor.pictures.mesh_picture import Labels, VertexClass
from cellcolor.pictures.palette import AREAS, assign


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
    classes = [
        VertexClass(
            f"segment {number}: {_color_name(painted, number)}, {share[number]}",
            fill,
            str(number),
        )
        for number, fill in enumerate(fills)
    ]
    classes += bare_classes(*share[count:])
    return SurfaceMode("Segments", tuple(classes), labels)


def _color_name(painted: Painted, segment: int) -> str:
    own = np.flatnonzero(painted.segment_of == segment)
    color = painted.plan.vertex_colors[int(own[0])] if len(own) else None
    return "empty" if color is None else painted.surface.colors[color]


def reach_mode(built: BuildResult) -> SurfaceMode:
    """Points out of reach, by the first failed test of the branch that passed the most tests."""
    view = by_reason(built.surface, built.candidates)
    return SurfaceMode("Out of reach", tuple(view.classes), view.labels)


def proof_mode(
    surface: LabelledSurface,
    decomposition: Decomposition,
    witness: tuple[int, ...],
) -> SurfaceMode | None:
    """Cells no two of which can share a segment; None where no such cells are known.

    Args:
        surface: the one that was solved.
        decomposition: its graph, with the cell of each vertex.
        witness: the cells.
    """
    if len(witness) < 2:
        return None
    cells = np.array(decomposition.vertex_cell, dtype=np.int64)
    place = {cell: number for number, cell in enumerate(witness)}
    others = len(witness)
    labels = np.array([place.get(cell, others) for cell in cells.tolist()], dtype=np.int64)
    labels = np.where(cells == OUTSIDE, bare_labels(surface, others + 1), labels)
    share = shares(surface, labels, others + 3)
    classes = [
        VertexClass(
            f"cell {cell}, {share[number]}: only "
            + " or ".join(
                surface.colors[color] for color in decomposition.instance.cells[cell].colors
            ),
            AREAS[number % len(AREAS)],
            str(cell),
        )
        for number, cell in enumerate(witness)
    ]
    classes.append(VertexClass(f"other cells, {share[others]}", "#F3F1EA"))
    classes += bare_classes(*share[others + 1 :])
    return SurfaceMode("Cells of the proof", tuple(classes), labels)
