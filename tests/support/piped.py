"""A small surface with plans of it, for commands that read standard input and print an object."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from documents import Document
from meshes import drawn

from cellcolor.data.plan import Plan

RED, BLUE = 0, 1
# Red reaches everything, so one segment is the minimum.
ROW = drawn("AAMMBB AAMMBB AAMMBB", {"A": [RED], "M": [RED, BLUE], "B": [RED]})
BEST = [RED] * 18
WORSE = [RED, RED, BLUE, BLUE, RED, RED] * 3

Capture = pytest.CaptureFixture[str]
Pipe = Callable[[str | bytes], None]


def text(colors: list[int]) -> str:
    return Plan(tuple(colors)).to_json()


def printed(capsys: Capture) -> Document:
    """The one object on standard output."""
    (line,) = capsys.readouterr().out.splitlines()
    document: Document = json.loads(line)
    return document
