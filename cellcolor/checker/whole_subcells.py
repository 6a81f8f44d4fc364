"""Sub-cells as they are on the surface, without seams (docs/semantics.md, section 5)."""

from __future__ import annotations

from typing import NamedTuple

from cellcolor.checker.groups import Groups
from cellcolor.data.cells_and_edges import Strand, strand_of, twin
from cellcolor.data.solution import CellDivision


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
