"""Divisions and solutions written by hand, for the checker to judge."""

from __future__ import annotations

from library import PAPER

from cellcolor.data.cells_and_edges import DartName
from cellcolor.data.instance import Instance
from cellcolor.data.solution import CellDivision, Division, InstanceReference, Solution, SubCell

RED, BLUE = 0, 1
SPLIT = Instance.read(PAPER / "split-cell.json")


def divide(*cells: list[tuple[int, list[DartName], int]]) -> Division:
    """A division from (color, darts, segment) of the sub-cells of each cell."""
    return tuple(
        CellDivision(number, tuple(SubCell(c, tuple(darts), s) for c, darts, s in subs))
        for number, subs in enumerate(cells)
    )


def split_solution() -> Solution:
    """The cell that must be split: its blue neighbours joined through one half, red the other."""
    return Solution(
        instance=InstanceReference(SPLIT.name, SPLIT.sha256),
        search_space="paper",
        strands=1,
        solver="by hand",
        status="optimal",
        segments=2,
        lift_offs=1,
        lower_bound=2,
        surface_lower_bound=2,
        proved_for_surface=True,
        seams=(),
        cells=divide(
            [(BLUE, [3], 0)],
            [(BLUE, [6], 0)],
            [(BLUE, [-3, -6], 0), (RED, [11, 8], 1)],
            [(RED, [-8], 1)],
            [(RED, [-11], 1)],
        ),
        seconds=0.0,
    )
