"""Sliver policies: fewer small cells, on request (``docs/frontend.md``, "Slivers").

Two branches with nearly the same domain have nearly coincident borders, and the strip between
these falls into cells of a few vertices each. Both policies only ever take colors away, so that
no promise of a color is broken: a small cell is given the color set of a neighbor when that is a
part of its own, and cells that are still small may be given up.

A surface can have as many small cells as vertices, so the time has to grow hardly faster than
their number: a cell is asked again only when a neighbor has changed, and when two places become one
the list of neighbors of the one with fewer cells goes over into the other one's.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import NEVER, Deadline
from cellcolor.frontend.reach.colors import Coloring
from cellcolor.frontend.setup import Slivers
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.union_find import UnionFind

Branches = int
"""A set of branches, a bit each: on one vertex a color is told by its branch."""
Border = dict[Branches, int]
"""How many mesh edges with which continuous branches lead from one cell to another."""


@dataclass(frozen=True)
class SliverReport:
    """What the policies changed.

    Attributes:
        simplified_cells: cells that took a neighbor's colors.
        simplified_area_m2: of these; still covered.
        given_up_cells: cells reported as uncovered because they are small.
        given_up_vertices: vertices in these.
        given_up_area_m2: of these.
    """

    simplified_cells: int
    simplified_area_m2: float
    given_up_cells: int
    given_up_vertices: int
    given_up_area_m2: float


def clean(
    edges: Index,
    coloring: Coloring,
    areas: Array,
    policy: Slivers,
    deadline: Deadline = NEVER,
) -> tuple[Mask, SliverReport]:
    """Which nodes to keep, (n, branches).

    Colors have to be computed again from what is kept: taking away a cell can cut one in two.

    Args:
        edges: (k, 2) mesh edges.
        coloring: the colors of all valid nodes.
        areas: (n,) of the vertices, m^2.
        policy: thresholds, as shares of the surface's area.
    """
    node_color, linked = coloring.node_color, coloring.linked
    cell_of = _cells(edges, linked, node_color)
    graph = _CellGraph(edges, linked, node_color, cell_of, areas)
    total = float(areas.sum())
    simplified = graph.simplify(policy.simplify_below_share * total, deadline)
    branches, given_up = graph.given_up(policy.uncover_below_share * total)
    masks = np.array(branches, dtype=np.int64)[cell_of]
    kept = (masks[:, None] >> np.arange(node_color.shape[1]) & 1).astype(bool)
    lost = (node_color >= 0).any(axis=1) & ~kept.any(axis=1)
    report = SliverReport(
        simplified_cells=len(simplified),
        simplified_area_m2=sum(simplified),
        given_up_cells=given_up,
        given_up_vertices=int(lost.sum()),
        given_up_area_m2=float(areas[lost].sum()),
    )
    return kept, report


def _cells(edges: Index, linked: Mask, node_color: Index) -> Index:
    """Cell of each vertex, (n,): equal colors, joined over edges without a crack."""
    first, second = node_color[edges[:, 0]], node_color[edges[:, 1]]
    together = ((first == second) & (linked | (first < 0))).all(axis=1)
    return grouped(len(node_color), edges[together])


class _CellGraph:
    """Cells with their branches, areas and neighbors.

    Cells that have become one share a place: the index of one of them, where all lists have what
    is true of the whole. It goes by the number of the cell that took the others in.
    """

    def __init__(
        self, edges: Index, linked: Mask, node_color: Index, cell_of: Index, areas: Array
    ) -> None:
        count = int(cell_of.max()) + 1
        bits = 1 << np.arange(node_color.shape[1])
        first = np.unique(cell_of, return_index=True)[1]
        self._branches: list[Branches] = ((node_color[first] >= 0) @ bits).tolist()
        self._area: list[float] = np.bincount(cell_of, areas, minlength=count).tolist()
        self._name = list(range(count))
        self._places = UnionFind(range(count))
        # One border for both sides of it: it is the same object in the lists of both cells.
        self._borders: list[dict[int, Border]] = [{} for _ in range(count)]
        ends = np.sort(cell_of[edges], axis=1)
        across = ends[:, 0] != ends[:, 1]
        kinds = np.column_stack([ends[across], linked[across] @ bits])
        for (a, b, joined), length in zip(
            *(found.tolist() for found in np.unique(kinds, axis=0, return_counts=True)), strict=True
        ):
            border = self._borders[a].setdefault(b, {})
            border[joined] = length
            self._borders[b][a] = border

    def simplify(self, below: float, deadline: Deadline) -> list[float]:
        """Give cells smaller than ``below`` (m^2) the branches of a neighbor, smallest first.

        Of the neighbors with a non-empty part of the cell's branches, those with the most
        branches are taken, then the one with the longest border.

        Returns:
            the areas of the cells that changed.
        """
        changed: list[float] = []
        # Small cells that may have such a neighbor; all others are known to have none.
        doubtful: set[int] = set()
        queue: list[tuple[float, int, int]] = []

        def ask(place: int) -> None:
            if 0 < self._area[place] < below:
                doubtful.add(place)
                heapq.heappush(queue, (self._area[place], self._name[place], place))

        for place in range(len(self._area)):
            ask(place)
        while queue:
            deadline.check()
            area, name, place = heapq.heappop(queue)
            if place not in doubtful or (area, name) != (self._area[place], self._name[place]):
                continue
            doubtful.discard(place)
            wanted = self._part_of_its_own(place)
            if wanted is None:
                continue
            changed.append(area)
            self._branches[place] = wanted
            # The new colors may be what a neighbor has been waiting for, or the cell still small.
            around = list(self._borders[place])
            for other in {self._merge_equal(place), *map(self._places.__getitem__, around)}:
                ask(other)
        return changed

    def given_up(self, below: float) -> tuple[list[Branches], int]:
        """The branches of each original cell, none if it is smaller than ``below`` (m^2) even with
        those that it has become one with; and how many are given up."""
        places = [self._places[cell] for cell in range(len(self._branches))]
        small = {at for at in places if self._branches[at] and self._area[at] < below}
        return [0 if at in small else self._branches[at] for at in places], len(small)

    def _part_of_its_own(self, place: int) -> Branches | None:
        """The branches that a cell would take over from a neighbor."""
        own = self._branches[place]
        choices = []
        for other, border in self._borders[place].items():
            wanted = self._branches[other]
            if wanted and wanted != own and wanted & own == wanted:
                length = _length(border, wanted)
                if length:
                    choices.append((wanted.bit_count(), length, -self._name[other], wanted))
        return max(choices)[3] if choices else None

    def _merge_equal(self, place: int) -> int:
        """Take in the neighbors that have the same branches and no crack all along the border.

        Returns:
            where all of them are then.
        """
        same, name, area = self._branches[place], self._name[place], self._area[place]
        equal = [
            other
            for other, border in self._borders[place].items()
            if self._branches[other] == same and _length(border, same)
        ]
        for other in sorted(equal, key=self._name.__getitem__):
            area += self._area[other]
            place = self._united(place, other)
        self._name[place], self._area[place] = name, area
        return place

    def _united(self, first: int, second: int) -> int:
        """Make two neighboring places one."""
        self._places.union(first, second)
        if self._places[first] != first:
            first, second = second, first
        self._area[second] = 0.0
        kept = self._borders[first]
        for third, border in self._borders[second].items():
            del self._borders[third][second]
            if third == first:
                continue
            known = kept.get(third)
            if known is None:
                kept[third] = self._borders[third][first] = border
                continue
            for joined, length in border.items():
                known[joined] = known.get(joined, 0) + length
        self._borders[second] = {}
        return first


def _length(border: Border, branches: Branches) -> int:
    """Mesh edges of the border along which all the branches are continuous."""
    return sum(count for joined, count in border.items() if branches & joined == branches)
