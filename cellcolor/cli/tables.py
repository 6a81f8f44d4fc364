"""Solutions as tables; the same text with or without a terminal."""

from __future__ import annotations

import sys

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from cellcolor.cli.terminal import say, shown
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


def print_solution(instance: Instance, solution: Solution) -> None:
    """One solution: its segments, then what is known about their number.

    Args:
        solution: a valid solution of it.
    """
    # Wide where it is no terminal, so that no cell of the table is broken.
    width = None if sys.stdout.isatty() else _PLAIN_WIDTH
    out = Console(width=width, highlight=False, markup=False)
    out.print(Text(shown(instance.name), style="bold"), instance.size)
    if solution.cells:
        shares = shares_of(instance, solution)
        out.print(_segments(instance, solution, shares))
        if not shares.certain:
            out.print("ranges: the cut through a divided cell may run anywhere between its ends")
            out.print()
    say(solution.in_words(instance))
    if solution.preference is not None:
        say(f"posture: {solution.preference}")
    if solution.schemes is not None:
        say(f"{count(solution.schemes, 'scheme')} ({_extent(solution)})")
    for note in solution.notes:
        say(note)
    space = solution.search_space
    strands = f" with {solution.strands} strands" if space == "surface" else ""
    say(f"{solution.seconds:.2f} s with {solution.solver}, search space {space}{strands}")
    say()


def _segments(instance: Instance, solution: Solution, shares: Shares) -> Table:
    """Color, cells and share of each segment, and what is in none."""
    rows = [
        (number, shown(color), cells, share)
        for number, color, cells, share in segment_rows(instance, solution, shares)
    ][:_SEGMENTS_SHOWN]
    if (more := len(shares.segments) - _SEGMENTS_SHOWN) > 0:
        rows.append(("…", count(more, "more segment"), "", ""))
    if shares.of == "surface":
        rows.append(("", UNREACHABLE, "", percent(shares.unreachable, shares.unreachable)))
        if shares.given_up:
            rows.append(("", GIVEN_UP, "", percent(shares.given_up, shares.given_up)))
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("segment", justify="right")
    table.add_column("color")
    table.add_column("cells", overflow="fold")
    table.add_column(BASES[shares.of], justify="right")
    for row in rows:
        table.add_row(*row)
    return table


def nothing_to_cover(instance: Instance) -> str:
    """What to say loudly of an instance made of a surface without any color."""
    assert instance.coverage is not None
    unreachable, given_up = instance.coverage.unreachable, instance.coverage.given_up
    return (
        f"NOTHING CAN BE COVERED: {percent(unreachable, unreachable)} of the surface {UNREACHABLE}"
        + (f", {percent(given_up, given_up)} {GIVEN_UP}" if given_up else "")
    )


def _extent(solution: Solution) -> str:
    """Whether the schemes that were found are all there are."""
    if solution.complete:
        return "all of them"
    if solution.status != "optimal":
        return "not searched for: the minimum is not proved"
    return "the search was stopped, there may be more: see --limit and --time-limit"
