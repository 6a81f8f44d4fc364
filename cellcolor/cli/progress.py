"""Progress on standard error, only where somebody watches."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from cellcolor.cli.exits import Ended
from cellcolor.cli.interrupts import INTERRUPTS
from cellcolor.cli.terminal import shown
from cellcolor.data.wording import count
from cellcolor.deadline import OutOfTime
from cellcolor.errors import InputError
from cellcolor.solvers.interface import OnProgress


@contextmanager
def progress_of(file: Path) -> Iterator[OnProgress | None]:
    """A line with the time spent, the best division and the bound; None without a terminal."""
    name = shown(file.name)
    with _line(f"{name}: solving") as show:
        if show is None:
            yield None
            return

        def report(segments: int | None, lower_bound: int) -> None:
            best = "no division yet" if segments is None else f"best {segments}"
            show(f"{name}: {best}, at least {lower_bound}")

        yield report


@contextmanager
def scheme_progress_of(file: Path) -> Iterator[Callable[[int], None] | None]:
    """A line with the time spent and the schemes found; None without a terminal."""
    name = shown(file.name)
    with _line(f"{name}: looking for schemes") as show:
        if show is None:
            yield None
            return
        yield lambda found: show(f"{name}: {count(found, 'scheme')} so far")


@contextmanager
def stages_of(file: Path, work: str) -> Iterator[Callable[[str], None]]:
    """A line with the time spent and what is being done, if there is a terminal.

    Libraries that catch everything can swallow a signal; it is raised at the next stage.
    """
    name = shown(file.name)
    with _line(f"{name}: {work}") as show:

        def report(stage: str) -> None:
            INTERRUPTS.check()
            if show is not None:
                show(f"{name}: {stage}")

        yield report


@contextmanager
def at_work(file: Path, work: str, late: str) -> Iterator[Callable[[str], None]]:
    """Progress of a command (:func:`stages_of`), and its end where it cannot be done.

    Args:
        file: what is worked on; an error without a file is one of this file.
        work: what is done.
        late: what is said where the time limit comes first.

    Raises:
        Ended: the time limit came first.
        InputError: with a file.
    """
    try:
        with stages_of(file, work) as report:
            yield report
    except OutOfTime as error:
        raise Ended(f"{file}: {late}") from error
    except InputError as error:
        raise error if error.file else error.in_file(str(file)) from error


@contextmanager
def _line(text: str) -> Iterator[Callable[[str], None] | None]:
    """A line that can be replaced; None without a terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress as Display
    from rich.progress import SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Display(*columns, console=Console(stderr=True), transient=True) as display:
        task = display.add_task(text, total=None)
        yield lambda text: display.update(task, description=text)
