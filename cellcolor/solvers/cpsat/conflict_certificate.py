"""What lets a checker without a solver verify a bound by conflicts between segments or by hubs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, product
from typing import Any

from cellcolor.solvers.bounds.cover import color_regions
from cellcolor.solvers.bounds.domination import LeftOut
from cellcolor.solvers.cpsat.search import PartSearch

__all__ = ["MOST_CONFLICTS", "conflict_certificate"]

MOST_CONFLICTS = 2_000
"""With more of them a certificate would be large, and searching it slow."""


def conflict_certificate(
    left_out: Iterable[LeftOut], parts: Sequence[PartSearch]
) -> dict[str, Any] | None:
    """The certificate of a bound by conflicts or hubs (docs/formats.md); None if too large.

    Args:
        left_out: the color regions that were left out before the instance fell into parts.
        parts: searched; their bounds add up.
    """
    found = [_part(part) for part in parts]
    number = sum(len(part["conflicts"]) + len(part.get("tangles", ())) for part in found)
    if number > MOST_CONFLICTS:
        return None
    steps = [[region.color, min(region.cells), region.stand_in] for region in left_out]
    return {"left_out": steps, "parts": found}


def _part(part: PartSearch) -> dict[str, Any]:
    whole = part.cells

    def cells(merged_cell: Iterable[int]) -> tuple[int, ...]:
        return tuple(sorted(whole[cell] for cell in merged_cell))

    if part.hubs is not None:
        hubs, hard = (cells(found) for found in (part.hubs.hubs, part.hubs.cells))
        return {"value": part.surface_bound, "cells": hard, "conflicts": [], "hubs": hubs}
    conflicts = []
    # A part that a smallest cover proves needs nothing of what was planned.
    planner = part.planning.planner if part.surface_bound > part.cover_bound else None
    for one, other, parting in planner.partings if planner is not None else ():
        for group, further in combinations(parting.groups, 2):
            for pair in product(group, further):
                ends, parted = ([cells(m) for m in two] for two in (parting.ends, pair))
                conflicts.append({"colors": [one[0], other[0]], "one": ends, "other": parted})
    tangles = [
        {
            "segments": [
                {
                    "color": color,
                    "groups": [[cells(area) for area in group] for group in groups],
                    "avoided": cells(avoided),
                }
                for (color, _), groups, avoided in tangle
            ]
        }
        for tangle in (planner.tangles if planner is not None else ())
    ]
    found = {
        "value": part.surface_bound,
        "cells": _hardest(part, conflicts, tangles),
        "conflicts": conflicts,
    }
    return found | {"tangles": tangles} if tangles else found


def _hardest(
    part: PartSearch, conflicts: Sequence[dict[str, Any]], tangles: Sequence[dict[str, Any]]
) -> list[int]:
    """One cell of each kind, without those that are touched wherever another one is.

    Two cells are of one kind if they lie in the same color regions, the same ends of conflicts and
    the same places of tangles. A cell of none of these can be touched by whatever touches a cell
    that has no other regions.
    """
    regions: dict[int, set[int]] = {cell: set() for cell in part.cells}
    for number, (_, own) in enumerate(color_regions(part.instance)):
        for cell in own:
            regions[part.cells[cell]].add(number)
    ends: dict[int, set[tuple[int, str, int]]] = {cell: set() for cell in part.cells}
    for number, conflict in enumerate(conflicts):
        for side, end in product(("one", "other"), (0, 1)):
            for cell in conflict[side][end]:
                ends[cell].add((number, side, end))
    for number, tangle in enumerate(tangles):
        for place, segment in enumerate(tangle["segments"]):
            groups = [*segment["groups"], [segment["avoided"]]]
            for group, areas in enumerate(groups):
                for cell in (cell for area in areas for cell in area):
                    ends[cell].add((number, f"segment {place} of a tangle", group))
    first: dict[tuple[frozenset[int], frozenset[tuple[int, str, int]]], int] = {}
    for cell in sorted(part.cells):
        first.setdefault((frozenset(regions[cell]), frozenset(ends[cell])), cell)
    kinds = list(first)
    return sorted(
        cell
        for (own, at), cell in first.items()
        if at or not any(other < own for other, _ in kinds)
    )
