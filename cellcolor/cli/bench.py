"""``cellcolor bench``: one table, the reference solver against CP-SAT."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich import box
from rich.table import Table

from cellcolor.cli.exits import Exit, worst
from cellcolor.cli.inputs import read_instance
from cellcolor.cli.progress import progress_of
from cellcolor.cli.tables import console
from cellcolor.cli.terminal import complain, shown
from cellcolor.errors import CellcolorError, InputError
from cellcolor.lab.races import Run, race
from cellcolor.solvers.registry import DEFAULT, REFERENCE

_SOLVERS = (REFERENCE, DEFAULT)
"""What is measured, the slow one first: the ratio is of the first to the second."""


def bench_files(files: Sequence[Path], time_limit: float) -> Exit:
    """Measure every file with every solver; a bad file does not stop the others."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    table.add_column("file", overflow="fold")
    for name in (
        "cells",
        "max live darts",
        "minimum",
        *(f"{s} seconds" for s in _SOLVERS),
        "ratio",
    ):
        table.add_column(name, justify="right")
    codes = []
    for file in files:
        try:
            instance = read_instance(file)
            with progress_of(file):
                runs = race(instance, _SOLVERS, time_limit)
        except CellcolorError as error:
            named = isinstance(error, InputError) and error.file
            complain(error if named else f"{file}: {error}")
            codes.append(Exit.BAD_INPUT)
            continue
        table.add_row(
            shown(file),
            str(len(instance.cells)),
            str(instance.most_live_darts),
            _minimum(runs),
            *(_seconds(runs[solver]) for solver in _SOLVERS),
            _ratio(runs),
        )
        proved = all(run.optimal for run in runs.values())
        codes.append(Exit.DONE if proved else Exit.STOPPED)
    if table.row_count:
        console().print(table)
        console().print(
            f"ratio: {_SOLVERS[0]} seconds over {_SOLVERS[1]} seconds; > not proved in time"
        )
    return worst(codes)


def _minimum(runs: dict[str, Run]) -> str:
    found = [run.segments for run in runs.values() if run.segments is not None]
    if not found:
        return "?"
    proved = any(run.optimal for run in runs.values())
    return str(min(found)) if proved else f"<= {min(found)}"


def _seconds(run: Run) -> str:
    if run.seconds is None:
        return "gave no answer"
    return f"{run.seconds:.3f}" if run.optimal else f"> {run.seconds:.1f}"


def _ratio(runs: dict[str, Run]) -> str:
    """Only where both came to an end: a limit is no measurement."""
    slow, fast = (runs[solver] for solver in _SOLVERS)
    if not (slow.optimal and fast.optimal and slow.seconds is not None and fast.seconds):
        return ""
    return f"{slow.seconds / fast.seconds:.2f}"
