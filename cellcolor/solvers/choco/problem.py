"""What is given: the live darts of each cell in cyclic order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from math import inf

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import TooLarge
from cellcolor.solvers.bounds.cover import Region, color_regions
from cellcolor.solvers.joined_chains import only_loops

Pair = tuple[int, int]
"""Two darts of one cell, in the order of its list."""

LARGEST_MODEL = 6e5
"""The most terms of a model that is built; the solver may take kilobytes for each."""

MANY_DARTS = 300
"""A cell with more darts makes a model too large; its pairs of darts are not even counted."""


@dataclass(frozen=True)
class Problem:
    """The live graph. A dart is a signed edge; ``-dart`` is the other side of the edge.

    Attributes:
        cells: the live darts of each cell in cyclic order.
        colors: the joinable colors of each live edge.
        cell_colors: the available colors of each cell.
        regions: the color regions; no segment reaches beyond one.
    """

    cells: tuple[tuple[int, ...], ...]
    colors: Mapping[int, frozenset[int]]
    cell_colors: tuple[frozenset[int], ...]
    regions: tuple[Region, ...]

    @classmethod
    def of(cls, instance: Instance, deadline: Deadline = NEVER) -> Problem:
        """The live graph of an instance.

        Raises:
            InputError: a cell has several loops with live darts.
            TooLarge: a model would not fit into memory.
        """
        loops = only_loops(instance)
        deadline.check()
        colors = {edge: frozenset(instance.joinable(edge)) for edge in instance.live_edges}
        own = tuple(frozenset(cell.colors) for cell in instance.cells)
        problem = cls(tuple(loops), colors, own, tuple(color_regions(instance)))
        if problem.size > LARGEST_MODEL:
            raise TooLarge(f"a model of more than {LARGEST_MODEL:.1g} terms is not built")
        return problem

    @cached_property
    def darts(self) -> tuple[int, ...]:
        """All live darts, cell by cell."""
        return tuple(dart for cell in self.cells for dart in cell)

    @cached_property
    def cell_of(self) -> dict[int, int]:
        """The cell of each dart."""
        return {dart: number for number, cell in enumerate(self.cells) for dart in cell}

    def colors_of(self, dart: int) -> frozenset[int]:
        """The joinable colors of a dart's edge."""
        return self.colors[abs(dart)]

    def pairs(self) -> Iterator[Pair]:
        """All pairs of darts that can be in one sub-cell, with both joins counted.

        They need a common color. They cannot be the two sides of one edge: that join would lead
        from the sub-cell back to itself, and such joins are not counted.
        """
        for cell in self.cells:
            for place, one in enumerate(cell):
                for other in cell[place + 1 :]:
                    common = not self.colors_of(one).isdisjoint(self.colors_of(other))
                    if common and one != -other:
                        yield one, other

    @cached_property
    def region_of(self) -> dict[tuple[int, int], int]:
        """The number of the region of each (color, cell)."""
        return {(c, cell): n for n, (c, cells) in enumerate(self.regions) for cell in cells}

    @cached_property
    def homes(self) -> frozenset[int]:
        """For each color region the cell with most darts among those of that color alone.

        A cell with one color is never divided, so its segment may have its root there.
        """
        found = set()
        for color, cells in self.regions:
            only = [cell for cell in sorted(cells) if self.cell_colors[cell] == {color}]
            if only:
                found.add(max(only, key=lambda cell: len(self.cells[cell])))
        return frozenset(found)

    def later_leaf(self, one: int, other: int) -> bool:
        """Whether both darts lead to leaf cells, and linked, the second leaf cell need not be the
        root.

        A leaf cell is a cell with a single live dart. A segment that can have its root in one of
        two leaf cells can have it in the other, so the first one suffices, unless the second is a
        home.
        """
        first, second = (self.cell_of[-dart] for dart in (one, other))
        leaves = len(self.cells[first]) == len(self.cells[second]) == 1
        return leaves and second not in self.homes

    @property
    def size(self) -> float:
        """About how many terms a model has; most are in the constraints that prevent crossing."""
        if any(len(cell) > MANY_DARTS for cell in self.cells):
            return inf  # far too many
        place = {dart: number for cell in self.cells for number, dart in enumerate(cell)}
        return sum(4.0 * (place[other] - place[one]) + 8 for one, other in self.pairs())
