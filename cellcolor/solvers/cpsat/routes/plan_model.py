"""The model of a segment plan: which color regions get segments, and what each of them touches."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import product

from ortools.sat.python import cp_model

from cellcolor.solvers.bounds.tangles import Tangle

PartedCells = Mapping[
    tuple[int, int], Sequence[tuple[Sequence[frozenset[int]], Sequence[frozenset[int]]]]
]
"""Of the numbers of two color regions the partings: merged cells at both ends of a segment of the
one, and the groups of merged cells of the other that it parts."""

_Segment = tuple[int, int]
"""The number of a color region, and that of one of its segments."""


class PlanCells:
    """The merged cells that a plan is about.

    Args:
        of_region: the merged cells of each color region.
        parted: the partings that a plan has to satisfy.
        tangles: the tangles that a plan has to satisfy.

    Attributes:
        kinds: of each color region the merged cells that partings or tangles name, with the first
            of their kind. Merged cells that are ends of the same partings, and in the same groups,
            are of one kind: a segment that touches one of them may touch all. Those that none
            names any segment of the region can touch, so that nothing has to be decided about them.
    """

    def __init__(
        self,
        of_region: Sequence[frozenset[int]],
        parted: PartedCells,
        tangles: Sequence[Tangle],
    ) -> None:
        self.of_region = of_region
        self.parted = parted
        self.tangles = tangles
        places: list[dict[int, list[int]]] = [{} for _ in of_region]
        for number, (region, merged_cells) in enumerate(self._named()):
            for merged_cell in merged_cells:
                places[region].setdefault(merged_cell, []).append(number)
        self.kinds: list[dict[int, int]] = []
        for own in places:
            first: dict[tuple[int, ...], int] = {}
            self.kinds.append({m: first.setdefault(tuple(own[m]), m) for m in sorted(own)})

    def kinds_of(self, region: int, merged_cells: Iterable[int]) -> frozenset[int]:
        """The kinds of some merged cells of a region."""
        return frozenset(self.kinds[region][merged_cell] for merged_cell in merged_cells)

    def _named(self) -> Iterable[tuple[int, frozenset[int]]]:
        """Sets of merged cells that partings or tangles name, each with its region."""
        for tangle in self.tangles:
            for segment in tangle.segments:
                for merged_cells in (*segment.groups, segment.avoided):
                    yield segment.region, merged_cells
        for (one, other), partings in self.parted.items():
            for ends, groups in partings:
                yield from ((one, end) for end in ends)
                yield from ((other, group) for group in groups)


class PlanModel:
    """A plan with an exact number of segments.

    Args:
        cells: what the plan is about.
        segments: how many.
        copies: how many of them one region may have.
        last: the kinds that each segment of the last plan touches, for a hint.

    Attributes:
        model: the model.
        in_use: the literals of all segments that there may be.
        touched: for each of these the literals of the kinds that it touches.
    """

    def __init__(
        self,
        cells: PlanCells,
        segments: int,
        copies: int,
        last: Mapping[_Segment, set[int]],
    ) -> None:
        self.model = cp_model.CpModel()
        self.in_use: dict[_Segment, cp_model.IntVar] = {}
        self.touched: dict[_Segment, dict[int, cp_model.IntVar]] = {}
        self._cells = cells
        self._copies = copies
        self._touching: dict[tuple[_Segment, frozenset[int]], cp_model.IntVar] = {}
        self._add_segments(last)
        self.model.add(sum(self.in_use.values()) == segments)
        self._add_cover()
        for one, other in cells.parted:
            self._add_partings(one, other)
        for tangle in cells.tangles:
            self._add_tangle(tangle)

    def _add_segments(self, last: Mapping[_Segment, set[int]]) -> None:
        """Literals for the segments in use and for what each touches."""
        model = self.model
        for segment in product(range(len(self._cells.of_region)), range(self._copies)):
            region, copy = segment
            self.in_use[segment] = own = model.new_bool_var("")
            model.add_hint(own, segment in last)
            if copy:
                model.add_implication(own, self.in_use[region, copy - 1])
            self.touched[segment] = {}
            for kind in sorted(set(self._cells.kinds[region].values())):
                self.touched[segment][kind] = literal = model.new_bool_var("")
                model.add_implication(literal, own)
                model.add_hint(literal, kind in last.get(segment, ()))

    def _add_cover(self) -> None:
        """Every merged cell is touched by some segment."""
        touching: dict[int, list[cp_model.IntVar]] = {}
        for region, merged_cells in enumerate(self._cells.of_region):
            kinds = self._cells.kinds[region]
            for copy in range(self._copies):
                for merged_cell, kind in kinds.items():
                    literal = self.touched[region, copy][kind]
                    touching.setdefault(merged_cell, []).append(literal)
            for merged_cell in merged_cells - kinds.keys():
                touching.setdefault(merged_cell, []).append(self.in_use[region, 0])
        # Most merged cells are touched wherever another one is.
        different = {tuple(literal.index for literal in own): own for own in touching.values()}
        for literals in different.values():
            self.model.add_bool_or(literals)

    def _touches(self, segment: _Segment, merged_cells: Iterable[int]) -> cp_model.IntVar:
        """A literal that is true where a segment touches one of some merged cells."""
        key = segment, self._cells.kinds_of(segment[0], merged_cells)
        if key not in self._touching:
            self._touching[key] = self.model.new_bool_var("")
            for kind in sorted(key[1]):
                self.model.add_implication(self.touched[segment][kind], self._touching[key])
        return self._touching[key]

    def _add_partings(self, one: int, other: int) -> None:
        """No segment of a region touches two groups that a segment of another one parts."""
        for own, groups in self._cells.parted[one, other]:
            for near, far in product(range(self._copies), repeat=2):
                ends = [self._touches((one, near), merged_cells) for merged_cells in own]
                parted = [self._touches((other, far), group) for group in groups]
                self.model.add(sum(parted) <= 1).only_enforce_if(ends)

    def _add_tangle(self, tangle: Tangle) -> None:
        """Whichever segments its regions get, they do not touch some group, or do touch what they
        would have to avoid."""
        for chosen in product(range(self._copies), repeat=len(tangle.segments)):
            segments = [(s.region, copy) for s, copy in zip(tangle.segments, chosen, strict=True)]
            if len(set(segments)) < len(segments):
                continue  # none is beside itself
            literals: list[cp_model.LiteralT] = []
            for segment, own in zip(segments, tangle.segments, strict=True):
                literals += [~self._touches(segment, group) for group in own.groups]
                kinds = self._cells.kinds_of(segment[0], own.avoided)
                literals += [self.touched[segment][kind] for kind in sorted(kinds)]
            self.model.add_bool_or(literals)
