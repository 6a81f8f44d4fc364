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
from cellcolor.data.shares import (
    BASES,
    GIVEN_UP,
    UNREACHABLE,
    Shares,
    percent,
    segment_rows,
    shares_of,
)
from cellcolor.data.solution import Solution
from cellcolor.data.wording import count

_SEGMENTS_SHOWN = 200
_PLAIN_WIDTH = 200


def console() -> Console:
    """Standard output; wide where it is no terminal, so that no cell of a table is broken."""
    return Console(
        width=None if sys.stdout.isatty() else _PLAIN_WIDTH, highlight=False, markup=False
    )


def print_solution(instance: Instance, solution: Solution) -> None:
    """One solution: its segments, then what is known about their number.

    Args:
        solution: a valid solution of it.
    """
    out = console()
    out.print(Text(shown(instance.name), style="bold"), instance.size)
    if solution.cells:
        shares = shares_of(instance, solution)
        out.print(_segments(instance, solution, shares))
        if not shares.certain:
            out.print("ranges: the cut through a divided cell may run anywhere between its ends")
            out.print()
    summary = Table(box=None, show_header=False, pad_edge=False)
    for name, value in [*_summary(solution), *_because(instance, solution)]:
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


def _segments(instance: Instance, solution: Solution, shares: Shares) -> Table:
    """Color, cells and share of each segment, and what is in none."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("segment", justify="right")
    table.add_column("color")
    table.add_column("cells", overflow="fold")
    table.add_column(BASES[shares.of], justify="right")
    for row in segment_rows(instance, solution, shares)[:_SEGMENTS_SHOWN]:
        table.add_row(str(row.segment), shown(row.color), row.cells, row.percent)
    if (more := len(shares.segments) - _SEGMENTS_SHOWN) > 0:
        table.add_row("…", count(more, "more segment"), "", "")
    if shares.of == "surface":
        table.add_row("", UNREACHABLE, "", percent(shares.unreachable, shares.unreachable))
        if shares.given_up:
            table.add_row("", GIVEN_UP, "", percent(shares.given_up, shares.given_up))
    return table


def nothing_to_cover(instance: Instance) -> str:
    """What to say loudly of an instance made of a surface without any color."""
    assert instance.coverage is not None
    unreachable, given_up = instance.coverage.unreachable, instance.coverage.given_up
    return (
        f"NOTHING CAN BE COVERED: {percent(unreachable, unreachable)} of the surface {UNREACHABLE}"
        + (f", {percent(given_up, given_up)} {GIVEN_UP}" if given_up else "")
    )


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
    lines += [("note", note) for note in solution.notes]
    if solution.schemes is not None:
        lines.insert(3, ("schemes", f"{solution.schemes} ({_extent(solution)})"))
    return lines


def _extent(solution: Solution) -> str:
    """Whether the schemes that were found are all there are."""
    if solution.complete:
        return "all of them"
    if solution.status != "optimal":
        return "not searched for: the minimum is not proved"
    return "the search was stopped, there may be more: see --limit and --time-limit"


def _because(instance: Instance, solution: Solution) -> list[tuple[str, str]]:
    """Why there cannot be fewer segments, or by what that is proved."""
    told = (("because", solution.why_not_fewer(instance)), ("proved by", solution.proved_by))
    return [(name, text) for name, text in told if text is not None]


def _status(solution: Solution) -> str:
    space: str = solution.search_space
    if space == "surface":
        space += f", {solution.strands} strands"
    proof = "; proved for any division" if solution.proved_for_surface else ""
    return f"{solution.status} ({space}{proof})"


def _number(value: int | None) -> str:
    return "none found" if value is None else str(value)
