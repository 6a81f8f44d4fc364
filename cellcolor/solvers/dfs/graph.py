"""The topological graph, prepared for the reference solver (paper, section III-C).

Dead darts are left out, each edge is split into parallel strands, and seams connect the loops of a
cell with holes into one cyclic list (docs/semantics.md, sections 4 and 5). The CP-SAT solver
(``cpsat/model/dart_graph.py``) and the checker (``dart_lists.py``) have their own code for strands
and seams, on purpose: a mistake in one of the three is found by comparing with the others.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import log2

from cellcolor.data.cells_and_edges import Cell, DartName, strand_of, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Seam


@dataclass(frozen=True, slots=True)
class GraphCell:
    """A cell with one cyclic list of live darts.

    Attributes:
        darts: its live darts in cyclic order.
        joinable: for each dart, the colors that may continue across it.
        partner: for each dart, the place of its twin if that is in the same cell, else -1.
        strand_before: for each dart, 0 if the dart before it belongs to another edge. Otherwise
            both are strands of one edge: +1 if their numbers ascend here, -1 if they descend.
    """

    id: int
    colors: tuple[int, ...]
    darts: tuple[DartName, ...]
    joinable: tuple[frozenset[int], ...]
    partner: tuple[int, ...]
    strand_before: tuple[int, ...]


class Graphs:
    """The cells of an instance in search order, each as one cyclic list of darts.

    Every live edge has so many parallel strands.
    """

    def __init__(self, instance: Instance, strands: int) -> None:
        self._instance = instance
        self._strands = strands
        self._live_loops = instance.live_loops
        next_id = max((edge.id for edge in instance.edges), default=0) + 1
        self._first_seam: dict[int, int] = {}
        for cell in instance.cells:
            self._first_seam[cell.id] = next_id
            next_id += max(0, len(self._live_loops[cell.id]) - 1)
        self.region = self._regions()
        """The region of each (cell, color): the part of the color's domain that joinable edges
        connect. No segment reaches beyond its region."""

    def cells_with_several_loops(self) -> list[int]:
        """The cells that need seams."""
        return [cell for cell, loops in enumerate(self._live_loops) if len(loops) > 1]

    def parts(self) -> list[list[Cell]]:
        """The connected parts of the graph, the cells of each in search order.

        The paper chooses the next cell arbitrarily. Here it is a neighbour of the cells before it
        that leaves the fewest choices (``_freedom``), so that the search branches little and
        its frontier stays short.
        """
        unsolved = {cell.id for cell in self._instance.cells}
        parts: list[list[Cell]] = []
        while unsolved:
            part: list[Cell] = []
            reached = unsolved
            while reached:
                chosen = min(reached, key=lambda cell: self._freedom(cell, unsolved))
                unsolved.discard(chosen)
                part.append(self._instance.cells[chosen])
                reached = {n for cell in part for n in self._neighbours(cell.id)} & unsolved
            parts.append(part)
        return parts

    def _neighbours(self, cell: int) -> Iterator[int]:
        for loop in self._live_loops[cell]:
            for dart in loop:
                yield self._instance.across(dart)

    def _freedom(self, cell: int, unsolved: set[int]) -> tuple[float, int, int]:
        """About how many bits of choice a cell has; if equal, first the one with more darts fixed.

        Each dart towards an unsolved neighbour is one bit. If all are, so is the choice of color.
        """
        sides = [neighbour in unsolved for neighbour in self._neighbours(cell)]
        free = sum(sides)
        bits = free + (log2(len(self._instance.cells[cell].colors)) if all(sides) else 0.0)
        return bits, free - len(sides), cell

    def sufficient_seam_strands(self, cell: int) -> list[int]:
        """How many strands each seam of a cell needs so that no division is lost.

        With two loops it is half their darts minus one. With more loops, each seam needs half the
        darts of the whole cell, in which the strands of earlier seams count on both sides.
        """
        counts = [self._strands * len(loop) for loop in self._live_loops[cell]]
        total = sum(counts)
        if len(counts) == 2:
            return [max(0, total // 2 - 1)]
        strands = []
        for _ in counts[1:]:
            strands.append(total // 2)
            total += 2 * strands[-1]
        return strands

    def cell(self, cell: Cell, seam_strands: int) -> tuple[GraphCell, list[Seam]]:
        """A cell as one cyclic list, and its seams, each with at most ``seam_strands`` strands."""
        loops = sorted(self._live_loops[cell.id], key=len, reverse=True)
        joinable: dict[DartName, frozenset[int]] = {}
        for loop in loops:
            for dart in loop:
                for name in self._names(dart):
                    joinable[name] = frozenset(self._instance.joinable(dart))
        walk = [name for dart in loops[0] for name in self._names(dart)] if loops else []
        seams = []
        for number, enough in enumerate(self.sufficient_seam_strands(cell.id) if loops else []):
            loop = loops[number + 1]
            # All seams begin on the longest loop, each behind a different dart if there are enough.
            seam = Seam(
                id=self._first_seam[cell.id] + number,
                cell=cell.id,
                from_=loops[0][-1 - number % len(loops[0])],
                to=loop[-1],
                strands=min(enough, seam_strands),
            )
            seams.append(seam)
            place = walk.index(self._names(seam.from_)[-1]) + 1
            there: list[DartName] = [(seam.id, s) for s in range(1, seam.strands + 1)]
            back = [twin(name) for name in reversed(there)]
            joinable.update((name, frozenset(cell.colors)) for name in there + back)
            walk[place:place] = [*there, *(n for dart in loop for n in self._names(dart)), *back]
        return _graph_cell(cell, walk, joinable), seams

    def _names(self, dart: int) -> list[DartName]:
        if self._strands == 1:
            return [dart]
        names: list[DartName] = [(dart, strand) for strand in range(1, self._strands + 1)]
        return names if dart > 0 else names[::-1]

    def _regions(self) -> dict[tuple[int, int], int]:
        region: dict[tuple[int, int], int] = {}
        count = 0
        for cell in self._instance.cells:
            for color in cell.colors:
                if (cell.id, color) in region:
                    continue
                stack = [cell.id]
                while stack:
                    member = stack.pop()
                    if (member, color) in region:
                        continue
                    region[member, color] = count
                    stack += [
                        self._instance.across(dart)
                        for loop in self._live_loops[member]
                        for dart in loop
                        if color in self._instance.joinable(dart)
                    ]
                count += 1
        return region


def _graph_cell(
    cell: Cell, walk: Sequence[DartName], joinable: dict[DartName, frozenset[int]]
) -> GraphCell:
    place = {name: i for i, name in enumerate(walk)}
    strand_before = []
    for i, name in enumerate(walk):
        same = i > 0 and strand_of(walk[i - 1])[0] == strand_of(name)[0]
        strand_before.append(0 if not same else 1 if strand_of(name)[0] > 0 else -1)
    return GraphCell(
        id=cell.id,
        colors=cell.colors,
        darts=tuple(walk),
        joinable=tuple(joinable[name] for name in walk),
        partner=tuple(place.get(twin(name), -1) for name in walk),
        strand_before=tuple(strand_before),
    )
