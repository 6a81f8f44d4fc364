"""A division that needs no search, so that no lower bound can be above it."""

from __future__ import annotations

from collections import defaultdict

from cellcolor.data.instance import Instance

__all__ = ["segments_of_whole_cells"]

_Node = tuple[int, int]
"""A cell, and one of its colors."""


def segments_of_whole_cells(instance: Instance) -> int:
    """The segments of a painting of undivided cells, a large region of one color after another.

    To paint every cell whole is legal in both search spaces, with any number of strands, and cells
    of one color are joined wherever they can be. So the fewest segments are at most these.
    """
    regions = _Groups()
    for cell in instance.cells:
        for color in cell.colors:
            regions.find((cell.id, color))
    for edge in instance.edges:
        for color in instance.joinable(edge.id):
            regions.join((edge.left, color), (edge.right, color))
    members: dict[_Node, list[_Node]] = defaultdict(list)
    for node in regions.nodes():
        members[regions.find(node)].append(node)
    painted: dict[int, int] = {}
    for region in sorted(members.values(), key=len, reverse=True):
        for cell_id, color in region:
            painted.setdefault(cell_id, color)
    segments = _Groups()
    for node in painted.items():
        segments.find(node)
    for edge in instance.edges:
        color = painted.get(edge.left, -1)
        if color in instance.joinable(edge.id) and painted[edge.right] == color:
            segments.join((edge.left, color), (edge.right, color))
    return sum(segments.find(node) == node for node in segments.nodes())


class _Groups:
    """Disjoint sets of cells in a color."""

    def __init__(self) -> None:
        self._above: dict[_Node, _Node] = {}

    def nodes(self) -> list[_Node]:
        return list(self._above)

    def find(self, node: _Node) -> _Node:
        """The one that stands for a set; a node not seen before is a set of its own."""
        above = self._above
        above.setdefault(node, node)
        while above[node] != node:
            above[node] = above[above[node]]
            node = above[node]
        return node

    def join(self, one: _Node, other: _Node) -> None:
        self._above[self.find(one)] = self.find(other)
