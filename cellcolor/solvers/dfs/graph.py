"""The topological graph (paper, section III-C), as the search walks over it.

A cell is the cyclic list of its live darts. Beyond the paper, an edge may have several parallel
strands, and seams make one list of the loops of a cell with holes (docs/semantics.md, sections 4
and 5). The CP-SAT solver (``cpsat/dart_graph.py``) and the checker (``dart_lists.py``) have
their own code for both, on purpose: a mistake in one of the three is found by comparing.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

from cellcolor.data.cells_and_edges import DartName, strand_of, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam


@dataclass(frozen=True)
class GraphCell:
    """A cell with its live darts in cyclic order, and the colors that may continue across each."""

    id: int
    colors: tuple[int, ...]
    darts: tuple[DartName, ...]
    joinable: tuple[frozenset[int], ...]

    @cached_property
    def twins(self) -> tuple[DartName, ...]:
        """The other side of each dart."""
        return tuple(map(twin, self.darts))

    @cached_property
    def partners(self) -> tuple[int, ...]:
        """For each dart the place of its twin if that is in the same cell, else -1."""
        place = {dart: i for i, dart in enumerate(self.darts)}
        return tuple(place.get(dart, -1) for dart in self.twins)

    @cached_property
    def strands(self) -> tuple[int, ...]:
        """For each dart 0 unless the one before is a strand of the same edge, its neighbor.

        It is then 1 if their numbers ascend here, -1 if they descend.
        """
        edges = [strand_of(dart)[0] for dart in self.darts]
        pairs = zip([0, *edges], edges, strict=False)
        return tuple((1 if edge > 0 else -1) * (edge == before) for before, edge in pairs)


class Graph:
    """The cells of an instance, every live edge with so many parallel strands."""

    def __init__(self, instance: Instance, strands: int) -> None:
        self.instance, self._strands = instance, strands
        self._loops = instance.live_loops
        self._last_edge = max((edge.id for edge in instance.edges), default=0)
        seams = (max(0, len(loops) - 1) for loops in self._loops)
        self._first_seam = list(accumulate(seams, initial=self._last_edge + 1))

    def parts(self) -> list[list[int]]:
        """The connected parts of the graph, the cells of each in the order in which to solve them.

        "An unsolved cell is arbitrarily chosen" (section V): here it is a neighbor of solved cells,
        the one with the fewest darts that face unsolved ones.
        """
        unsolved = set(range(len(self.instance.cells)))
        faced = [
            [self.instance.across(dart) for loop in loops for dart in loop] for loops in self._loops
        ]

        def freedom(cell: int) -> tuple[int, int, int]:
            free = sum(other in unsolved for other in faced[cell])
            return free, free - len(faced[cell]), cell

        parts: list[list[int]] = []
        while unsolved:
            part: list[int] = []
            reached = unsolved
            while reached:
                part.append(min(reached, key=freedom))
                unsolved.discard(part[-1])
                reached = {other for cell in part for other in faced[cell]} & unsolved
            parts.append(part)
        return parts

    def sufficient_seam_strands(self, cell: int) -> list[int]:
        """How many strands each seam of a cell needs so that no division is lost.

        With two loops it is half their darts minus one. With more, each seam needs half the darts
        of the whole cell, in which the strands of earlier seams count on both sides.
        """
        counts = [self._strands * len(loop) for loop in self._loops[cell]]
        total = sum(counts)
        if len(counts) == 2:
            return [max(0, total // 2 - 1)]
        strands = []
        for _ in counts[1:]:
            strands.append(total // 2)
            total += 2 * strands[-1]
        return strands

    def cell(self, number: int, seam_strands: int) -> tuple[GraphCell, list[Seam]]:
        """A cell as one cyclic list, and its seams, each with at most ``seam_strands`` strands."""
        cell = self.instance.cells[number]
        loops = sorted(self._loops[number], key=len, reverse=True)
        walk = [name for dart in loops[0] for name in self._names(dart)] if loops else []
        seams = []
        for place, enough in enumerate(self.sufficient_seam_strands(number)):
            # All seams begin on the longest loop, each behind a different dart if there are enough.
            loop, leave = loops[place + 1], loops[0][-1 - place % len(loops[0])]
            strands = min(enough, seam_strands)
            seam = Seam(self._first_seam[number] + place, cell.id, leave, loop[-1], strands)
            there: list[DartName] = [(seam.id, s) for s in range(1, strands + 1)]
            back = [twin(name) for name in reversed(there)]
            at = walk.index(self._names(leave)[-1]) + 1
            walk[at:at] = [*there, *(name for dart in loop for name in self._names(dart)), *back]
            seams.append(seam)
        across = tuple(
            frozenset(cell.colors if edge > self._last_edge else self.instance.joinable(edge))
            for edge in (abs(strand_of(name)[0]) for name in walk)
        )
        return GraphCell(cell.id, cell.colors, tuple(walk), across), seams

    def _names(self, dart: int) -> list[DartName]:
        if self._strands == 1:
            return [dart]
        names: list[DartName] = [(dart, strand) for strand in range(1, self._strands + 1)]
        return names if dart > 0 else names[::-1]
