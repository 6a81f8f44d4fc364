"""The schemes that follow a solution in its file, a line of JSON each."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from typing import ClassVar

from cellcolor.data.solution import Division
from cellcolor.data.value import Value
from cellcolor.errors import InputError
from cellcolor.files.documents import is_json, parse_json, read_text


@dataclass(frozen=True, slots=True)
class SchemeLine(Value):
    """One line of JSON Lines after the solution."""

    FORMAT: ClassVar[str] = "cellcolor/scheme"

    cells: Division


def read_schemes(path: str | PathLike[str]) -> Iterator[Division]:
    """The schemes that follow the solution in a file of JSON Lines; none in any other file.

    Raises:
        InputError: a line is not a scheme; the field names the line.
    """
    head, _, rest = read_text(path).partition("\n")
    if not is_json(head):
        return
    for number, line in enumerate(rest.splitlines(), start=2):
        try:
            body = parse_json(line)
            if body.pop("format", None) != SchemeLine.FORMAT:
                raise InputError(None, "format", f"must be {SchemeLine.FORMAT!r}")
            yield SchemeLine.from_document(body).cells
        except InputError as error:
            field = f"line {number}" + (f", {error.field}" if error.field else "")
            raise InputError(str(path), field, error.message) from error


def scheme_line(division: Division) -> str:
    """One line of JSON Lines for one optimal scheme."""
    document = {"format": SchemeLine.FORMAT} | SchemeLine(division).to_document()
    return json.dumps(document, ensure_ascii=False)
