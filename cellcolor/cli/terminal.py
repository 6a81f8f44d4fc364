"""What is printed: without control characters; where nobody can get it, that is said."""

from __future__ import annotations

import io
import json
import os
import sys
import unicodedata
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stdout, suppress
from pathlib import Path
from typing import Any, TextIO, cast

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
            self._lose("is closed")
        if self.lost is None:
            try:
                self._stream.write(text)
            except OSError as error:
                self._lose(error.strerror or "cannot be written")
        return len(text)

    def flush(self) -> None:
        """Flush, or note why not."""
        if self.lost is None:
            try:
                self._stream.flush()
            except OSError as error:
                self._lose(error.strerror or "cannot be written")

    def _lose(self, reason: str) -> None:
        self.lost = reason
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
