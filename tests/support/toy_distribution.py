"""Following a guide that adds to the front end: its files, an installation, and a run."""

from __future__ import annotations

import os
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from guides import ROOT, blocks, follow


@contextmanager
def followed(guide: str, folder: Path, *, run: bool = True) -> Iterator[dict[str, Any]]:
    """Do what the guide ``docs/how-to/GUIDE.md`` says, in an empty folder beside ``models``.

    A block that a file's name introduces is written to that file; entry points of
    ``pyproject.toml`` are found afterwards as if the distribution had been installed; what is left
    of the Python is run, unless only the files are wanted.

    Yields:
        the names that the run left behind.
    """
    (folder / "models").symlink_to(ROOT / "models")
    code = ""
    for block in blocks(guide):
        if block.introduced.startswith("`"):
            follow(block, folder)
        elif block.language == "python":
            code += block.text
    _install(folder)
    with _in(folder):
        names: dict[str, Any] = {}
        try:
            if run:
                exec(compile(code, f"{guide}.md", "exec"), names)
            yield names
        finally:
            for file in folder.glob("*.py"):
                sys.modules.pop(file.stem, None)


def _install(folder: Path) -> None:
    """What an installation leaves of a project: its metadata."""
    groups = tomllib.loads((folder / "pyproject.toml").read_text())["project"]["entry-points"]
    metadata = folder / "toy-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: toy\nVersion: 1.0\n")
    lines = []
    for group, points in groups.items():
        lines += [f"[{group}]", *(f"{name} = {value}" for name, value in points.items())]
    (metadata / "entry_points.txt").write_text("\n".join(lines) + "\n")


@contextmanager
def _in(folder: Path) -> Iterator[None]:
    """Working directory and module path."""
    before = Path.cwd()
    os.chdir(folder)
    sys.path.insert(0, str(folder))
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        os.chdir(before)
