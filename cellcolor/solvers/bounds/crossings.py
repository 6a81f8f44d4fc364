"""How often segments have to cross an edge in some division with the fewest segments."""

from __future__ import annotations

import math

from cellcolor.data.instance import Instance


def enough_crossings(instance: Instance) -> dict[int, float]:
    """How many strands of each live edge suffice for a minimum over all divisions, or infinity.

    An edge with a single joinable color is crossed at most once. If it is crossed m > 1 times, then
    on either side m different sub-cells cross some other edge of their cell, too: m is at most the
    sum of the crossings of the cell's other edges (docs/bounds.md). This
    is applied until nothing changes. It says nothing about a side whose cell has several live
    loops, nor about edges with the same cell on both sides.
    """
    enough = {
        edge: math.inf if len(instance.joinable(edge)) > 1 else 1 for edge in instance.live_edges
    }
    borders = [
        [abs(dart) for dart in loops[0]] if len(loops) == 1 else [] for loops in instance.live_loops
    ]
    changed = True
    while changed:
        changed = False
        for edge in instance.edges:
            known = enough.get(edge.id, 1)
            if known == 1 or edge.left == edge.right:
                continue
            for border in (borders[edge.left], borders[edge.right]):
                others = sum(enough[other] for other in border if other != edge.id)
                if border and max(1, others) < enough[edge.id]:
                    enough[edge.id] = max(1, others)
                    changed = True
    return enough
