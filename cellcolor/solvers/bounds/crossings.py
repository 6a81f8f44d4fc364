"""How many corridors may have to cross an edge: if one is enough, ``paper`` equals ``surface``."""

from __future__ import annotations

import math
from collections.abc import Sequence

from cellcolor.data.instance import Instance


def enough_crossings(
    instance: Instance,
    colors: Sequence[frozenset[int]],
) -> dict[int, float]:
    """Strands of each live edge that are enough for a minimum over all divisions.

    Among all divisions of the surface with the fewest segments, take one with the fewest
    sub-cells, and a spanning tree of each segment. Then (docs/bounds.md, "Crossing an edge twice")

    - successive strands of an edge that the trees cross have different colors, so an edge with a
      single joinable color is crossed once;
    - the sub-cells on either side of an edge that is crossed m > 1 times are m different ones,
      each crossing some other edge of its cell too. So m is at most the sum of the crossings of
      the other edges of the cell, on either side.

    The second point is repeated until nothing changes. Cells with several live loops bound
    nothing, and neither do edges that have one cell on both sides.

    Args:
        instance: the topological graph.
        colors: the colors each cell may be painted in, all or some of its own.

    Returns:
        A number for every live edge; infinity where nothing is known.
    """
    enough = {
        edge.id: math.inf
        if len(colors[edge.left] & colors[edge.right] & set(instance.joinable(edge.id))) > 1
        else 1
        for edge in instance.edges
        if instance.joinable(edge.id)
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
