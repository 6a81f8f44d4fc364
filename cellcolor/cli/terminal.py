"""What is printed, without control characters, and on standard error how far long work is."""

from __future__ import annotations

import io
import json
import os
import sys
import threading
import unicodedata
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, redirect_stdout, suppress
from pathlib import Path
from typing import Any, TextIO, cast

from cellcolor.cli.ending import INTERRUPTS
from cellcolor.data.wording import count
from cellcolor.deadline import OutOfTime
from cellcolor.errors import naming
from cellcolor.files.writing import is_standard_output

# Control and format characters, lone surrogates, separators of lines and paragraphs: a name with
# them could move a terminal's cursor, recolor it, or turn the direction of what follows.
_HIDDEN = ("Cc", "Cf", "Cs", "Zl", "Zp")


_READABLE = 1000  # characters


def shown(text: object) -> str:
    """A text with its control characters as escapes, to be read by people."""
    plain = str(text)
    if plain.isascii() and plain.isprintable():
        return plain
    return "".join(repr(c)[1:-1] if unicodedata.category(c) in _HIDDEN else c for c in plain)


def say(text: object = "") -> None:
    """Print a line on standard output."""
    print(shown(text))


def say_lines(text: object) -> None:
    """Print each line of a text on standard output."""
    for line in str(text).split("\n"):
        say(line)


def complain(message: object) -> None:
    """Print a line about a failure on standard error, long names and numbers shortened."""
    print(f"cellcolor: {shortened(shown(message))}", file=sys.stderr)


def shortened(text: str) -> str:
    """A text without its middle, where it is too long to be read."""
    return text if len(text) <= _READABLE else f"{text[: _READABLE // 2]} … {text[-100:]}"


def print_json(document: Mapping[str, Any]) -> None:
    """Print one line of JSON Lines, at once."""
    print(json.dumps(document), flush=True)


class Listener:
    """A standard stream that, once it cannot be written to, is written to no more.

    A reader that went away is no reason to leave the work undone.

    Attributes:
        lost: why what was printed did not arrive, None as long as it does.
    """

    def __init__(self, stream: TextIO | None) -> None:
        self.lost: str | None = None
        self._stream = io.StringIO() if stream is None else stream
        self._closed = stream is None
        if isinstance(stream, io.TextIOWrapper):
            # Names of files need not be text, nor has every terminal all letters.
            stream.reconfigure(errors="backslashreplace")

    def write(self, text: str) -> int:
        """Write, or note why not."""
        if self._closed and text:
            self.lost = self.lost or "is closed"
        self._try(self._stream.write, text)
        return len(text)

    def flush(self) -> None:
        """Flush, or note why not."""
        self._try(self._stream.flush)

    def _try(self, do: Callable[..., object], *given: str) -> None:
        if self.lost is not None:
            return
        try:
            do(*given)
        except OSError as error:
            self.lost = error.strerror or "cannot be written"
            # What the buffer still holds would fail again when Python ends.
            with suppress(OSError, ValueError):
                handle = os.open(os.devnull, os.O_WRONLY)
                os.dup2(handle, self._stream.fileno())
                os.close(handle)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)


@contextmanager
def guarded_streams() -> Iterator[Listener]:
    """Put listeners in the places of standard output and error; yields that of the output."""
    # A file opened later must not become standard output because that was closed.
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)
    output, errors = sys.stdout, sys.stderr
    listener = Listener(output)
    sys.stdout, sys.stderr = cast(TextIO, listener), cast(TextIO, Listener(errors))
    try:
        yield listener
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        sys.stdout, sys.stderr = output, errors


@contextmanager
def apart_from(path: Path | None) -> Iterator[None]:
    """Print on standard error what would be mixed with a file written to standard output."""
    if path is not None and is_standard_output(path):
        with redirect_stdout(sys.stderr):
            yield
    else:
        yield


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
def at_work(file: Path, work: str) -> Iterator[Callable[[str], None]]:
    """The same, told what is done next; errors name the file.

    Libraries that catch everything can swallow a signal; it is raised at the next stage.

    Raises:
        OutOfTime: the time limit came first.
        InputError: with a file.
    """
    with naming(file), line_of(file, work) as show:

        def report(stage: str) -> None:
            INTERRUPTS.check()
            show(stage)

        try:
            yield report
        except OutOfTime as error:
            raise OutOfTime(f"{file}: the time limit came first") from error
    INTERRUPTS.check()


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
