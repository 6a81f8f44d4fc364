"""Solutions as tables; the same text with or without a terminal."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from cellcolor.cli.terminal import shown
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution

_CELLS_SHOWN = 12
_PLAIN_WIDTH = 200


def console() -> Console:
    """Standard output; wide where it is no terminal, so that no cell of a table is broken."""
    return Console(
        width=None if sys.stdout.isatty() else _PLAIN_WIDTH, highlight=False, markup=False
    )


def print_solution(instance: Instance, solution: Solution) -> None:
    """One solution: its segments, then what is known about their number."""
    out = console()
    out.print(
        Text(shown(instance.name), style="bold"),
        f"{len(instance.cells)} cells, {len(instance.edges)} edges, {len(instance.colors)} colors",
    )
    if solution.cells:
        out.print(_segments(instance, solution))
        if any(len({sub.segment for sub in cell.subcells}) > 1 for cell in solution.cells):
            out.print("ranges: where the cut runs through a divided cell is free, between its ends")
            out.print()
    summary = Table(box=None, show_header=False, pad_edge=False)
    for name, value in [*_summary(solution), *_witness(instance, solution)]:
        summary.add_row(Text(name, style="bold"), value)
    out.print(summary)
    out.print()


def print_overview(solved: Sequence[tuple[Path, Instance, Solution]]) -> None:
    """A line for each file."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("file", overflow="fold")
    for name in ("cells", "segments", "lift-offs", "at least"):
        table.add_column(name, justify="right")
    table.add_column("status")
    table.add_column("seconds", justify="right")
    for file, instance, solution in solved:
        table.add_row(
            shown(file),
            str(len(instance.cells)),
            _number(solution.segments),
            _number(solution.lift_offs),
            str(solution.lower_bound),
            _status(solution),
            f"{solution.seconds:.2f}",
        )
    console().print(table)


def _segments(instance: Instance, solution: Solution) -> Table:
    """Color, cells and share of the area of each segment.

    How a divided cell's area falls to its sub-cells is not known, hence the ranges.
    """
    areas = [cell.area for cell in instance.cells]
    known = [area for area in areas if area is not None]
    measured = len(known) == len(areas) and sum(known) > 0
    weights = known if measured else [1.0] * len(areas)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("segment", justify="right")
    table.add_column("color")
    table.add_column("cells", overflow="fold")
    table.add_column("share of area" if measured else "share of cells", justify="right")
    for segment in range(solution.segments or 0):
        whole: list[int] = []
        parts: list[int] = []
        color = 0
        for cell in solution.cells or ():
            own = [sub for sub in cell.subcells if sub.segment == segment]
            if own:
                color = own[0].color
                (whole if len(own) == len(cell.subcells) else parts).append(cell.id)
        least = sum(weights[cell] for cell in whole)
        most = least + sum(weights[cell] for cell in parts)
        table.add_row(
            str(segment),
            shown(instance.colors[color]),
            _cell_list(whole, parts),
            _share(least / sum(weights), most / sum(weights)),
        )
    return table


def _cell_list(whole: list[int], parts: list[int]) -> str:
    divided = set(parts)
    names = [f"part of {c}" if c in divided else str(c) for c in sorted(whole + parts)]
    if len(names) > _CELLS_SHOWN:
        return f"{', '.join(names[:_CELLS_SHOWN])}, … ({len(names)} cells)"
    return ", ".join(names)


def _share(least: float, most: float) -> str:
    low, high = f"{100 * least:.1f}", f"{100 * most:.1f}"
    return f"{low} %" if low == high else f"{low}–{high} %"


def _summary(solution: Solution) -> list[tuple[str, str]]:
    lines = [
        ("segments", _number(solution.segments)),
        ("lift-offs", _number(solution.lift_offs)),
        ("status", _status(solution)),
        (
            "at least",
            f"{solution.lower_bound} in this search space, "
            f"{solution.surface_lower_bound} in any division of the surface",
        ),
        ("time", f"{solution.seconds:.2f} s with {solution.solver}"),
    ]
    if solution.cutting_paths is not None:
        fewest = solution.cutting_paths == solution.cutting_paths_lower_bound
        proof = "fewest" if fewest else f"at least {solution.cutting_paths_lower_bound}"
        lines.insert(2, ("cutting paths", f"{solution.cutting_paths} ({proof})"))
    if solution.schemes is not None:
        lines.insert(3, ("schemes", f"{solution.schemes} ({_extent(solution)})"))
    return lines


def _extent(solution: Solution) -> str:
    """Whether the schemes that were found are all there are."""
    if solution.complete:
        return "all of them"
    if solution.status != "optimal":
        return "not looked for: the minimum is not proved"
    return "the search was stopped, there may be more: see --limit and --time-limit"


def _witness(instance: Instance, solution: Solution) -> list[tuple[str, str]]:
    """Why there cannot be fewer segments, where a person can see it."""
    from cellcolor.solvers.bounds import strangers

    if not solution.proved_for_surface or not 1 < (solution.segments or 0) <= _CELLS_SHOWN:
        return []
    cells = strangers(instance)
    if len(cells) != solution.segments:
        return []
    names = ", ".join(str(cell) for cell in cells)
    return [("because", f"no two of the cells {names} can be in one segment")]


def _status(solution: Solution) -> str:
    space: str = solution.search_space
    if space == "surface":
        space += f", {solution.strands} strands"
    proof = "; proved for any division" if solution.proved_for_surface else ""
    return f"{solution.status} ({space}{proof})"


def _number(value: int | None) -> str:
    return "none found" if value is None else str(value)
