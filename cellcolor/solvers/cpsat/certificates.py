"""Certificates with which a checker verifies bounds by separating pairs without a solver."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, product

from cellcolor.data.bounds import CertifiedCrossing, CertifiedPart, CertifiedParts
from cellcolor.solvers.cpsat.part import Part

MOST_CONFLICTS = 2_000
"""With more of them a certificate would be large, and searching it slow."""


def conflict_certificate(parts: Sequence[Part]) -> CertifiedParts | None:
    """The certificate of a bound by separating pairs; None if too large.

    Args:
        parts: searched; their bounds add up.
    """
    found = tuple(_part(part) for part in parts)
    if sum(len(part.conflicts) for part in found) > MOST_CONFLICTS:
        return None
    return CertifiedParts(parts=found)


def _part(part: Part) -> CertifiedPart:
    def cells(merged_cell: Iterable[int]) -> tuple[int, ...]:
        return tuple(sorted(part.cells[cell] for cell in merged_cell))

    # A part that a smallest cover proves needs nothing of what was planned.
    planner = part.planner if part.surface_bound > part.cover_bound else None
    conflicts = [
        CertifiedCrossing(
            (one[0], other[0]),
            (cells(separation.ends[0]), cells(separation.ends[1])),
            (cells(near), cells(far)),
        )
        for one, other, separation in ([] if planner is None else planner.separations)
        for group, further in combinations(separation.groups, 2)
        for near, far in product(group, further)
    ]
    return CertifiedPart(part.surface_bound, _hardest(part, conflicts), tuple(conflicts))


def _hardest(part: Part, conflicts: Sequence[CertifiedCrossing]) -> tuple[int, ...]:
    """One cell of each kind, without those that are touched wherever another one is.

    Two cells are of one kind if they lie in the same color regions and the same ends of conflicts.
    A cell of none of these can be touched by whatever touches a cell that has no other regions.
    """
    regions: dict[int, set[int]] = {cell: set() for cell in part.cells}
    for number, (_, own) in enumerate(part.regions):
        for cell in own:
            regions[part.cells[cell]].add(number)
    ends: dict[int, set[tuple[int, int]]] = {cell: set() for cell in part.cells}
    for number, conflict in enumerate(conflicts):
        for end, area in enumerate((*conflict.one, *conflict.other)):
            for cell in area:
                ends[cell].add((number, end))
    first: dict[tuple[frozenset[int], frozenset[tuple[int, int]]], int] = {}
    for cell in sorted(part.cells):
        first.setdefault((frozenset(regions[cell]), frozenset(ends[cell])), cell)
    kinds = list(first)
    hard = (
        cell
        for (own, at), cell in first.items()
        if at or not any(other < own for other, _ in kinds)
    )
    return tuple(sorted(hard))
