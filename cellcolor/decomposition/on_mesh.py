"""A topological graph and where it lies on its mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.data.cells_and_edges import OUTSIDE
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition.borders import Borders, Curve


@dataclass(frozen=True, slots=True)
class Decomposition:
    """A topological graph with the part of the mesh that each of its elements is.

    Attributes:
        instance: the graph.
        curves: where each topological edge lies, by its id; empty if that is not known.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.
    """

    instance: Instance
    curves: Mapping[int, Curve]
    vertex_cell: tuple[int, ...]


def locate(
    surface: LabelledSurface, instance: Instance, vertex_cell: Sequence[int]
) -> Decomposition:
    """Find where an instance that was read from a file lies on its surface.

    Args:
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.

    Returns:
        The instance, with the areas of its cells and its coverage measured here, and the curves of
        its edges. There are none if another program has numbered the edges.
    """
    cells = np.array(vertex_cell, dtype=np.int64)
    reached = cells != OUTSIDE
    areas = np.bincount(cells[reached], surface.vertex_areas[reached], len(instance.cells))
    measured = tuple(
        replace(cell, area=float(area)) for cell, area in zip(instance.cells, areas, strict=True)
    )
    return Decomposition(
        replace(instance, cells=measured, coverage=surface.coverage),
        _curves(surface, instance, vertex_cell),
        tuple(vertex_cell),
    )


def _curves(
    surface: LabelledSurface, instance: Instance, vertex_cell: Sequence[int]
) -> dict[int, Curve]:
    """The curve of each edge, by its id; none at all if the ids do not fit the curves.

    The decomposition numbers edges in the order in which it finds their curves, so the curves are
    looked for again in that order. An edge has to have the same cells on its sides and the same
    joinable colors as the curve of its number. Otherwise another program has numbered the edges.
    """
    borders = Borders(surface, vertex_cell)
    cell_of = borders.cell_of
    curves = dict(enumerate(borders.curves(), start=1))
    if curves.keys() != {edge.id for edge in instance.edges}:
        return {}
    for edge in instance.edges:
        left, right = curves[edge.id].steps[0]
        same = (cell_of[left], cell_of[right]) == (edge.left, edge.right)
        if not same or borders.joinable(left, right) != frozenset(instance.joinable(edge.id)):
            return {}
    return curves
