"""Standard input in the place of a file."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cellcolor.errors import InputError

STANDARD_INPUT = "-"
_NAME = "standard input"


@contextmanager
def input_file(given: str) -> Iterator[Path]:
    """The file that a command was given, standard input having been copied into one.

    Files are read more than once, which a pipe cannot be. What is wrong with the copy is said of
    standard input.

    Args:
        given: the file's name, or ``-``; a file of that name is ``./-``.
    """
    if given != STANDARD_INPUT:
        yield Path(given)
        return
    with tempfile.TemporaryDirectory(prefix="cellcolor-") as folder:
        copy = Path(folder) / _NAME
        try:
            copy.write_bytes(b"" if sys.stdin is None else sys.stdin.buffer.read())
        except OSError as error:
            raise InputError(_NAME, None, error.strerror or "cannot be read") from error
        try:
            yield copy
        except InputError as error:
            if error.file != str(copy):
                raise
            raise error.in_file(_NAME) from error


def name_of(given: str) -> str:
    """What a file that a command was given is called in messages."""
    return _NAME if given == STANDARD_INPUT else given
