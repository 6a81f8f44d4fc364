"""Running the commands in this process."""

from __future__ import annotations

import json

from documents import Document

from cellcolor.cli import main


def run(*arguments: object) -> int:
    return main([str(argument) for argument in arguments])


def json_lines(text: str) -> list[Document]:
    return [json.loads(line) for line in text.splitlines()]
