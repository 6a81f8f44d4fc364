"""Pairs of segments that would have to cross, read off what two color regions separate."""

from __future__ import annotations

from itertools import combinations, product
from typing import NamedTuple

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds.conflicts import MergedCell, RegionPair
from cellcolor.solvers.bounds.cover import Region


class Conflict(NamedTuple):
    """A segment in the first region that touches both merged cells ``one``, and one in the second
    that touches both merged cells ``other``, would cross."""

    one: tuple[MergedCell, MergedCell]
    other: tuple[MergedCell, MergedCell]


def conflicts(instance: Instance, first: Region, second: Region) -> list[Conflict]:
    """All known conflicts between segments in two color regions."""
    found: dict[frozenset[frozenset[MergedCell]], Conflict] = {}
    if first[0] == second[0]:
        return []
    pair = RegionPair(instance, first, second)
    for side in (pair.first, pair.second):
        for near, far in combinations(side.merged_cells, 2):
            for separation in side.separations(near, far):
                for group, further in combinations(separation.groups, 2):
                    for merged_cells in product(group, further):
                        sides = (separation.ends, merged_cells)
                        conflict = Conflict(*(sides if side is pair.first else sides[::-1]))
                        found[frozenset(map(frozenset, sides))] = conflict
    return list(found.values())
