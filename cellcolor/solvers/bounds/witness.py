"""Why there cannot be fewer segments, where a person can see it: cells that cannot share one."""

from __future__ import annotations

from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import greedy_strangers, strangers

__all__ = ["MOST_CELLS", "witness"]

MOST_CELLS = 12
"""More of them convince nobody."""


def witness(instance: Instance, solution: Solution, deadline: Deadline = NEVER) -> tuple[int, ...]:
    """As many cells as there are segments, no two of which can be in one segment.

    Args:
        instance: the topological graph.
        solution: a valid solution of it.
        deadline: when to be content with what is found at once.

    Returns:
        The cells, ascending; none where the number is not proved for any division, where one
        segment is enough, or where no such cells were found.
    """
    wanted = solution.segments or 0
    if not solution.proved_for_surface or not 1 < wanted <= MOST_CELLS:
        return ()
    cells = greedy_strangers(instance)
    if len(cells) < wanted and not deadline.over:
        cells = strangers(instance, deadline)
    return tuple(sorted(cells)) if len(cells) == wanted else ()
