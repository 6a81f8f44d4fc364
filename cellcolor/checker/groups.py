"""What is connected: disjoint sets, and color regions, for the checker alone.

It shares nothing with the solvers but the data classes. A color region is all that one segment of a
color could ever reach (docs/semantics.md, section 4): cells of a graph, or vertices of a surface.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from typing import Generic, TypeVar

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface

T = TypeVar("T", bound=Hashable)


class Groups(Generic[T]):
    """Disjoint sets of nodes; at first each is a set of its own."""

    def __init__(self, nodes: Iterable[T] = ()) -> None:
        self._above = {node: node for node in nodes}

    def find(self, node: T) -> T:
        """The one that stands for a set; a node not seen before is a set of its own."""
        above = self._above
        above.setdefault(node, node)
        while above[node] != node:
            above[node] = above[above[node]]
            node = above[node]
        return node

    def join(self, one: T, other: T) -> None:
        """Make one set of two."""
        self._above[self.find(one)] = self.find(other)

    def sets(self) -> list[list[T]]:
        """The sets, each in the order in which its nodes came."""
        found: dict[T, list[T]] = {}
        for node in self._above:
            found.setdefault(self.find(node), []).append(node)
        return list(found.values())


ColorRegion = tuple[int, int]
"""A color, and one place in the region that stands for it."""


def regions_of_cells(instance: Instance) -> list[frozenset[ColorRegion]]:
    """The color regions that each cell of a topological graph lies in."""
    together: Groups[ColorRegion] = Groups()
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
