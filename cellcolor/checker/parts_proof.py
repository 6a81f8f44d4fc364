"""Verifies certificates that name cells, conflicts, tangles and hubs (docs/bounds.md).

The certificate of a ``cover`` or of ``strangers`` names some cells, and the claim is that fewer
color regions than the bound says do not touch all of them. That of ``conflicts`` or ``hubs`` names,
for each part of the surface, such cells as well, pairs of segments that would have to cross, and
tangles of more of them, or hubs. The color regions that another color can stand in for are left out
before. What crosses is verified by :mod:`cellcolor.checker.crossing_segments`, what is tangled by
:mod:`cellcolor.checker.tangles`, and then every way to touch the cells is tried by
:mod:`cellcolor.checker.plan_search`, to the end or until the budget is used up.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellcolor.checker.color_regions import ColorRegion
from cellcolor.checker.crossing_segments import TwoRegions
from cellcolor.checker.filled_surface import WORK
from cellcolor.checker.hubs import Hubs
from cellcolor.checker.plan_search import (
    BudgetExceeded,
    Conflict,
    PlanSearch,
    Tangle,
    TangledSegment,
)
from cellcolor.checker.proof import Proof, Refused, few
from cellcolor.checker.tangles import Tangled, cannot_be_drawn, is_connected
from cellcolor.data.bound_kinds import (
    CertifiedCells,
    CertifiedPart,
    CertifiedParts,
    CertifiedTangle,
)


def verify_cells(proof: Proof, certificate: CertifiedCells, value: int) -> None:
    """Verify that fewer color regions do not touch all of the cells."""
    _verify(proof, (CertifiedPart(value, certificate.cells),), value)


def verify_parts(proof: Proof, certificate: CertifiedParts, value: int) -> None:
    """Verify that the parts together need that many segments."""
    _leave_out(proof, certificate.left_out)
    _verify(proof, certificate.parts, value)


def _leave_out(proof: Proof, steps: Sequence[tuple[int, int, int]]) -> None:
    """Leave out color regions that another color can stand in for, one after the other."""
    for color, cell, stand_in in steps:
        region = proof.region(color, cell)
        cells = proof.cells_of(region)
        inside = frozenset(cells)
        for own in cells:
            if not any(other[0] == stand_in for other in proof.regions[own]):
                raise Refused(f"color {stand_in} cannot stand in for color {color} in {own}")
            for dart in (dart for loop in proof.instance.cells[own].loops for dart in loop):
                joinable = proof.instance.joinable(abs(dart))
                edge = proof.instance.edge(abs(dart))
                within = edge.left in inside and edge.right in inside
                if within and color in joinable and stand_in not in joinable:
                    text = f"color {stand_in} does not continue across edge {abs(dart)}"
                    raise Refused(f"{text}, where color {color} does")
        if stand_in == color:
            raise Refused(f"color {color} cannot stand in for itself")
        for own in cells:
            proof.regions[own] -= {region}


def _verify(proof: Proof, parts: Sequence[CertifiedPart], value: int) -> None:
    if sum(part.value for part in parts) < value:
        raise Refused(f"the parts need fewer than {value} segments")
    used: set[ColorRegion] = set()
    for part in parts:
        demands = {cell: proof.regions_of(cell) for cell in part.cells}
        hubs = {cell: proof.regions_of(cell) for cell in part.hubs}
        own = frozenset[ColorRegion]().union(*demands.values(), *hubs.values())
        if not used.isdisjoint(own):
            raise Refused("one color region lies in two parts")
        used |= own
        conflicts = list(_conflicts(proof, part))
        tangles = [_tangle(proof, tangle) for tangle in part.tangles]
        pieces = part.value
        if part.hubs:
            demands, saved = _beside_hubs(proof, part)
            pieces += saved
        left = proof.budget - proof.tried
        search = PlanSearch(demands, conflicts, left, proof.deadline, tangles)
        try:
            possible = search.is_possible(pieces - 1)
        finally:
            proof.tried += search.tried
        if possible:
            what = "segments" if part.conflicts or part.tangles else "color regions"
            raise Refused(f"fewer than {pieces} {what} touch all of the cells {few(part.cells)}")


def _beside_hubs(
    proof: Proof, part: CertifiedPart
) -> tuple[dict[int, frozenset[ColorRegion]], int]:
    """The color regions that are left of each cell to be touched when hubs are taken away, and the
    most segments that the hubs save, by their links."""
    if part.conflicts or part.tangles:
        raise Refused("a part with hubs has conflicts or tangles as well")
    hubs = Hubs(proof.instance, proof.regions, part.hubs)
    regions = hubs.regions()
    for cell in part.cells:
        if not regions[cell]:
            raise Refused(f"hub {cell} is to be touched")
    for hub in part.hubs:
        if problem := hubs.problem(hub):
            raise Refused(problem)
    saved = sum(hubs.links(hub, proof.count) for hub in sorted(set(part.hubs)))
    return {cell: regions[cell] for cell in part.cells}, saved


def _conflicts(proof: Proof, part: CertifiedPart) -> Iterator[Conflict]:
    two_regions: dict[tuple[ColorRegion, ColorRegion], TwoRegions] = {}
    for crossing in part.conflicts:
        if proof.deadline.over:
            raise BudgetExceeded
        ends = [frozenset(cells) for cells in (*crossing.one, *crossing.other)]
        if not all(ends):
            raise Refused("a conflict names no cells")
        first = proof.region(crossing.colors[0], min(ends[0]))
        second = proof.region(crossing.colors[1], min(ends[2]))
        for cells in ends[:2]:
            _one_area(proof, cells, first, second)
        for cells in ends[2:]:
            _one_area(proof, cells, second, first)
        if (first, second) not in two_regions:
            cells_of = frozenset(proof.cells_of(first)), frozenset(proof.cells_of(second))
            two_regions[first, second] = TwoRegions(
                proof.instance, crossing.colors, cells_of, proof.count
            )
        two = two_regions[first, second]
        one, other, far, farther = (min(cells) for cells in ends)
        if not two.must_cross((one, other), (far, farther)):
            text = f"segments that connect cells {one} and {other}, and {far} and {farther}"
            raise Refused(f"{text}, need not cross")
        yield Conflict((first, second), (ends[0], ends[1], ends[2], ends[3]))


def _tangle(proof: Proof, tangle: CertifiedTangle) -> Tangle:
    """A tangle that is verified."""
    found: list[TangledSegment] = []
    drawn: list[Tangled] = []
    for segment in tangle.segments:
        named = [cell for group in segment.groups for area in group for cell in area]
        areas = [area for group in segment.groups for area in group]
        if not areas or not all(segment.groups) or not all(areas):
            raise Refused("a tangle names no cells")
        region = proof.region(segment.color, named[0])
        for cell in (*named, *segment.avoided):
            if region not in proof.regions_of(cell):
                text = f"cell {cell} is not in the color region of cell {named[0]}"
                raise Refused(f"{text}, as a tangle says")
        avoided = frozenset(segment.avoided)
        if not avoided.isdisjoint(named):
            raise Refused("a segment of a tangle avoids what it touches")
        cells = frozenset(proof.cells_of(region))
        proof.count(1 + (len(cells) + len(named)) // 100)
        groups = tuple(tuple(map(frozenset, group)) for group in segment.groups)
        for area in (area for group in groups for area in group):
            _connected(proof, area, segment.color)
        whole = tuple(frozenset[int]().union(*group) for group in groups)
        found.append(TangledSegment(region, whole, avoided))
        drawn.append(Tangled(segment.color, cells - avoided, groups))
    if not cannot_be_drawn(proof.instance, drawn, proof.count):
        named = [min(min(area) for area in s.groups[0]) for s in drawn]
        raise Refused(f"the segments of a tangle, of cells {few(named)}, could be drawn")
    return tuple(found)


def _one_area(proof: Proof, cells: frozenset[int], region: ColorRegion, other: ColorRegion) -> None:
    """Hold cells of one region to be connected in its color, and outside of the other region.

    What touches one of them can then be grown over all of them: the other segment is in none.
    """
    for cell in cells:
        if region not in proof.regions_of(cell):
            raise Refused(f"cell {cell} is not in the color region of cell {min(cells)}")
        if other in proof.regions_of(cell):
            raise Refused(f"cell {cell} is in the color regions of both segments")
    _connected(proof, cells, region[0])


def _connected(proof: Proof, cells: frozenset[int], color: int) -> None:
    """Hold an area to be connected in a color."""
    loops = [loop for cell in cells for loop in proof.instance.cells[cell].loops]
    proof.count((len(cells) + sum(map(len, loops))) // WORK)
    if not is_connected(proof.instance, color, cells):
        raise Refused(f"the cells {few(cells)} are not connected in color {color}")
