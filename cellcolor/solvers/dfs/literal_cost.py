"""The cost rule of the paper at its word (section V-A), for study: no solver uses it."""

from __future__ import annotations

from cellcolor.data.cells_and_edges import twin
from cellcolor.data.solution import Division


def literal_cost(division: Division) -> int:
    """What ``Δcost = 1 - j`` adds up to when j counts distinct solved *cells*.

    A sub-cell is a cell here, since the paper divides a cell "into a set of cells with less edges".
    Each adds 1 and takes off the number of distinct ones that it joins and that were solved before
    it, so that the order does not matter: the sum is the number of sub-cells less the number of
    joined pairs. That is the number of segments only where no joined sub-cells close a circle.
    """
    subcells = [subcell for cell in division for subcell in cell.subcells]
    holder = {dart: number for number, own in enumerate(subcells) for dart in own.darts}
    pairs = {frozenset((one, holder[twin(dart)])) for dart, one in holder.items()}
    return len(subcells) - sum(len(pair) == 2 for pair in pairs)
