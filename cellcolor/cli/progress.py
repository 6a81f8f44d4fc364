"""How far long work is, on standard error."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from cellcolor.cli.ending import INTERRUPTS
from cellcolor.cli.terminal import shown
from cellcolor.data.wording import count
from cellcolor.deadline import OutOfTime
from cellcolor.errors import naming

_MINUTE = 60.0  # s


@contextmanager
def line_of(file: Path, work: str) -> Iterator[Callable[[str], None]]:
    """A line with the time spent and what is being done; without a terminal one each minute."""
    name = shown(file.name)
    if not sys.stderr.isatty():
        with _each_minute(f"{name}: {work}") as show:
            yield lambda text: show(f"{name}: {text}")
        return
    from rich.console import Console
    from rich.progress import Progress as Display
    from rich.progress import SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn())
    with Display(*columns, console=Console(stderr=True), transient=True) as display:
        task = display.add_task(f"{name}: {work}", total=None)
        yield lambda text: display.update(task, description=f"{name}: {text}")


@contextmanager
def stages_of(file: Path, work: str) -> Iterator[Callable[[str], None]]:
    """The same, told what is done next.

    Libraries that catch everything can swallow a signal; it is raised at the next stage.
    """
    with line_of(file, work) as show:

        def report(stage: str) -> None:
            INTERRUPTS.check()
            show(stage)

        yield report


@contextmanager
def at_work(file: Path, work: str, late: str) -> Iterator[Callable[[str], None]]:
    """Progress of a command (:func:`stages_of`), and its end where it cannot be done.

    Args:
        file: what is worked on; an error without a file is one of this file.
        late: what is said where the time limit comes first.

    Raises:
        OutOfTime: the time limit came first.
        InputError: with a file.
    """
    try:
        with naming(file), stages_of(file, work) as report:
            yield report
    except OutOfTime as error:
        raise OutOfTime(f"{file}: {late}") from error


@contextmanager
def _each_minute(text: str) -> Iterator[Callable[[str], None]]:
    """What is being done, on standard error, where no line can be replaced."""
    latest, ended = text, threading.Event()

    def show(text: str) -> None:
        nonlocal latest
        latest = text

    def tell() -> None:
        minutes = 0
        while not ended.wait(_MINUTE):
            minutes += 1
            print(f"{latest}, {count(minutes, 'minute')} so far", file=sys.stderr, flush=True)

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield show
    finally:
        ended.set()
        teller.join()


@contextmanager
def progress_bar(total: int) -> Iterator[Callable[[int, str], None]]:
    """A bar on standard error, only where somebody watches; told what is done, and a text."""
    if not sys.stderr.isatty():
        yield lambda *_: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed
    from rich.progress import TimeRemainingColumn as Remaining

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn())
    bar = Progress(*columns, Elapsed(), Remaining(), console=Console(stderr=True), transient=True)
    with bar:
        task = bar.add_task("", total=total)
        yield lambda done, text: bar.update(task, completed=done, description=text)
