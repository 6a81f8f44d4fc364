"""Pairs of segments that would have to cross: lower bounds for any division of the surface."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from functools import cache
from itertools import combinations, product

from networkx.utils import UnionFind

from cellcolor.data.instance import Instance
from cellcolor.solvers.bounds import Region
from cellcolor.solvers.merging import MergedCells, merge_cells

__all__ = ["Conflict", "conflicts"]

MOST_STATES = 2000
"""States looked at from each starting area; with more of them it is left open what conflicts."""

BORDER = -1
"""Stands for an edge where areas have their number."""

Cuts = frozenset[tuple[int, int]]
"""Chords of ways through areas of both colors: the area, and the edges of the other color on one
side of the chord as a bit mask. Chords with all of them on one side are left out."""

Pair = tuple[frozenset[int], frozenset[int]]
"""Two areas that one segment is to touch, as the cells that they consist of."""


@dataclass(frozen=True, slots=True)
class Conflict:
    """What two segments cannot do side by side.

    A segment in the first region that touches both areas ``one``, and a segment in the second
    that touches both areas ``other``, would cross each other, however often cutting paths cross
    the edges.

    Attributes:
        one: two areas that belong to the first region and not to the second.
        other: two areas that belong to the second region and not to the first.
    """

    one: Pair
    other: Pair


def conflicts(instance: Instance, first: Region, second: Region) -> list[Conflict]:
    """What segments in two color regions cannot do side by side (docs/solver.md, "Conflicts").

    For each two areas of the first region all ways between them are tried that differ in how they
    cut the areas that both colors reach; two areas of the second region that each of these ways
    separates are in conflict with them. All conflicts that are returned are true ones, but not
    all there are: none where the ways are too many or where there are handles.

    Args:
        instance: the topological graph.
        first: a color region.
        second: another one.
    """
    areas = _Areas(instance, first, second)
    if len(areas.of_first) < 2 or len(areas.of_second) < 2 or areas.has_handles:
        return []
    return [
        Conflict((areas.cells(start), areas.cells(end)), (areas.cells(near), areas.cells(far)))
        for start in areas.of_first
        for end, separated in areas.separated(start).items()
        for near, far in sorted(separated)
    ]


class _Areas:
    """The surface as two colors see it: areas with one of them, the other or both.

    Apart from cracks, edges are left between areas of one color and areas of both only, and are
    joinable in one color. A way may be changed to cross such an edge once at most, and to enter
    areas of its own color once at most: it goes along the edge, or through the area, where no
    segment of the other color can be.
    """

    def __init__(self, instance: Instance, first: Region, second: Region) -> None:
        (color, near), (other, far) = first, second
        colors = [
            frozenset([color] * (cell.id in near) + [other] * (cell.id in far))
            for cell in instance.cells
        ]
        self._merged: MergedCells = merge_cells(instance, colors)
        self.of_first = sorted({self._merged.part_of[cell] for cell in near - far})
        self.of_second = sorted({self._merged.part_of[cell] for cell in far - near})
        self.has_handles = any(len(shared) > 1 for shared in self._merged.joinable.values())
        self._ways: dict[int, list[int]] = {}
        self._others: dict[int, list[int]] = {}
        for area, loops in self._merged.loops.items():
            darts = [dart for loop in loops for dart in loop]
            is_way = [color in self._merged.joinable[abs(dart)] for dart in darts]
            self._ways[area] = [dart for dart, own in zip(darts, is_way, strict=True) if own]
            self._others[area] = [dart for dart, own in zip(darts, is_way, strict=True) if not own]
        self.apart = cache(self._apart)

    def cells(self, area: int) -> frozenset[int]:
        """The cells that an area consists of."""
        return frozenset(cell for cell, part in enumerate(self._merged.part_of) if part == area)

    def separated(self, start: int) -> dict[int, frozenset[tuple[int, int]]]:
        """What every way from an area of the first region to each later one separates.

        A state of a way is where it is, by which dart it came in, and what it has cut so far;
        ways that cut less come first. A way goes on only where it may still show that something
        is not always separated.
        """
        ends = {area for area in self.of_first if area > start}
        found: dict[int, frozenset[tuple[int, int]]] = {}
        states: set[tuple[int, int, Cuts]] = {(start, 0, frozenset())}
        heap: list[tuple[int, int, tuple[int, int, Cuts]]] = [(0, 0, (start, 0, frozenset()))]
        while heap:
            _, _, (area, entered, cuts) = heapq.heappop(heap)
            onward = (
                (dart, cuts | chord)
                for dart in self._ways[area]
                if dart != entered  # an edge is crossed once
                for chord in self._chords(area, entered, dart)
            )
            for dart, further in onward:
                separated = self.apart(further)
                following = self._beyond(dart)
                if following in ends:
                    found[following] = found.get(following, separated) & separated
                if len(found) == len(ends) and all(rest <= separated for rest in found.values()):
                    continue
                own = following in self.of_first
                state = following, 0 if own else -dart, further
                if state not in states and len(self._ways[following]) > 1:
                    states.add(state)
                    heapq.heappush(heap, (len(further), len(states), state))
            if len(states) > MOST_STATES:
                return {}
        return found

    def _beyond(self, dart: int) -> int:
        left, right = self._merged.sides[abs(dart)]
        return right if dart > 0 else left

    def _chords(self, area: int, entered: int, left: int) -> list[Cuts]:
        """What a way through an area from one dart to another may cut off.

        A way from one loop to another cuts off nothing. One from a loop to itself leaves the other
        loops on either side: that is to choose for each.
        """
        others = self._others[area]
        loops = self._merged.loops[area]
        own = next((loop for loop in loops if entered in loop and left in loop), None)
        if own is None or not others:
            return [frozenset()]
        low, high = sorted((own.index(entered), own.index(left)))
        islands = [loop for loop in loops if loop is not own]
        found = []
        for chosen in product((False, True), repeat=len(islands)):
            inside = set(own[low + 1 : high])
            inside.update(*(loop for loop, within in zip(islands, chosen, strict=True) if within))
            mask = sum(1 << place for place, dart in enumerate(others) if dart in inside)
            mask = min(mask, (1 << len(others)) - 1 - mask)
            found.append(frozenset([(area, mask)] if mask else []))
        return found

    def _apart(self, cuts: Cuts) -> frozenset[tuple[int, int]]:
        """The pairs of areas of the second region that cuts separate."""
        together: UnionFind[tuple[int, ...]] = UnionFind((area,) for area in self.of_second)
        for area, darts in self._others.items():
            masks = sorted(mask for its, mask in cuts if its == area)
            for place, dart in enumerate(darts):
                side = (mask >> place & 1 for mask in masks)
                together.union((area, *side), (BORDER, abs(dart)))
        return frozenset(
            (near, far)
            for near, far in combinations(self.of_second, 2)
            if together[(near,)] != together[(far,)]
        )
