"""Which minima of the library the checker verifies: ``python benchmarks/certificates.py``.

Measures, for each family of the library: how many graphs there are, of how many the minimum in the
search space ``paper`` is proved, by which kind of bound the checker, which knows no solver, has
verified that, and what is taken from a solver on trust; and the most choices and seconds of
processor time that it takes to verify the certificates of one solution. docs/measured.md has the
table.
"""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path

from library_entries import INDEX, graph_of, solution_files

from cellcolor.checker.certificates import verify_bound
from cellcolor.checker.groups import regions_of_cells
from cellcolor.data.library_index import LibraryEntry, LibraryIndex
from cellcolor.data.solution import Solution

LIBRARY = Path(__file__).resolve().parents[1] / "instances"


def cost_of(entry: LibraryEntry) -> tuple[int, float]:
    """The most choices, and seconds, of verifying the certificates of one solution of a graph."""
    if entry.file is None:
        return 0, 0.0
    graph, tried, seconds = graph_of(LIBRARY / entry.file), 0, 0.0
    for file in solution_files(LIBRARY, entry.name):
        bounds = Solution.read(file).bounds or ()
        begun, regions = time.process_time(), regions_of_cells(graph)
        verdicts = [verify_bound(graph, bound, regions) for bound in bounds]
        seconds = max(seconds, time.process_time() - begun)
        tried = max([tried, *(one.tried for one in verdicts if one.outcome == "verified")])
    return tried, seconds


def row(family: str, entries: list[LibraryEntry]) -> str:
    """The line of a family."""
    proved = [entry.paper.lower for entry in entries if entry.paper.proved]
    verified = Counter(bound.kind for bound in proved if bound.verified)
    trusted = Counter(bound.kind for bound in proved if not bound.verified)
    cover = verified["strangers"] + verified["cover"]
    others = ", ".join(f"{count} {kind}" for kind, count in sorted(trusted.items())) or "0"
    tried, seconds = (max(values) for values in zip(*map(cost_of, entries), strict=True))
    counts = f"{len(entries)} | {len(proved)} | {cover} | {verified['conflicts']} | {others}"
    return f"| {family} | {counts} | {tried:,} | {seconds:.2f} |"


def main() -> None:
    """Print the table."""
    entries = list(LibraryIndex.read(LIBRARY / INDEX).entries)
    columns = "by cover | by conflicts | on trust | most choices | worst s"
    print(f"| family | graphs | proved | {columns} |\n|---|--:|--:|--:|--:|---|--:|--:|")
    for family in sorted({entry.family for entry in entries}):
        print(row(family, [entry for entry in entries if entry.family == family]), flush=True)
    print(row("all", entries))


if __name__ == "__main__":
    main()
