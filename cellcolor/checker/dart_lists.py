"""The cyclic lists of live darts that a division is written in, strands and seams put in.

A strand is one of several parallel corridors across an edge; a seam is a virtual edge that makes
one cyclic list of two loops of a cell (docs/semantics.md, sections 4 and 5). Both solvers have
their own code for them (``dfs/graph.py``, ``cpsat/dart_graph.py``), on purpose: a mistake in one of
the three is found by comparing. :func:`whole_subcells` takes seams out again.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import Strand, strand_of, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, Seam


class NoLists(Exception):
    """Seams do not make one cyclic list of a cell's loops, or there are too many strands."""


MOST_DARTS = 500_000
"""Live darts, strands counted; they take up to 3 kB each (10,000 cells with 4 strands an edge have
a quarter million)."""


def live_lists(instance: Instance, seams: Sequence[Seam], strands: int) -> list[list[Strand]]:
    """Each cell's live darts as one cyclic list.

    Args:
        seams: how the loops of cells with several of them are connected, in order.
        strands: per live edge; a seam has its own number.

    Raises:
        NoLists: a seam is not where it can be, loops with live darts stay unconnected, or there are
            more than ``MOST_DARTS``.
    """
    counts = {edge.id: strands if instance.joinable(edge.id) else 0 for edge in instance.edges}
    darts = 2 * sum(counts.values())  # what is joinable has a cell on both sides
    darts += sum(2 * seam.strands for seam in seams)
    if darts > MOST_DARTS:
        raise NoLists(f"strands: would make {darts} darts, at most {MOST_DARTS} are checked")
    loops = {cell.id: [list(loop) for loop in cell.loops] for cell in instance.cells}
    highest = max((edge.id for edge in instance.edges), default=0)
    for seam in seams:
        if seam.id <= highest:
            raise NoLists(f"seams: seam {seam.id}: its id must be above {highest}")
        highest = seam.id
        if seam.cell not in loops:
            raise NoLists(f"seams: seam {seam.id}: there is no cell {seam.cell}")
        _connect(loops[seam.cell], seam)
        counts[seam.id] = seam.strands
    lists = []
    for cell, found in loops.items():
        live = [loop for loop in found if any(counts[abs(dart)] for dart in loop)]
        if len(live) > 1:
            apart = f"{len(live)} loops with live darts are not connected"
            raise NoLists(f"seams: cell {cell}: {apart}")
        whole = live[0] if live else []
        lists.append([s for dart in whole for s in strands_along(dart, counts[abs(dart)])])
    return lists


def strands_along(dart: int, count: int) -> list[Strand]:
    """The strands of a dart, in the order in which a walk along its loop meets them."""
    numbers = range(1, count + 1)
    return [(dart, number) for number in (numbers if dart > 0 else reversed(numbers))]


def _connect(loops: list[list[int]], seam: Seam) -> None:
    where = f"seams: seam {seam.id}"
    near = next((loop for loop in loops if seam.from_ in loop), None)
    far = next((loop for loop in loops if seam.to in loop), None)
    if near is None or far is None:
        missing = seam.from_ if near is None else seam.to
        raise NoLists(f"{where}: dart {missing} is not in the loops of cell {seam.cell}")
    if near is far:
        raise NoLists(f"{where}: darts {seam.from_} and {seam.to} are in one loop already")
    start, place = far.index(seam.to) + 1, near.index(seam.from_) + 1
    near[place:place] = [seam.id, *far[start:], *far[:start], -seam.id]
    loops.remove(far)


class WholeSubCell(NamedTuple):
    """A sub-cell as it is on the surface, with its darts in state 1, those of seams left out."""

    color: int
    segment: int
    strands: frozenset[Strand]


def whole_subcells(cell: CellDivision, seams: set[int]) -> list[WholeSubCell]:
    """The sub-cells of a cell: those that only a seam, given by its id, parts are one."""
    holder = {
        strand_of(name): number for number, sub in enumerate(cell.subcells) for name in sub.darts
    }
    whole = Groups(range(len(cell.subcells)))
    for strand, number in holder.items():
        if abs(strand[0]) in seams and twin(strand) in holder:
            whole.join(number, holder[twin(strand)])
    found = []
    for parts in whole.sets():
        first = cell.subcells[min(parts)]
        strands = (strand_of(name) for part in parts for name in cell.subcells[part].darts)
        own = frozenset(strand for strand in strands if abs(strand[0]) not in seams)
        found.append(WholeSubCell(first.color, first.segment, own))
    return found
