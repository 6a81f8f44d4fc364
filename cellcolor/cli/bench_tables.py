"""``cellcolor bench summary``, ``plots`` and ``start-up``: what is made of tables of results."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

from cellcolor.cli.bench_run import command_line
from cellcolor.cli.exits import Exit
from cellcolor.cli.terminal import complain, say
from cellcolor.cli.workers import progress_bar
from cellcolor.door.extras import extras_for
from cellcolor.door.shipped import find_file
from cellcolor.errors import InputError
from cellcolor.files.writing import PNG, SVG, Output, write
from cellcolor.lab.runs.agreement import disagreements
from cellcolor.lab.runs.row import Row
from cellcolor.lab.runs.series import plots_of
from cellcolor.lab.runs.summary import summary_of_runs, summary_of_timings
from cellcolor.lab.runs.table import TableFile, header_of, read_table
from cellcolor.lab.runs.timings import START_UP, Timing, start_up_timings

_SMALL = "ring"
"""The shipped instance that the start-up is measured with."""


def print_summary(tables: Sequence[Path]) -> Exit:
    """Print what tables say, those of solvers first."""
    rows, timings = _read(tables)
    if rows:
        for line in summary_of_runs(rows):
            say(line)
    if timings:
        if rows:
            say()
            say("## Other measurements")
            say()
        for line in summary_of_timings(timings):
            say(line)
    if not rows and not timings:
        raise InputError(str(tables[0]), None, "has no rows")
    return Exit.INVALID if disagreements(rows) else Exit.DONE


def draw_plots(tables: Sequence[Path], folder: Path) -> Exit:
    """Draw what tables of solvers say."""
    with extras_for("plots"):
        from cellcolor.pictures.plots import render_plot
    rows, _ = _read(tables)
    if not rows:
        raise InputError(str(tables[0]), None, "has no runs of solvers")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(str(folder), None, error.strerror or "cannot be made") from error
    for name, plot in plots_of(rows).items():
        for suffix, kind in (("png", PNG), ("svg", SVG)):
            file = folder / f"{name}.{suffix}"
            write([Output(file, kind, [render_plot(plot, suffix)])], tables)
            say(file)
    return Exit.DONE


def measure_start_up(repetitions: int, output: Path | None) -> Exit:
    """Measure, keep each measurement at once, and print the medians."""
    table: AbstractContextManager[TableFile[Timing] | None] = (
        nullcontext() if output is None else TableFile(output, Timing)
    )
    made: list[Timing] = []
    total = repetitions * len(START_UP)
    with table as file, progress_bar(total) as advance:
        for one in start_up_timings(find_file(_SMALL), repetitions, command_line()):
            made.append(one)
            if file is not None:
                file.append(one)
            advance(len(made), one.subject)
    for line in summary_of_timings(made):
        say(line)
    failed = [one for one in made if one.status != "done"]
    for one in failed:
        complain(f"{one.subject}: {one.status}")
    return Exit.STOPPED if failed else Exit.DONE


def _read(tables: Sequence[Path]) -> tuple[list[Row], list[Timing]]:
    """The rows of all tables, by their kinds."""
    rows: list[Row] = []
    timings: list[Timing] = []
    for path in tables:
        if header_of(path, (Row, Timing)) is Row:
            rows += read_table(path, Row)
        else:
            timings += read_table(path, Timing)
    return rows, timings
