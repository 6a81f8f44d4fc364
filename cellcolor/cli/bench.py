"""Experiments: ``bench run`` and the other commands of its group."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from cellcolor.cli.ending import Exit
from cellcolor.cli.options import (
    PATH,
    SECONDS,
    Commands,
    Count,
    cellcolor,
    option,
    output_option,
    shared,
)
from cellcolor.cli.terminal import say_lines
from cellcolor.errors import InputError
from cellcolor.solvers.registry import DEFAULT, PAPERS, REFERENCE

if TYPE_CHECKING:
    from cellcolor.lab.runs.row import Row


def _numbers(_context: click.Context, _option: click.Parameter, value: str) -> tuple[int, ...]:
    """Numbers and ranges of them, such as ``0-9`` or ``3,7,10-12``."""
    found: list[int] = []
    for part in value.split(","):
        first, dash, last = part.strip().partition("-")
        if not first.isdecimal() or (dash and not last.isdecimal()):
            raise click.BadParameter(f"{value!r} is not a list like 0-9 or 3,7,10-12.")
        found += range(int(first), int(last or first) + 1)
    if not found:
        raise click.BadParameter(f"{value!r} contains no number.")
    return tuple(dict.fromkeys(found))


_TABLES = click.argument("tables", metavar="TABLE.csv…", nargs=-1, required=True, type=PATH)


@cellcolor.group(cls=Commands)
def bench() -> None:
    """Experiments: solvers compared, on families of instances and on files."""


@bench.command()
@click.argument("subjects", metavar="FAMILY|FILE…", nargs=-1, required=True)
@option(
    "--solver",
    None,
    "Solver; repeat the option for several.",
    to="solvers",
    default=(PAPERS, REFERENCE, DEFAULT),
    metavar="NAME[@WORKERS]",
    multiple=True,
)
@option("--seeds", None, "Of families.", default="0-9", metavar="N-M", callback=_numbers)
@option(
    "--time-limit",
    SECONDS,
    "Seconds for each solve; several are tried in turn.",
    to="limits",
    default=(10.0,),
    multiple=True,
)
@option(
    "--repetitions",
    Count(1),
    "Repetitions of each run, with other random numbers in the solver.",
    default=1,
)
@shared("search_space")
@option(
    "--memory",
    Count(1),
    "Memory for each run; a run that needs more is killed.",
    to="megabytes",
    default=4096,
    metavar="MB",
)
@shared("jobs")
@output_option(
    "TABLE.csv", "A row for each run. An existing table is continued: its runs are not repeated."
)
def run(**given: Any) -> Exit:
    """Run solvers on instances, each solve in a process of its own.

    FAMILY is a set of random families (small, medium, large, growing), the library of shipped
    graphs (library) or one family, such as medium/thin; * stands for anything. Solvers that are
    not installed are left out. Exit code 1 if two runs contradict each other.
    """
    from cellcolor.cli.bench_run import run_solvers

    return run_solvers(**given)


@bench.command()
@_TABLES
def summary(tables: tuple[Path, ...]) -> Exit:
    """Sum tables up as Markdown; exit code 1 if two runs contradict each other."""
    from cellcolor.lab.runs.row import disagreements
    from cellcolor.lab.runs.summary import summary_of_runs

    rows = _read(tables)
    if not rows:
        raise InputError(str(tables[0]), None, "has no rows")
    say_lines("\n".join(summary_of_runs(rows)))
    return Exit.INVALID if disagreements(rows) else Exit.DONE


def _read(tables: Sequence[Path]) -> list[Row]:
    """The rows of all tables."""
    from cellcolor.lab.runs.table import read_table

    return [row for path in tables for row in read_table(path)]
