"""The sliver policies written down plainly: all cells are looked at again after every change.

That takes the square of the cells, and is what the quick way in the package is held to.
"""

from __future__ import annotations

from collections import Counter, defaultdict

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.reach.continuity import Coloring
from cellcolor.frontend.reach.slivers import _cells
from cellcolor.frontend.setup import Slivers

Branches = frozenset[int]


def clean(
    edges: Index, linked: Mask, coloring: Coloring, areas: Array, policy: Slivers
) -> tuple[Mask, list[float], int]:
    """The nodes to keep, the areas of the cells that were simplified, how many were given up."""
    node_color = coloring.node_color
    cell_of = _cells(edges, linked, node_color)
    graph = CellGraph(edges, linked, node_color, cell_of, areas)
    total = float(areas.sum())
    simplified = graph.simplify(policy.simplify_below_share * total)
    given_up = graph.give_up(policy.uncover_below_share * total)
    kept = np.zeros(node_color.shape, dtype=bool)
    for cell, branches in enumerate(graph.final_branches()):
        kept[np.ix_(cell_of == cell, sorted(branches))] = True
    return kept, simplified, given_up


class CellGraph:
    """Cells with their branches, areas and neighbors; merged cells point to what took them in."""

    def __init__(
        self, edges: Index, linked: Mask, node_color: Index, cell_of: Index, areas: Array
    ) -> None:
        count = int(cell_of.max()) + 1
        first = np.unique(cell_of, return_index=True)[1]
        self._branches = [frozenset(np.flatnonzero(row >= 0).tolist()) for row in node_color[first]]
        self._area: list[float] = np.bincount(cell_of, areas, minlength=count).tolist()
        self._merged_into: dict[int, int] = {}
        # How many mesh edges with which continuous branches lead to each neighbor.
        self._borders: list[dict[int, Counter[Branches]]] = [
            defaultdict(Counter) for _ in range(count)
        ]
        ends = cell_of[edges]
        for row in np.flatnonzero(ends[:, 0] != ends[:, 1]):
            a, b = ends[row].tolist()
            joined = frozenset(np.flatnonzero(linked[row]).tolist())
            self._borders[a][b][joined] += 1
            self._borders[b][a][joined] += 1

    def simplify(self, below: float) -> list[float]:
        """Give cells smaller than ``below`` (m^2) the branches of a neighbor, smallest first.

        Of the neighbors with a non-empty part of the cell's branches, those with the most
        branches are taken, then the one with the longest border.

        Returns:
            the areas of the cells that changed.
        """
        changed = []
        waiting = sorted(self._living(), key=lambda cell: (self._area[cell], cell))
        while waiting:
            cell = waiting.pop(0)
            if cell in self._merged_into or not 0 < self._area[cell] < below:
                continue
            own = self._branches[cell]
            choices = []
            for other, border in self._borders[cell].items():
                wanted = self._branches[other]
                length = _length(border, wanted)
                if wanted and wanted < own and length:
                    choices.append((len(wanted), length, -other))
            if not choices:
                continue
            changed.append(self._area[cell])
            self._branches[cell] = self._branches[-max(choices)[2]]
            self._merge_equal(cell)
            # The new colors may be what a neighbor has been waiting for, or the cell still small.
            waiting = sorted(self._living(), key=lambda cell: (self._area[cell], cell))
        return changed

    def give_up(self, below: float) -> int:
        """Take all branches from cells smaller than ``below`` (m^2); how many there were."""
        small = [c for c in self._living() if self._branches[c] and self._area[c] < below]
        for cell in small:
            self._branches[cell] = frozenset()
        return len(small)

    def final_branches(self) -> list[Branches]:
        """The branches of each original cell."""
        return [self._branches[self._survivor(cell)] for cell in range(len(self._branches))]

    def _living(self) -> list[int]:
        return [cell for cell in range(len(self._branches)) if cell not in self._merged_into]

    def _survivor(self, cell: int) -> int:
        while cell in self._merged_into:
            cell = self._merged_into[cell]
        return cell

    def _merge_equal(self, cell: int) -> None:
        """Take in the neighbors that have the same branches and no crack all along the border."""
        same = self._branches[cell]
        for other in [
            other
            for other, border in self._borders[cell].items()
            if self._branches[other] == same and _length(border, same)
        ]:
            self._merged_into[other] = cell
            self._area[cell] += self._area[other]
            for third, border in self._borders[other].items():
                del self._borders[third][other]
                if third != cell:
                    self._borders[cell][third] += border
                    self._borders[third][cell] += border


def _length(border: Counter[Branches], branches: Branches) -> int:
    """Mesh edges of the border along which all the branches are continuous."""
    return sum(count for joined, count in border.items() if branches <= joined)
