"""Fewer and larger cells, for lower bounds that hold for any division of the surface."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.union_find import UnionFind


@dataclass(frozen=True, slots=True)
class MergedCells:
    """Cells merged where nothing separates them, each under the id of one of its parts.

    Attributes:
        loops: the live darts around each merged cell.
        sides: the merged cells to the left and to the right of each remaining edge.
        joinable: the joinable colors of each remaining edge.
        merged_cell_of: the merged cell of each cell.
    """

    loops: dict[int, list[list[int]]]
    sides: dict[int, tuple[int, int]]
    joinable: dict[int, frozenset[int]]
    merged_cell_of: dict[int, int]

    def cells(self) -> dict[int, frozenset[int]]:
        """The cells that each merged cell consists of."""
        members: dict[int, list[int]] = {}
        for cell, merged_cell in self.merged_cell_of.items():
            members.setdefault(merged_cell, []).append(cell)
        return {merged_cell: frozenset(cells) for merged_cell, cells in members.items()}


def merge_cells(instance: Instance, colors: Mapping[int, frozenset[int]]) -> MergedCells:
    """Merge neighboring cells where nothing separates them.

    Two cells with the same set of colors, and an edge between them that is joinable for the whole
    set, are one area in which any division can be drawn, so the edge is removed. An edge with one
    merged cell on both sides is removed as well, which may leave a hole. An edge between two loops
    of one merged cell stays, because it is a handle. Dead darts are left out.

    Args:
        instance: the topological graph.
        colors: the colors that each cell may be painted in, of the cells that are looked at.
    """
    joinable: dict[int, frozenset[int]] = {}
    rings = _Rings()
    for cell in colors:
        for loop in instance.cells[cell].loops:
            live: list[int] = []
            for dart in loop:
                own, beyond = instance.joinable(dart), instance.across(dart)
                if own and beyond in colors:
                    shared = colors[cell] & colors[beyond] & frozenset(own)
                    if shared:
                        joinable[abs(dart)] = shared
                        live.append(dart)
            rings.add(live)
    merged: UnionFind[int] = UnionFind(colors)
    for edge_id in sorted(joinable):
        edge = instance.edge(edge_id)
        if colors[edge.left] != joinable[edge_id] or colors[edge.right] != joinable[edge_id]:
            continue
        left, right = merged[edge.left], merged[edge.right]
        if left == right and not rings.same(edge_id, -edge_id):
            continue  # two loops of one cell: a handle, and without the edge it was not planar
        if left != right:
            merged.union(left, right)
        rings.remove(edge_id)
        del joinable[edge_id]
    merged_cell_of = {cell: merged[cell] for cell in colors}
    loops: dict[int, list[list[int]]] = {merged_cell: [] for merged_cell in merged_cell_of.values()}
    sides = {
        edge: (merged_cell_of[instance.edge(edge).left], merged_cell_of[instance.edge(edge).right])
        for edge in joinable
    }
    for darts in rings.loops():
        left, right = sides[abs(darts[0])]
        loops[left if darts[0] > 0 else right].append(darts)
    return MergedCells(loops, sides, joinable, merged_cell_of)


class _Rings:
    """Loops of darts from which edges are taken out, one after the other."""

    def __init__(self) -> None:
        self._next: dict[int, int] = {}
        self._before: dict[int, int] = {}

    def add(self, loop: list[int]) -> None:
        """One more loop."""
        for dart, following in zip(loop, loop[1:] + loop[:1], strict=True):
            self._link(dart, following)

    def same(self, one: int, other: int) -> bool:
        """Whether two darts are on one loop; walks both ways at a time, as far as the nearer."""
        ahead, behind = self._next[one], self._before[one]
        while ahead != one and behind != one:
            if other in (ahead, behind):
                return True
            ahead, behind = self._next[ahead], self._before[behind]
        return False

    def remove(self, edge: int) -> None:
        """Open an edge: two loops become one, or a loop walked on both of its sides two."""
        for dart in (edge, -edge):
            # Where a walk came to the edge it goes on behind the other side.
            self._link(self._before[dart], self._next[-dart])
        for dart in (edge, -edge):
            del self._next[dart], self._before[dart]

    def loops(self) -> list[list[int]]:
        """What is left of the loops."""
        found = []
        seen: set[int] = set()
        for first in self._next:
            if first in seen:
                continue
            loop = [first]
            while self._next[loop[-1]] != first:
                loop.append(self._next[loop[-1]])
            seen.update(loop)
            found.append(loop)
        return found

    def _link(self, one: int, following: int) -> None:
        self._next[one] = following
        self._before[following] = one
