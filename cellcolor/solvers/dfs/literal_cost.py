"""The paper's cost rule taken at its word (section V-A), for study."""

from __future__ import annotations

from cellcolor.data.cells_and_edges import DartName, twin
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division
from cellcolor.errors import InputError


def literal_cost(instance: Instance, division: Division) -> int:
    """What ``Δcost = 1 - j`` adds up to when j counts distinct solved *cells*.

    Every sub-cell adds 1 and takes off the number of distinct sub-cells it joins that were painted
    before it, so that the order does not matter: the sum is the number of sub-cells less the
    number of distinct joined pairs. It is the number of segments only where no cycle of joined
    sub-cells closes: around a corner of three cells painted alike it is one too small.

    Args:
        instance: the instance that is divided.
        division: every cell's sub-cells; their segment numbers are not looked at.

    Raises:
        InputError: the division is not one of this instance's cells.
    """
    if [cell.id for cell in division] != [cell.id for cell in instance.cells]:
        raise InputError(None, "cells", f"not the {len(instance.cells)} cells of {instance.name!r}")
    holder: dict[DartName, tuple[int, int]] = {
        dart: (cell.id, number)
        for cell in division
        for number, subcell in enumerate(cell.subcells)
        for dart in subcell.darts
    }
    pairs = {
        frozenset((one, holder[twin(dart)])) for dart, one in holder.items() if twin(dart) in holder
    }
    joined = sum(len(pair) == 2 for pair in pairs)
    return sum(len(cell.subcells) for cell in division) - joined
