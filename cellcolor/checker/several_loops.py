"""The rules where cells have several loops, read without seams (docs/semantics.md, section 5)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

from cellcolor.checker.cutting_paths import whole_subcells
from cellcolor.checker.dart_lists import strands_along
from cellcolor.checker.groups import Groups
from cellcolor.checker.scheme_rules import Joinable, PaintedCell, unavoidable_join
from cellcolor.data.darts import Strand
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Division, Seam


@dataclass(frozen=True, slots=True)
class PaintedLoops:
    """A cell's division, loop by loop.

    Attributes:
        id: the cell.
        loops: each live loop, with the sub-cells of the whole cell.
    """

    id: int
    loops: tuple[PaintedCell, ...]

    @property
    def whole(self) -> PaintedCell:
        """All loops as if they were one."""
        darts = [dart for loop in self.loops for dart in loop.darts]
        block_of = {dart: block for loop in self.loops for dart, block in loop.block_of.items()}
        return PaintedCell(darts, block_of, self.loops[0].colors)

    def unconnected_pair(self) -> tuple[int, int] | None:
        """Two sub-cells of one color that no chain of loops and sub-cells connects."""
        groups: Groups[int] = Groups()
        for loop in self.loops:
            blocks = list(loop.block_of.values())
            for block in blocks:
                groups.join(blocks[0], block)
        group = {block: n for n, part in enumerate(groups.sets()) for block in part}
        colors = self.loops[0].colors
        return next(
            (
                (one, other)
                for one, other in combinations(sorted(group), 2)
                if colors[one] == colors[other] and group[one] != group[other]
            ),
            None,
        )


def on_loops(
    instance: Instance, division: Division, seams: Sequence[Seam], strands: int
) -> list[PaintedLoops]:
    """A legal division without its seams; cells without live loops are left out."""
    virtual = {seam.id for seam in seams}
    found = []
    for cell, divided in zip(instance.cells, division, strict=True):
        subcells = whole_subcells(divided, virtual)
        block_of = {
            dart: number for number, subcell in enumerate(subcells) for dart in subcell.strands
        }
        colors = [subcell.color for subcell in subcells]
        loops = [
            [strand for dart in loop for strand in strands_along(dart, strands)]
            for loop in instance.live_loops[cell.id]
        ]
        painted = tuple(
            PaintedCell(loop, {dart: block_of[dart] for dart in loop if dart in block_of}, colors)
            for loop in loops
        )
        if painted:
            found.append(PaintedLoops(cell.id, painted))
    return found


def unavoidable_join_on_loops(cells: Sequence[PaintedLoops], joinable: Joinable) -> Strand | None:
    """Rule 5 loop by loop: an edge in state 0 that has to show one joinable color on both sides.

    A loop without darts in state 1 lies in one sub-cell of its cell, whichever suits, and all its
    darts show that color. Such loops are tried one after the other.
    """
    settled: list[PaintedCell] = []
    open_loops: list[tuple[PaintedCell, list[int]]] = []
    for cell in cells:
        colors = sorted(set(cell.loops[0].colors))
        for loop in cell.loops:
            if loop.block_of:
                settled.append(loop)
            else:
                open_loops.append((loop, colors))
    open_loops.sort(key=lambda item: len(item[1]))

    found = unavoidable_join(settled, joinable)
    if found is not None or not open_loops:
        return found
    known = len(settled)
    trail = [iter(open_loops[0][1])]
    while trail:
        loop, _ = open_loops[len(trail) - 1]
        color = next(trail[-1], None)
        del settled[known + len(trail) - 1 :]  # the color before
        if color is None:
            trail.pop()
            continue
        settled.append(PaintedCell(loop.darts, {}, [color]))
        found = unavoidable_join(settled, joinable)
        if found is None and len(trail) == len(open_loops):
            return None
        if found is None:
            trail.append(iter(open_loops[len(trail)][1]))
    return found
