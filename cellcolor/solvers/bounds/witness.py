"""Why there cannot be fewer segments, where a person can see it: cells that cannot share one."""

from __future__ import annotations

from cellcolor.data.solution import Solution

__all__ = ["MOST_CELLS", "witness"]

MOST_CELLS = 12
"""More of them convince nobody."""


def witness(solution: Solution) -> tuple[int, ...]:
    """As many cells as there are segments, no two of which can be in one segment.

    Args:
        solution: a valid solution.

    Returns:
        The cells, ascending, from the certificate of the bound that proves the number; none where
        the number is not proved for any division, where one segment is enough, or where the
        certificate has other cells or there is none.
    """
    wanted = solution.segments or 0
    if not solution.proved_for_surface or not 1 < wanted <= MOST_CELLS:
        return ()
    for bound in solution.bounds or ():
        cells = (bound.certificate or {}).get("cells", ())
        # So many cells that as many color regions are needed: no region touches two of them.
        if bound.kind == "cover" and bound.value == wanted == len(cells):
            return tuple(cells)
    return ()
