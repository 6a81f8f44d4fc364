"""Progress on standard error, only where somebody watches."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cellcolor.solvers.interface import Progress


@contextmanager
def progress_of(file: Path) -> Iterator[Progress | None]:
    """A line with the time spent, the best division and the bound; None without a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress as Display
    from rich.progress import SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Display(*columns, console=Console(stderr=True), transient=True) as display:
        task = display.add_task(f"{file.name}: solving", total=None)

        def report(segments: int | None, lower_bound: int) -> None:
            best = "no division yet" if segments is None else f"best {segments}"
            display.update(task, description=f"{file.name}: {best}, at least {lower_bound}")

        yield report
