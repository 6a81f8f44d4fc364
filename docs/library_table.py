"""The table of docs/library.md, with a small picture of each graph: made while the site is built.

    python docs/library_table.py

writes them into ``docs/_library``, as ``docs/conf.py`` does.
"""

from __future__ import annotations

import sys
from pathlib import Path

from cellcolor.data.library_index import KnownRange, LibraryEntry, LibraryIndex

sys.path += [str(Path(__file__).parent), str(Path(__file__).parents[1] / "benchmarks")]
from library_entries import INDEX, graph_of
from thumbnail import thumbnail

LIBRARY = Path(__file__).parents[1] / "instances"
FOLDER = Path(__file__).parent / "_library"
TABLE = "table.txt"
HEAD = ("", "graph", "family", "cells", "darts", "loops", "colors", "paper", "any division")
HEAD += ("verified", "found by")


def write_table(library: Path, folder: Path) -> None:
    """Write the table of a library's graphs, and the pictures that are not there yet."""
    folder.mkdir(exist_ok=True)
    rows = []
    for entry in LibraryIndex.read(library / INDEX).entries:
        picture = folder / f"{entry.name}-{entry.fingerprint[:12]}.svg"
        if entry.file is not None and not picture.exists():
            picture.write_text(thumbnail(graph_of(library / entry.file)), encoding="utf-8")
        shown = "" if entry.file is None else f"![]({folder.name}/{picture.name})"
        rows.append(f"| {' | '.join([shown, *_row(entry)])} |")
    lines = [f"| {' | '.join(HEAD)} |", "|---|---|---" + "|--:" * 6 + "|---|---|", *rows]
    text = "\n".join(lines) + "\n"
    table = folder / TABLE
    if not table.exists() or table.read_text(encoding="utf-8") != text:
        table.write_text(text, encoding="utf-8")


def _row(entry: LibraryEntry) -> list[str]:
    lower = entry.surface.lower
    numbers = (entry.cells, entry.darts, entry.loops, entry.colors)
    return [
        f"`{entry.name}`",
        entry.family,
        *map(str, numbers),
        _span(entry.paper),
        _span(entry.surface),
        lower.kind if lower.verified else "",
        _found(entry.paper),
    ]


def _span(known: KnownRange) -> str:
    """The range of the minimum, in bold where it is open."""
    return str(known) if known.proved else f"**{known}**"


def _found(known: KnownRange) -> str:
    """Who proved the minimum, or who found the division where it is open."""
    return (known.lower if known.upper is None or known.proved else known.upper).solver


if __name__ == "__main__":
    write_table(LIBRARY, FOLDER)
