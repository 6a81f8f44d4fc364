"""Which color regions each place lies in, found by the checker itself.

A color region is all that one segment of a color could ever reach (docs/semantics.md, section 4).
On a graph it is made of cells, on a labelled surface of vertices.
"""

from __future__ import annotations

from collections.abc import Sequence

from cellcolor.checker.groups import Groups
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface

ColorRegion = tuple[int, int]
"""A color, and one place in the region that stands for it."""


def regions_of_cells(instance: Instance) -> list[frozenset[ColorRegion]]:
    """The color regions that each cell of a topological graph lies in."""
    together: Groups[ColorRegion] = Groups()
    for cell in instance.cells:
        for color in cell.colors:
            together.find((color, cell.id))
    for edge in instance.edges:
        for color in instance.joinable(edge.id):
            together.join((color, edge.left), (color, edge.right))
    return [
        frozenset(together.find((color, cell.id)) for color in cell.colors)
        for cell in instance.cells
    ]


def regions_on_surface(
    surface: LabelledSurface, vertex_cell: Sequence[int]
) -> list[frozenset[ColorRegion]]:
    """The color regions that one vertex of each cell lies in, flooded over the mesh.

    Two vertices of a mesh edge are in one region of a color that both have, unless the edge has a
    crack of that color. The graph's edges are not believed; ``vertex_cell`` is below 0 for none.
    """
    together: Groups[ColorRegion] = Groups()
    for a, b in surface.left_of:
        cracked = surface.cracked(a, b)
        for color in surface.vertex_colors[a]:
            if color in surface.vertex_colors[b] and color not in cracked:
                together.join((color, a), (color, b))
    found: dict[int, frozenset[ColorRegion]] = {}
    for vertex, cell in enumerate(vertex_cell):
        if cell >= 0 and cell not in found:
            own = surface.vertex_colors[vertex]
            found[cell] = frozenset(together.find((color, vertex)) for color in own)
    return [found[cell] for cell in sorted(found)]
