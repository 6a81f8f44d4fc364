"""A topological graph and where it lies on its mesh."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.data.instance import OUTSIDE, Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition.borders import Borders, ClosedMesh, Curve
from cellcolor.decomposition.coverage import coverage_of

__all__ = ["Decomposition", "locate"]


@dataclass(frozen=True, slots=True)
class Decomposition:
    """A topological graph with the part of the mesh that each of its elements is.

    Attributes:
        instance: the graph.
        curves: where each edge lies, by its id; empty if that is not known.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.
    """

    instance: Instance
    curves: Mapping[int, Curve]
    vertex_cell: tuple[int, ...]


def locate(
    surface: LabelledSurface, instance: Instance, vertex_cell: Sequence[int]
) -> Decomposition:
    """Where an instance that was read lies on its surface; its areas and coverage are measured.

    Edges are found again by their numbers, which the decomposition gives in the order in which it
    finds their curves. If one has other sides or joinable colors than its curve, somebody else
    has numbered them, and no curve is known.

    Args:
        surface: the labelled surface.
        instance: its topological graph.
        vertex_cell: the cell of each vertex, ``OUTSIDE`` where unreachable.
    """
    cells = np.array(vertex_cell, dtype=np.int64)
    reached = cells != OUTSIDE
    areas = np.bincount(cells[reached], surface.vertex_areas[reached], len(instance.cells))
    measured = tuple(
        replace(cell, area=float(area)) for cell, area in zip(instance.cells, areas, strict=True)
    )
    return Decomposition(
        replace(instance, cells=measured, coverage=coverage_of(surface)),
        _curves(surface, instance, list(vertex_cell)),
        tuple(vertex_cell),
    )


def _curves(surface: LabelledSurface, instance: Instance, cell_of: list[int]) -> dict[int, Curve]:
    mesh = ClosedMesh(surface)
    cell_of = cell_of + [OUTSIDE] * (mesh.vertex_count - mesh.real_count)
    borders = Borders(surface, mesh, cell_of)
    curves = dict(enumerate(borders.curves(), start=1))
    if curves.keys() != {edge.id for edge in instance.edges}:
        return {}
    for edge in instance.edges:
        left, right = curves[edge.id].steps[0]
        same = (cell_of[left], cell_of[right]) == (edge.left, edge.right)
        if not same or borders.joinable(left, right) != frozenset(instance.joinable(edge.id)):
            return {}
    return curves
