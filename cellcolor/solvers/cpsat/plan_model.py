"""The CP-SAT model of a segment plan (docs/bounds.md, "Segment plans").

Terms, with the places that define them:

- A **merged cell** consists of cells that nothing separates in any color (``merged_surface``).
- A **separation** of two color regions (``conflicts``): if a segment of the one region touches both
  ``ends``, no segment of the other region touches merged cells of two of the ``groups``.
- Merged cells of a region are of one **kind** if the same separations name them in the same places.
  A segment that touches one of a kind may then touch all of them, so the model has one literal for
  each kind, not for each merged cell.
- A region gets several **copies**, of which the plan uses as many as it has segments there. If it
  may have more segments than copies, nothing is asked of a plan that has: such a region touches all
  its merged cells, and no separation counts there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, product

from ortools.sat.python import cp_model

SeparatedCells = Mapping[
    tuple[int, int], Sequence[tuple[Sequence[frozenset[int]], Sequence[frozenset[int]]]]
]
"""For the numbers of two color regions their separations: two sets of merged cells of the first,
one for each end, and groups of merged cells of the second."""

SegmentName = tuple[int, int]
"""The number of a color region, and that of one of its copies."""


class PlanCells:
    """The merged cells that a plan is about, and their kinds.

    Args:
        of_region: the merged cells of each color region.
        separated: the separations that a plan has to respect.

    Attributes:
        regions_of: the color regions of each merged cell.
        kinds: for each color region, the merged cells that separations name; each is mapped
            to the first one of its kind, which stands for the kind. Merged cells that nothing names
            have no kind: any segment of the region may touch them, so nothing has to be decided.
    """

    def __init__(
        self,
        of_region: Sequence[frozenset[int]],
        separated: SeparatedCells,
    ) -> None:
        self.of_region = of_region
        self.regions_of: dict[int, list[int]] = {}
        for region, merged_cells in enumerate(of_region):
            for merged_cell in sorted(merged_cells):
                self.regions_of.setdefault(merged_cell, []).append(region)
        self.separated = separated
        places: list[dict[int, list[int]]] = [{} for _ in of_region]
        for number, (region, merged_cells) in enumerate(self._named()):
            for merged_cell in merged_cells:
                places[region].setdefault(merged_cell, []).append(number)
        self.kinds: list[dict[int, int]] = []
        for own in places:
            first: dict[tuple[int, ...], int] = {}
            self.kinds.append({m: first.setdefault(tuple(own[m]), m) for m in sorted(own)})

    def demands(self) -> Iterator[int]:
        """Merged cells that have to be touched; then all others are touched as well.

        A merged cell needs no constraint if another one implies it: if it lies in all regions of
        the other one, and in each of them has the kind of the other one or no kind.
        """
        # One merged cell for each combination of regions and kinds there.
        different: dict[tuple[tuple[int, int | None], ...], int] = {}
        for merged_cell, regions in self.regions_of.items():
            key = tuple((region, self.kinds[region].get(merged_cell)) for region in regions)
            different.setdefault(key, merged_cell)
        cells_with: dict[int, set[int]] = {}
        of = {merged_cell: dict(key) for key, merged_cell in different.items()}
        for merged_cell, own in of.items():
            for region in own:
                cells_with.setdefault(region, set()).add(merged_cell)
        implied: set[int] = set()
        for merged_cell, own in of.items():
            for other in set.intersection(*(cells_with[region] for region in own)):
                its = of[other]
                if other != merged_cell and all(its[r] in (None, kind) for r, kind in own.items()):
                    implied.add(other)
        return (merged_cell for merged_cell in of if merged_cell not in implied)

    def kinds_of(self, region: int, merged_cells: Iterable[int]) -> frozenset[int]:
        """The kinds of some merged cells of a region."""
        return frozenset(self.kinds[region][merged_cell] for merged_cell in merged_cells)

    def _named(self) -> Iterable[tuple[int, frozenset[int]]]:
        """Sets of merged cells that separations name, each with its region."""
        for (one, other), separations in self.separated.items():
            for ends, groups in separations:
                yield from ((one, end) for end in ends)
                yield from ((other, group) for group in groups)


class PlanModel:
    """The model of plans with an exact number of segments.

    Args:
        cells: the merged cells.
        segments: how many segments a plan has.
        copies: how many segments of each region the plan tells apart.
        most: how many segments each region may have at most, as many as its copies or more.
        last: the segments of the last plan with the kinds that they touch, as a hint.

    Attributes:
        model: the model.
        in_use: for every copy: it is a segment of the plan.
        beyond: for every region that may have more segments than copies: it has.
        touched: for every copy and kind: the segment touches that kind.
    """

    def __init__(
        self,
        cells: PlanCells,
        segments: int,
        copies: Sequence[int],
        most: Sequence[int],
        last: Mapping[SegmentName, set[int]],
    ) -> None:
        self.model = cp_model.CpModel()
        self.in_use: dict[SegmentName, cp_model.IntVar] = {}
        self.beyond: dict[int, cp_model.IntVar] = {}
        self.touched: dict[SegmentName, dict[int, cp_model.IntVar]] = {}
        self._cells = cells
        self._copies = copies
        self._touching: dict[tuple[SegmentName, frozenset[int]], cp_model.IntVar] = {}
        self._add_segments(last)
        self.model.add(sum([*self.in_use.values(), *self._further(most)]) == segments)
        self._add_cover()
        for one, other in cells.separated:
            self._add_separations(one, other)

    def _add_segments(self, last: Mapping[SegmentName, set[int]]) -> None:
        """Literals for the copies in use, in their order, and for the kinds that each touches."""
        model = self.model
        for region, copy in chain.from_iterable(map(self._segments_in, range(len(self._copies)))):
            segment = region, copy
            self.in_use[segment] = own = model.new_bool_var("")
            model.add_hint(own, segment in last)
            if copy:
                model.add_implication(own, self.in_use[region, copy - 1])
            self.touched[segment] = {}
            for kind in sorted(set(self._cells.kinds[region].values())):
                self.touched[segment][kind] = literal = model.new_bool_var("")
                model.add_implication(literal, own)
                model.add_hint(literal, kind in last.get(segment, ()))

    def _further(self, most: Sequence[int]) -> Iterator[cp_model.IntVar]:
        """How many segments each region has besides its copies, which then are all in use."""
        for region, own in enumerate(self._copies):
            if own < most[region]:
                further = self.model.new_int_var(0, most[region] - own, "")
                self.beyond[region] = literal = self.model.new_bool_var("")
                self.model.add_implication(literal, self.in_use[region, own - 1])
                self.model.add(further == 0).only_enforce_if(~literal)
                self.model.add(further >= 1).only_enforce_if(literal)
                self.model.add_hint(literal, False)
                self.model.add_hint(further, 0)
                yield further

    def _beyond(self, *regions: int) -> list[cp_model.IntVar]:
        """Literals of which one is true if one of the regions has more segments than copies."""
        return [self.beyond[region] for region in sorted({*regions}) if region in self.beyond]

    def _segments_in(self, region: int) -> list[SegmentName]:
        """The copies of a region."""
        return [(region, copy) for copy in range(self._copies[region])]

    def _add_cover(self) -> None:
        """Every merged cell is touched by some segment."""
        for merged_cell in self._cells.demands():
            literals = []
            for region in self._cells.regions_of[merged_cell]:
                kind = self._cells.kinds[region].get(merged_cell)
                if kind is None:
                    literals += [self.in_use[first] for first in self._segments_in(region)[:1]]
                else:
                    own = self._segments_in(region)
                    literals += [self.touched[segment][kind] for segment in own]
                    literals += self._beyond(region)
            self.model.add_bool_or(literals)

    def _touches(self, segment: SegmentName, merged_cells: Iterable[int]) -> cp_model.IntVar:
        """A literal that is true if a segment touches one of some merged cells."""
        key = segment, self._cells.kinds_of(segment[0], merged_cells)
        if key not in self._touching:
            self._touching[key] = self.model.new_bool_var("")
            for kind in sorted(key[1]):
                self.model.add_implication(self.touched[segment][kind], self._touching[key])
        return self._touching[key]

    def _add_separations(self, one: int, other: int) -> None:
        """If a segment of ``one`` touches both ends, none of ``other`` touches two groups."""
        told_apart = [~literal for literal in self._beyond(one, other)]
        for own, groups in self._cells.separated[one, other]:
            for near, far in product(self._segments_in(one), self._segments_in(other)):
                ends = [self._touches(near, merged_cells) for merged_cells in own]
                touched = [self._touches(far, group) for group in groups]
                self.model.add(sum(touched) <= 1).only_enforce_if(ends + told_apart)
