"""What can be left out of an instance without changing the minimum."""

from __future__ import annotations

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds import color_regions

__all__ = ["drop_dominated"]


def drop_dominated(instance: Instance) -> tuple[frozenset[int], ...]:
    """The colors of each cell that are enough for a minimum (docs/semantics.md, section 6).

    A color's region may go when some other color is available in each of its cells and joinable
    across each edge that is joinable for it: whatever is painted in the one can be painted in the
    other. One region goes at a time, since of two equal ones the last has to stay. This keeps the
    minimum of both search spaces, not the set of optimal schemes.
    """
    allowed = [set(cell.colors) for cell in instance.cells]
    joinable = {edge.id: set(instance.joinable(edge.id)) for edge in instance.edges}
    for color, cells in sorted(color_regions(instance), key=lambda region: len(region[1])):
        edges = [
            edge
            for edge in instance.edges
            if color in joinable[edge.id] and {edge.left, edge.right} <= cells
        ]
        shared = set.intersection(*(allowed[cell] for cell in cells))
        for edge in edges:
            shared &= joinable[edge.id]
        if shared - {color}:
            for cell in cells:
                allowed[cell].discard(color)
            for edge in edges:
                joinable[edge.id].discard(color)
    return tuple(frozenset(colors) for colors in allowed)
