"""A table of runs in a CSV file that grows row by row and survives being cut off."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Sequence
from dataclasses import fields
from fcntl import LOCK_EX, LOCK_NB, flock
from os import PathLike
from pathlib import Path

from cellcolor.data.value import adapter_of
from cellcolor.errors import InputError, system_errors
from cellcolor.files.documents import validate
from cellcolor.lab.runs.row import Row

_COLUMNS = [field.name for field in fields(Row)]


def read_table(path: str | PathLike[str]) -> list[Row]:
    """The rows of a file.

    A last line that does not end was cut off while it was written, and is left out.

    Raises:
        InputError: the file cannot be read, or is no such table.
    """
    with system_errors(path, "cannot be read"):
        return _rows(Path(path).read_bytes(), str(path))


class TableFile:
    """A table that is being written; a file that is there is continued.

    Every row is one line, and is handed to the system whole, so that a process that is killed
    leaves a readable file. Nobody else can continue it at the same time.

    Attributes:
        rows: all there are, those of earlier sessions first.

    Raises:
        InputError: the file cannot be used, is another table, or is being written to.
    """

    def __init__(self, path: Path) -> None:
        with system_errors(path, "cannot be written"):
            self._handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            self.rows = self._begin(path)
        except BaseException:
            os.close(self._handle)
            raise

    def _begin(self, path: Path) -> list[Row]:
        """The rows that are there, in a file that ends with a whole line."""
        try:
            flock(self._handle, LOCK_EX | LOCK_NB)
        except OSError as error:
            raise InputError(str(path), None, "is being written by another process") from error
        content, header = path.read_bytes(), _line(_COLUMNS)
        if header.startswith(content):  # empty, or cut off in its first line
            os.ftruncate(self._handle, 0)
            os.write(self._handle, header)
            return []
        rows = _rows(content, str(path))
        os.ftruncate(self._handle, content.rfind(b"\n") + 1)
        return rows

    def append(self, row: Row) -> None:
        """Add a row, at once.

        Raises:
            InputError: it cannot be written.
        """
        line = _line([_text(getattr(row, name)) for name in _COLUMNS])
        try:
            os.write(self._handle, line)
        except OSError as error:
            raise InputError(None, "output", error.strerror or "cannot be written") from error
        self.rows.append(row)

    def __enter__(self) -> TableFile:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._handle)


def _line(cells: Sequence[str]) -> bytes:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerow(cells)
    return stream.getvalue().encode(errors="backslashreplace")  # names may have half a character


def _text(value: object) -> str:
    """A value in a cell; never more than one line."""
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else " ".join(str(value).split())


def _rows(content: bytes, path: str) -> list[Row]:
    try:
        lines = content[: content.rfind(b"\n") + 1].decode().split("\n")[:-1]
    except UnicodeDecodeError as error:
        raise InputError(path, None, f"is not text: {error}") from error
    if not lines or next(csv.reader(lines[:1])) != _COLUMNS:
        raise InputError(path, "line 1", f"is not the header {','.join(_COLUMNS)}")
    found = []
    for number, cells in enumerate(csv.reader(lines[1:]), 2):
        if len(cells) != len(_COLUMNS):
            message = f"has {len(cells)} cells, the header {len(_COLUMNS)}"
            raise InputError(path, f"line {number}", message)
        given = {name: cell or None for name, cell in zip(_COLUMNS, cells, strict=True)}
        try:
            found.append(validate(adapter_of(Row), given))
        except InputError as error:
            raise InputError(path, f"line {number}: {error.field}", error.message) from error
    return found
