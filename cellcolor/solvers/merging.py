"""Fewer and larger cells, for lower bounds that hold for any division of the surface."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cellcolor.data.instance import Instance

__all__ = ["MergedCells", "merge_cells"]


@dataclass(frozen=True, slots=True)
class MergedCells:
    """Cells made one where nothing separates them, each under the id of one of its parts.

    Attributes:
        loops: the live darts around each merged cell.
        sides: the merged cells to the left and to the right of each edge that is left.
        joinable: the joinable colors of each edge that is left.
        part_of: the merged cell that each cell went into.
    """

    loops: dict[int, list[list[int]]]
    sides: dict[int, list[int]]
    joinable: dict[int, frozenset[int]]
    part_of: list[int]


def merge_cells(instance: Instance, colors: Sequence[frozenset[int]]) -> MergedCells:
    """Merge neighboring cells where nothing separates them.

    Two cells with one and the same set of colors, and an edge between them that is joinable for
    the whole set, are one area in which any division can be drawn: the edge goes. An edge with one
    merged cell on both sides goes as well, which may leave a hole. Dead darts are left out.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all, some or none of its own.
    """
    joinable = {
        edge.id: colors[edge.left] & colors[edge.right] & frozenset(instance.joinable(edge.id))
        for edge in instance.edges
        if instance.joinable(edge.id)
    }
    joinable = {edge: shared for edge, shared in joinable.items() if shared}
    loops = {
        cell.id: [live for loop in cell.loops if (live := [d for d in loop if abs(d) in joinable])]
        for cell in instance.cells
    }
    sides = {edge: [instance.edge(edge).left, instance.edge(edge).right] for edge in joinable}
    part_of = [cell.id for cell in instance.cells]
    for edge in sorted(joinable):
        left, right = sides[edge]
        if colors[left] != joinable[edge] or colors[right] != joinable[edge]:
            continue
        near = next(loop for loop in loops[left] if edge in loop)
        far = next(loop for loop in loops[right] if -edge in loop)
        if near is far:
            # The walk there and back along the edge was what held the two parts together.
            turned = _from(near, edge)
            place = turned.index(-edge)
            parts = [turned[:place], turned[place + 1 :]]
            loops[left] = [loop for loop in loops[left] if loop is not near]
        elif left != right:
            parts = [_from(near, edge) + _from(far, -edge)]
            others = [loop for loop in loops.pop(right) if loop is not far]
            loops[left] = [loop for loop in loops[left] if loop is not near] + others
            for pair in sides.values():
                pair[:] = [left if cell == right else cell for cell in pair]
            part_of = [left if cell == right else cell for cell in part_of]
        else:
            continue  # two loops of one cell: a handle, and without the edge it was not planar
        loops[left] += [part for part in parts if part]
        del joinable[edge]
        del sides[edge]
    return MergedCells(loops, sides, joinable, part_of)


def _from(loop: list[int], dart: int) -> list[int]:
    """A cyclic list from behind a dart on, without it."""
    place = loop.index(dart)
    return loop[place + 1 :] + loop[:place]
