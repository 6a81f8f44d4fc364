"""A table of results in a CSV file that grows row by row and survives being cut off."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Sequence
from dataclasses import fields
from fcntl import LOCK_EX, LOCK_NB, flock
from os import PathLike
from pathlib import Path
from typing import Any, Generic, TypeVar

from pydantic import TypeAdapter

from cellcolor.errors import InputError, system_errors
from cellcolor.files.documents import validate

_R = TypeVar("_R")


def read_table(path: str | PathLike[str], kind: type[_R]) -> list[_R]:
    """The rows of a file; the fields of their dataclass are the columns.

    A last line that does not end was cut off while it was written, and is left out.

    Raises:
        InputError: the file cannot be read, or is no such table.
    """
    try:
        with system_errors(path, "cannot be read"):
            text = Path(path).read_bytes().decode()
    except UnicodeDecodeError as error:
        raise InputError(str(path), None, f"is not text: {error}") from error
    return _rows(text, str(path), kind)


class TableFile(Generic[_R]):
    """A table that is being written; a file that is there is continued.

    Every row is one line, and is handed to the system whole, so that a process that is killed
    leaves a readable file. Nobody else can continue it at the same time.

    Attributes:
        rows: all there are, those of earlier sessions first.

    Raises:
        InputError: the file cannot be used, is another table, or is being written to.
    """

    def __init__(self, path: Path, kind: type[_R]) -> None:
        with system_errors(path, "cannot be written"):
            self._handle = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
        try:
            self.rows = self._begin(str(path), kind)
        except BaseException:
            os.close(self._handle)
            raise

    def _begin(self, path: str, kind: type[_R]) -> list[_R]:
        """The rows that are there, in a file that ends with a whole line."""
        try:
            flock(self._handle, LOCK_EX | LOCK_NB)
        except OSError as error:
            raise InputError(path, None, "is being written by another process") from error
        with os.fdopen(os.dup(self._handle), "rb") as file:
            content = file.read()
        whole = content[: content.rfind(b"\n") + 1]
        header = _line(_columns(kind)).encode()
        if not whole and not header.startswith(content):
            raise InputError(path, "line 1", "is not a table of results")
        try:
            rows = _rows(whole.decode(), path, kind) if whole else []
        except UnicodeDecodeError as error:
            raise InputError(path, None, f"is not text: {error}") from error
        os.ftruncate(self._handle, len(whole))
        if not whole:
            os.write(self._handle, header)
        return rows

    def append(self, row: _R) -> None:
        """Add a row, at once.

        Raises:
            InputError: it cannot be written.
        """
        text = _line([_text(getattr(row, name)) for name in _columns(type(row))])
        line = text.encode(errors="backslashreplace")  # names may have half of a character
        try:
            os.write(self._handle, line)
        except OSError as error:
            raise InputError(None, "output", error.strerror or "cannot be written") from error
        self.rows.append(row)

    def __enter__(self) -> TableFile[_R]:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._handle)


def _columns(kind: type[Any]) -> list[str]:
    return [field.name for field in fields(kind)]


def _line(texts: Sequence[str]) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="\n").writerow(texts)
    return stream.getvalue()


def _text(value: object) -> str:
    """A value in a cell; never more than one line."""
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else " ".join(str(value).split())


def _rows(text: str, path: str, kind: type[_R]) -> list[_R]:
    lines = text.split("\n")[:-1]
    columns = _columns(kind)
    if not lines or next(csv.reader(lines[:1])) != columns:
        raise InputError(path, "line 1", f"is not the header {','.join(columns)}")
    adapter = TypeAdapter(kind)
    found = []
    for number, cells in enumerate(csv.reader(lines[1:]), 2):
        if len(cells) != len(columns):
            message = f"has {len(cells)} cells, the header {len(columns)}"
            raise InputError(path, f"line {number}", message)
        given = {name: cell or None for name, cell in zip(columns, cells, strict=True)}
        try:
            found.append(validate(adapter, given))
        except InputError as error:
            raise InputError(path, f"line {number}: {error.field}", error.message) from error
    return found
