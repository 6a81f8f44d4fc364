"""A division that needs no search, so that no lower bound can be above it."""

from __future__ import annotations

from cellcolor.checker.groups import Groups
from cellcolor.data.instance import Instance

_Node = tuple[int, int]
"""A cell, and one of its colors."""


def segments_of_whole_cells(instance: Instance) -> int:
    """The segments of a painting of undivided cells, a large region of one color after another.

    To paint every cell whole is legal in both search spaces, with any number of strands, and cells
    of one color are joined wherever they can be. So the fewest segments are at most these.
    """
    regions: Groups[_Node] = Groups()
    for cell in instance.cells:
        for color in cell.colors:
            regions.find((cell.id, color))
    for edge in instance.edges:
        for color in instance.joinable(edge.id):
            regions.join((edge.left, color), (edge.right, color))
    painted: dict[int, int] = {}
    for region in sorted(regions.sets(), key=len, reverse=True):
        for cell_id, color in region:
            painted.setdefault(cell_id, color)
    segments: Groups[_Node] = Groups()
    for node in painted.items():
        segments.find(node)
    for edge in instance.edges:
        color = painted.get(edge.left, -1)
        if color in instance.joinable(edge.id) and painted[edge.right] == color:
            segments.join((edge.left, color), (edge.right, color))
    return len(segments.sets())
