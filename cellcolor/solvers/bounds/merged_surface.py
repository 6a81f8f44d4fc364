"""Fewer and larger cells for lower bounds: cells merged where nothing separates them."""

from __future__ import annotations

from collections import defaultdict
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
        joinable: the colors of each remaining edge.
    """

    loops: dict[int, list[list[int]]]
    sides: dict[int, tuple[int, int]]
    joinable: dict[int, frozenset[int]]
    merged_cell_of: dict[int, int]

    def cells(self) -> dict[int, frozenset[int]]:
        """The cells that each merged cell consists of."""
        members: dict[int, set[int]] = defaultdict(set)
        for cell, merged_cell in self.merged_cell_of.items():
            members[merged_cell].add(cell)
        return {merged_cell: frozenset(cells) for merged_cell, cells in members.items()}


def merge_cells(instance: Instance, colors: Mapping[int, frozenset[int]]) -> MergedCells:
    """Merge neighboring cells where nothing separates them.

    Two cells with the same set of colors, and an edge between them that is joinable for the whole
    set, are one area in which any division can be drawn, so the edge is removed. An edge with one
    merged cell on both sides is removed as well, which may leave a hole. An edge between two loops
    of one merged cell stays, because it is a handle. Dead darts are left out.

    Args:
        colors: the colors that each cell may be painted in, of the cells that are looked at.
    """
    none = frozenset[int]()
    live: dict[int, frozenset[int]] = {}
    sides: dict[int, tuple[int, int]] = {}
    rings = _Rings()
    for cell in colors:
        for loop in instance.cells[cell].loops:
            for edge in map(abs, loop):
                if edge not in sides:
                    sides[edge] = left, right = instance.edge(edge).left, instance.edge(edge).right
                    shared = colors.get(left, none) & colors.get(right, none)
                    live[edge] = shared.intersection(instance.joinable(edge))
            rings.add([dart for dart in loop if live[abs(dart)]])
    live = {edge: shared for edge, shared in live.items() if shared}
    names: UnionFind[int] = UnionFind(colors)
    for edge in sorted(live):
        left, right = sides[edge]
        if colors[left] != live[edge] or colors[right] != live[edge]:
            continue
        if names[left] == names[right] and not rings.same(edge, -edge):
            continue  # two loops of one cell: a handle, and without the edge it was not planar
        names.union(left, right)
        rings.remove(edge)
        del live[edge]
    merged_cell_of = {cell: names[cell] for cell in colors}
    found: dict[int, list[list[int]]] = {name: [] for name in merged_cell_of.values()}
    ends = {edge: (merged_cell_of[sides[edge][0]], merged_cell_of[sides[edge][1]]) for edge in live}
    for darts in rings.loops():
        left, right = ends[abs(darts[0])]
        found[left if darts[0] > 0 else right].append(darts)
    return MergedCells(found, ends, live, merged_cell_of)


class _Rings:
    """Loops of darts from which edges are taken out, one after the other."""

    def __init__(self) -> None:
        self._next: dict[int, int] = {}
        self._before: dict[int, int] = {}

    def add(self, loop: list[int]) -> None:
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
        found = []
        seen: set[int] = set()
        for first in self._next:
            if first not in seen:
                loop = [first]
                while (following := self._next[loop[-1]]) != first:
                    loop.append(following)
                seen.update(loop)
                found.append(loop)
        return found

    def _link(self, one: int, following: int) -> None:
        self._next[one] = following
        self._before[following] = one
