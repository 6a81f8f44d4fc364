"""Certificates with which a checker verifies bounds by conflicts or hubs without a solver."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, product

from cellcolor.data.bound_kinds import (
    CertifiedCrossing,
    CertifiedPart,
    CertifiedParts,
    CertifiedSegment,
    CertifiedTangle,
)
from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.bounds.reductions import LeftOut
from cellcolor.solvers.cpsat.part_search import PartSearch

MOST_CONFLICTS = 2_000
"""With more of them a certificate would be large, and searching it slow."""


def conflict_certificate(
    left_out: Iterable[LeftOut], parts: Sequence[PartSearch]
) -> CertifiedParts | None:
    """The certificate of a bound by conflicts or hubs; None if too large.

    Args:
        left_out: the color regions that were left out before the instance fell into parts.
        parts: searched; their bounds add up.
    """
    found = tuple(_part(part) for part in parts)
    if sum(len(part.conflicts) + len(part.tangles) for part in found) > MOST_CONFLICTS:
        return None
    steps = tuple((region.color, min(region.cells), region.stand_in) for region in left_out)
    return CertifiedParts(left_out=steps, parts=found)


def _part(part: PartSearch) -> CertifiedPart:
    whole = part.cells

    def cells(merged_cell: Iterable[int]) -> tuple[int, ...]:
        return tuple(sorted(whole[cell] for cell in merged_cell))

    if part.hubs is not None:
        hubs, hard = (cells(found) for found in (part.hubs.hubs, part.hubs.cells))
        return CertifiedPart(part.surface_bound, hard, hubs=hubs)
    # A part that a smallest cover proves needs nothing of what was planned.
    planner = part.planning.planner if part.surface_bound > part.cover_bound else None
    if planner is None:
        return CertifiedPart(part.surface_bound, _hardest(part, (), ()))
    conflicts = [
        CertifiedCrossing(
            (one[0], other[0]),
            (cells(parting.ends[0]), cells(parting.ends[1])),
            (cells(near), cells(far)),
        )
        for one, other, parting in planner.partings
        for group, further in combinations(parting.groups, 2)
        for near, far in product(group, further)
    ]
    tangles = [
        CertifiedTangle(
            tuple(
                CertifiedSegment(
                    color,
                    tuple(tuple(cells(area) for area in group) for group in groups),
                    cells(avoided),
                )
                for (color, _), groups, avoided in tangle
            )
        )
        for tangle in planner.tangles
    ]
    hard = _hardest(part, conflicts, tangles)
    return CertifiedPart(part.surface_bound, hard, tuple(conflicts), tuple(tangles))


def _hardest(
    part: PartSearch,
    conflicts: Sequence[CertifiedCrossing],
    tangles: Sequence[CertifiedTangle],
) -> tuple[int, ...]:
    """One cell of each kind, without those that are touched wherever another one is.

    Two cells are of one kind if they lie in the same color regions, the same ends of conflicts and
    the same places of tangles. A cell of none of these can be touched by whatever touches a cell
    that has no other regions.
    """
    regions: dict[int, set[int]] = {cell: set() for cell in part.cells}
    for number, (_, own) in enumerate(color_regions(part.instance)):
        for cell in own:
            regions[part.cells[cell]].add(number)
    ends: dict[int, set[tuple[object, ...]]] = {cell: set() for cell in part.cells}
    for number, conflict in enumerate(conflicts):
        for end, area in enumerate((*conflict.one, *conflict.other)):
            for cell in area:
                ends[cell].add(("conflict", number, end))
    for number, tangle in enumerate(tangles):
        for place, segment in enumerate(tangle.segments):
            for group, areas in enumerate([*segment.groups, (segment.avoided,)]):
                for cell in (cell for area in areas for cell in area):
                    ends[cell].add(("tangle", number, place, group))
    first: dict[tuple[frozenset[int], frozenset[tuple[object, ...]]], int] = {}
    for cell in sorted(part.cells):
        first.setdefault((frozenset(regions[cell]), frozenset(ends[cell])), cell)
    kinds = list(first)
    hard = (
        cell
        for (own, at), cell in first.items()
        if at or not any(other < own for other, _ in kinds)
    )
    return tuple(sorted(hard))
