"""The commands that compare solvers: ``bench`` and ``campaign``."""

from __future__ import annotations

from pathlib import Path

import click

from cellcolor.cli.commands.group import cellcolor
from cellcolor.cli.commands.options import INPUT, PATH, SECONDS, SEED

__all__ = ["bench", "campaign"]


@cellcolor.command()
@click.argument("files", metavar="FILE…", nargs=-1, required=True, type=INPUT)
@click.option(
    "--time-limit",
    metavar="S",
    type=SECONDS,
    default=60.0,
    show_default=True,
    help="Seconds for each solve.",
)
def bench(files: tuple[Path, ...], time_limit: float) -> int:
    """Compare the reference solver with CP-SAT, one after the other, each on its own."""
    from cellcolor.cli.bench import bench_files

    return bench_files(files, time_limit)


@cellcolor.command()
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
@click.option(
    "--jobs",
    metavar="N",
    type=click.IntRange(min=1),
    default=2,
    show_default=True,
    help="Processes.",
)
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    type=PATH,
    default=Path("disagreements"),
    show_default=True,
    help="Where disagreements are kept.",
)
def campaign(count: int, seed: int, time_limit: float, jobs: int, output: Path) -> int:
    """Hold the solvers to each other on random instances; exit code 1 if they disagree."""
    from cellcolor.cli.campaign import run_campaign

    return run_campaign(count, seed, time_limit, jobs, output)
