"""Experiments: ``bench run`` and the other commands of its group."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from cellcolor.cli.options import CLUSTER, JOBS, PATH, SECONDS, SEED, Commands, cellcolor
from cellcolor.solvers.registry import DEFAULT, REFERENCE


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
@click.option(
    "--solver",
    "solvers",
    metavar="NAME[@WORKERS]",
    multiple=True,
    default=(REFERENCE, DEFAULT),
    show_default=True,
    help="Solver; repeat the option for several.",
)
@click.option(
    "--seeds",
    metavar="N-M",
    callback=_numbers,
    default="0-9",
    show_default=True,
    help="Of families.",
)
@click.option(
    "--time-limit",
    "limits",
    metavar="S",
    type=SECONDS,
    multiple=True,
    default=(10.0,),
    show_default=True,
    help="Seconds for each solve; several are tried in turn.",
)
@click.option(
    "--repetitions",
    metavar="N",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Repetitions of each run, with other random numbers in the solver.",
)
@click.option(
    "--search-space",
    type=click.Choice(["paper", "surface"]),
    default="paper",
    show_default=True,
    help="As with solve.",
)
@click.option(
    "--memory",
    "megabytes",
    metavar="MB",
    type=click.IntRange(min=1),
    default=4096,
    show_default=True,
    help="Memory for each run; a run that needs more is killed.",
)
@click.option("--jobs", default=1, **JOBS)
@CLUSTER
@click.option(
    "-o",
    "--output",
    metavar="TABLE.csv",
    type=PATH,
    help="A row for each run. An existing table is continued: its runs are not repeated.",
)
def run(output: Path | None, **given: Any) -> int:
    """Run solvers on instances, each solve in a process of its own.

    FAMILY is a set of random families (small, medium, large, growing), the library of shipped
    graphs (library) or one family, such as medium/thin; * stands for anything. Solvers that are
    not installed are left out. Exit code 1 if two runs contradict each other.
    """
    from cellcolor.cli.bench_run import Request, run_solvers

    return run_solvers(Request(**given), output)


@bench.command()
@_TABLES
def summary(tables: tuple[Path, ...]) -> int:
    """Sum tables up as Markdown; exit code 1 if two runs contradict each other."""
    from cellcolor.cli.bench_tables import print_summary

    return print_summary(tables)


@bench.command()
@_TABLES
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    type=PATH,
    required=True,
    help="Folder for the pictures, as PNG and SVG.",
)
def plots(tables: tuple[Path, ...], output: Path) -> int:
    """Draw tables: cactus, growth, scatter against the strongest rival, performance profile."""
    from cellcolor.cli.bench_tables import draw_plots

    return draw_plots(tables, output)


@bench.command()
@click.option(
    "--repetitions",
    metavar="N",
    type=click.IntRange(min=1),
    default=5,
    show_default=True,
    help="Of each measurement.",
)
@click.option("-o", "--output", metavar="TABLE.csv", type=PATH, help="A row for each measurement.")
def start_up(repetitions: int, output: Path | None) -> int:
    """Measure how long the program takes to start."""
    from cellcolor.cli.bench_tables import measure_start_up

    return measure_start_up(repetitions, output)


@bench.command()
@click.option(
    "--count",
    metavar="N",
    type=click.IntRange(min=1),
    default=500,
    show_default=True,
    help="Random instances.",
)
@SEED
@click.option(
    "--time-limit",
    metavar="S",
    type=SECONDS,
    default=20.0,
    show_default=True,
    help="Seconds for each solve.",
)
@click.option("--jobs", default=2, **JOBS)
@CLUSTER
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    type=PATH,
    default=Path("disagreements"),
    show_default=True,
    help="Folder for disagreements.",
)
def campaign(**given: Any) -> int:
    """Hold the solvers to each other on small instances; exit code 1 if they disagree."""
    from cellcolor.cli.campaign import run_campaign

    return run_campaign(**given)
