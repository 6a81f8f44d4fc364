"""What models of cells with one live loop are made of, and the divisions that they describe."""

from __future__ import annotations

from collections.abc import Mapping

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, number_segments
from cellcolor.errors import InputError


def only_loops(instance: Instance) -> list[tuple[int, ...]]:
    """The live loop of each cell; empty where it has none.

    Raises:
        InputError: a cell has several loops with live darts, which these models cannot divide.
    """
    for cell, loops in enumerate(instance.live_loops):
        if len(loops) > 1:
            message = f"the model knows one live loop, here are {len(loops)}"
            raise InputError(None, f"cells[{cell}].loops", message)
    return [loops[0] if loops else () for loops in instance.live_loops]


def division_of_chains(
    instance: Instance, color: Mapping[int, int], after: Mapping[int, int]
) -> Division:
    """A division whose sub-cells are chains of linked darts.

    In a model the sub-cells of a segment form a tree: it does not join an edge that would close a
    cycle of them. In a division such an edge has to be joined, because it has the same color on
    both sides (docs/semantics.md, section 3, rule 5). So every dart that the model left unjoined is
    given to the sub-cell before it in cyclic order, and its edge is joined if the dart on the other
    side then has the same, joinable color. That makes no new segment.

    Nothing is verified here: whether this is a legal division is for the checker to say.

    Args:
        color: of each edge that the model joins.
        after: a dart in state 1 -> the next one of its sub-cell, which stands later in the loop.
    """
    # A sub-cell is named here by its first dart and its color. The first dart is 0 for the one
    # sub-cell of a cell without joined darts.
    start = {dart: dart for dart in after}  # the first dart of the chain that a dart is in
    shown: dict[int, tuple[int, int]] = {}  # the sub-cell that each live dart is given to
    for cell in instance.cells:
        live = [dart for loop in instance.live_loops[cell.id] for dart in loop]
        for dart in live:
            if dart in after:
                start[after[dart]] = start[dart]
        own = (0, cell.colors[0])
        joined = [dart for dart in live if abs(dart) in color]
        if joined:
            own = start.get(joined[-1], joined[-1]), color[abs(joined[-1])]
        for dart in live:
            if abs(dart) in color:
                own = start.get(dart, dart), color[abs(dart)]
            shown[dart] = own
    blocks: list[list[tuple[int, list[int]]]] = []
    for cell in instance.cells:
        found: dict[tuple[int, int], list[int]] = {}
        for dart in (dart for loop in cell.loops for dart in loop if dart in shown):
            own, other = shown[dart], shown[-dart]
            if own[1] == other[1] and own[1] in instance.joinable(dart):
                found.setdefault(own, []).append(dart)
        blocks.append([(own[1], darts) for own, darts in found.items()] or [(cell.colors[0], [])])
    return number_segments(blocks)
