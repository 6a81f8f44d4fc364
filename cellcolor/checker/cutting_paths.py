"""How many cutting paths a division needs (docs/semantics.md, section 8)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import Cell, Strand, strand_of, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, Division, Seam


def cutting_paths(instance: Instance, division: Division, seams: Sequence[Seam] = ()) -> int:
    """The fewest curves that part the cells into the sub-cells of a legal division.

    A curve is closed or begins and ends on the border of its cell; curves do not cross. It does
    not matter where seams lie, nor where darts in state 0 do.
    """
    virtual = {seam.id for seam in seams}
    return sum(
        _of_cell(cell, whole_subcells(divided, virtual))
        for cell, divided in zip(instance.cells, division, strict=True)
    )


class WholeSubCell(NamedTuple):
    """A sub-cell as it is on the surface, where no seam parts anything."""

    color: int
    segment: int
    strands: frozenset[Strand]
    """Its darts in state 1, those of seams left out."""


def whole_subcells(cell: CellDivision, seams: set[int]) -> list[WholeSubCell]:
    """The sub-cells of a cell: those that only a seam, given by its id, parts are one."""
    holder = {
        strand_of(name): number for number, sub in enumerate(cell.subcells) for name in sub.darts
    }
    whole: Groups[int] = Groups()
    for number in range(len(cell.subcells)):
        whole.find(number)
    for strand, number in holder.items():
        if abs(strand[0]) in seams and twin(strand) in holder:
            whole.join(number, holder[twin(strand)])
    return [
        WholeSubCell(
            cell.subcells[min(parts)].color,
            cell.subcells[min(parts)].segment,
            frozenset(
                strand
                for part in parts
                for strand in map(strand_of, cell.subcells[part].darts)
                if abs(strand[0]) not in seams
            ),
        )
        for parts in whole.sets()
    ]


def _of_cell(cell: Cell, subcells: Sequence[WholeSubCell]) -> int:
    """Sub-cells less one, and loops less the groups of loops that the curves cannot but connect.

    Loops and sub-cells that meet make a graph; loops on a common cycle of it are in one group.
    """
    if len(subcells) == 1:
        return 0
    import networkx as nx  # slow to import, and most divisions do without

    loop_of = {dart: number for number, loop in enumerate(cell.loops) for dart in loop}
    meetings: nx.Graph[tuple[str, int]] = nx.Graph()
    meetings.add_edges_from(
        (("sub-cell", number), ("loop", loop_of[dart]))
        for number, subcell in enumerate(subcells)
        for dart, _ in subcell.strands
    )
    groups: Groups[int] = Groups()
    for loop in range(len(cell.loops)):
        groups.find(loop)
    for edges in nx.biconnected_component_edges(meetings):
        if len(edges) > 1:
            met = {number for edge in edges for kind, number in edge if kind == "loop"}
            for loop in met:
                groups.join(min(met), loop)
    return len(subcells) - 1 + len(cell.loops) - len(groups.sets())
