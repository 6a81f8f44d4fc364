"""A lower bound by counting what fits side by side in cells with many edges (docs/bounds.md).

Remove some hubs. The rest needs at least a number of color regions, and each hub saves at most as
many segments as it has links: connections between its edges in one color that do not cross.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from cellcolor.data.instance import Instance
from cellcolor.deadline import NEVER, Deadline, OutOfTime
from cellcolor.solvers.bounds.cover import greedy_strangers
from cellcolor.solvers.bounds.links import links_bound

FEWEST_DARTS = 4
"""Live darts of a hub; around a cell with fewer no two connections can cross."""

MOST_HUBS = 200
"""Cells that are tried, those with the most live darts first."""


@dataclass(frozen=True, slots=True)
class HubBound:
    """No division of the surface has fewer segments.

    Attributes:
        value: so many, ``len(cells)`` less the links of the hubs.
        hubs: the removed cells; no two of them share a live edge.
        cells: no two of them lie in one color region of the rest.
    """

    value: int
    hubs: tuple[int, ...] = ()
    cells: tuple[int, ...] = ()


def hub_bound(instance: Instance, deadline: Deadline = NEVER) -> HubBound:
    """The best bound from hubs chosen one after the other.

    Args:
        instance: the topological graph.
        deadline: when to stop with the hubs found so far.
    """
    found = HubBound(0, cells=tuple(greedy_strangers(instance)))
    links, fewest = 0, len(found.cells)
    darts = [sum(map(len, loops)) for loops in instance.live_loops]
    hardest = sorted(range(len(darts)), key=lambda cell: -darts[cell])[:MOST_HUBS]
    for cell in hardest:
        if deadline.over or darts[cell] < FEWEST_DARTS:
            break
        if not _is_hub(instance, cell, found.hubs):
            continue
        try:
            most = links_bound(joinable_colors(instance, cell), deadline)
        except OutOfTime:
            break
        if most is None:
            continue
        saved = links + most
        hubs = (*found.hubs, cell)
        cells = greedy_strangers(instance, hubs)
        # One hub of several that share their petals may be of use only together with the others.
        if len(cells) - saved >= fewest:
            links, fewest = saved, len(cells) - saved
            found = HubBound(fewest, hubs, tuple(sorted(cells)))
    return found


def joinable_colors(instance: Instance, cell: int) -> list[list[frozenset[int]]]:
    """The colors in which each live dart of a cell can be joined, loop by loop."""
    return [
        [frozenset(instance.joinable(dart)) for dart in loop] for loop in instance.live_loops[cell]
    ]


def _is_hub(instance: Instance, cell: int, hubs: Collection[int]) -> bool:
    """Whether every live edge of a cell is crossed once at most, and leads to none of the hubs."""
    for dart in (dart for loop in instance.live_loops[cell] for dart in loop):
        beyond = instance.across(dart)
        if beyond == cell or beyond in hubs:
            return False
        petal = sum(map(len, instance.live_loops[beyond])) == 1
        if not petal and len(instance.joinable(dart)) > 1:
            return False
    return True
