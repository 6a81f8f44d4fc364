"""A lower bound by counting what fits side by side in cells with many edges (docs/bounds.md).

Take some hubs away. What is left needs so many color regions at least, and each hub can save no
more segments than it has links: connections between its edges in one color that do not cross.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Index
from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline
from cellcolor.solvers.bounds.cover import greedy_strangers

__all__ = ["HubBound", "hub_bound", "most_links"]

FEWEST_DARTS = 4
"""Live darts of a hub; around a cell with fewer no two connections can cross."""

MOST_HUBS = 200
"""Cells that are tried, those with the most live darts first."""


@dataclass(frozen=True, slots=True)
class HubBound:
    """No division of the surface has fewer segments.

    Attributes:
        value: so many, ``len(cells)`` less the links of the hubs.
        hubs: the cells that were taken away, no two of which share a live edge.
        cells: of which no two lie in one color region of what is left.
    """

    value: int
    hubs: tuple[int, ...] = ()
    cells: tuple[int, ...] = ()


def hub_bound(instance: Instance, deadline: Deadline = NEVER) -> HubBound:
    """The best bound that hubs give which are chosen one after the other.

    Args:
        instance: the topological graph.
        deadline: when to be content with the hubs found so far.
    """
    found = HubBound(0, cells=tuple(greedy_strangers(instance)))
    links, fewest = 0, len(found.cells)
    live = {cell: loops[0] for cell, loops in enumerate(instance.live_loops) if len(loops) == 1}
    hardest = sorted(live, key=lambda cell: -len(live[cell]))[:MOST_HUBS]
    for cell in hardest:
        darts = live[cell]
        if deadline.over or len(darts) < FEWEST_DARTS:
            break
        if not _is_hub(instance, cell, found.hubs):
            continue
        saved = links + most_links([frozenset(instance.joinable(dart)) for dart in darts])
        hubs = (*found.hubs, cell)
        cells = greedy_strangers(instance, hubs)
        # One hub of several that share their petals may be of use only together with the others.
        if len(cells) - saved >= fewest:
            links, fewest = saved, len(cells) - saved
            found = HubBound(fewest, hubs, tuple(sorted(cells)))
    return found


def _is_hub(instance: Instance, cell: int, hubs: Collection[int]) -> bool:
    """Whether every live edge of a cell is crossed once at most, and leads to none of the hubs."""
    for dart in instance.live_loops[cell][0]:
        beyond = instance.across(dart)
        if beyond == cell or beyond in hubs:
            return False
        petal = sum(map(len, instance.live_loops[beyond])) == 1
        if not petal and len(instance.joinable(dart)) > 1:
            return False
    return True


def most_links(colors: Sequence[frozenset[int]]) -> int:
    """Most links between the darts of a list, in groups of one color that do not cross each other.

    ``best[i, j]`` is that of the darts from i to j, j left out. Dart i is in no group with a later
    one, or it is linked in some color to a next dart k, with everything between them by itself.

    Args:
        colors: those that each dart can be joined in, in cyclic order.
    """
    count = len(colors)
    best = np.zeros((count + 1, count + 1), dtype=np.int64)
    linked: dict[tuple[int, int], Index] = {}
    for one in reversed(range(count)):
        best[one] = best[one + 1]
        for color in colors[one]:
            found = best[one + 1].copy()
            for other in range(one + 1, count):
                if color in colors[other]:
                    with_other = best[one + 1, other] + 1 + linked[other, color][other + 1 :]
                    np.maximum(found[other + 1 :], with_other, out=found[other + 1 :])
            linked[one, color] = found
            np.maximum(best[one], found, out=best[one])
    return int(best[0, count])
