"""Pack the instance library for readers of a paper: graphs, best known bounds, checker, features.

    python benchmarks/library_archive.py [-o ARCHIVE.zip] [--measure S]

Makes ``cellcolor-library-VERSION.zip``. It has each graph as an instance, the stored solutions,
``index.json``, the stand-alone ``check_solution.py`` and ``features.csv``. ``--measure`` solves all
graphs again before, S seconds each with one worker, for the classes of difficulty; otherwise they
are those of the last time. ``instances/README.md`` says what the
features are.
"""

from __future__ import annotations

import argparse
import csv
import io
import time
import zipfile
from datetime import UTC, datetime
from itertools import combinations
from pathlib import Path
from typing import Any

import networkx as nx
from library_entries import INDEX, SOLUTIONS, graph_files, graph_of
from networkx.algorithms.approximation import treewidth_min_degree

from cellcolor.data.instance import Instance
from cellcolor.data.library_index import LibraryIndex
from cellcolor.deadline import Deadline
from cellcolor.machine import this_version
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

VERSION = "1"
"""Of the library: another graph, or another name, makes another version."""
LIBRARY = Path(__file__).parents[1] / "instances"
FEATURES = "features.csv"
CLASSES = (1.0, "easy"), (10.0, "medium"), (60.0, "hard")
"""Processor seconds until the minimum was proved, and what such a graph is called."""


def features(instance: Instance) -> dict[str, Any]:
    """What a graph is like, as far as that may make it hard."""
    dual = nx.Graph()
    dual.add_nodes_from(range(len(instance.cells)))
    sides = [(edge.left, edge.right) for edge in instance.edges if edge.id in instance.live_edges]
    dual.add_edges_from((left, right) for left, right in sides if left != right)
    pairs = joinable = 0
    for loops in instance.live_loops:
        colors = [frozenset(instance.joinable(dart)) for loop in loops for dart in loop]
        pairs += len(colors) * (len(colors) - 1) // 2
        joinable += sum(not one.isdisjoint(other) for one, other in combinations(colors, 2))
    return {
        "cells": len(instance.cells),
        "live_edges": len(instance.live_edges),
        "colors": len(instance.colors),
        "most_darts": max((sum(map(len, own)) for own in instance.live_loops), default=0),
        "most_loops": instance.most_live_loops,
        "joinable_pairs": round(joinable / pairs, 3) if pairs else 1.0,
        "treewidth_at_most": treewidth_min_degree(dual)[0] if len(dual) else 0,
    }


def difficulty(instance: Instance, seconds: float) -> str:
    """The class of a graph: how long its minimum takes here, in the search space ``paper``."""
    begun = time.process_time()
    found = solve(instance, Options(deadline=Deadline.after(seconds), workers=1))
    took = time.process_time() - begun
    if found.status != "optimal":
        return f"open after {seconds:g} s"
    return next((name for limit, name in CLASSES if took <= limit), "very hard")


def measured(seconds: float | None) -> list[dict[str, Any]]:
    """A row for each graph; the classes of last time without seconds."""
    file = LIBRARY / FEATURES
    before = {}
    if file.exists():
        with file.open(encoding="utf-8", newline="") as rows:
            before = {row["name"]: row for row in csv.DictReader(rows)}
    found = []
    for name, path in graph_files(LIBRARY).items():
        instance = graph_of(path)
        row = {"name": name, **features(instance)}
        if seconds is None:
            kept = ("difficulty", "measured_on", "measured_with")
            row |= {member: before.get(name, {}).get(member, "") for member in kept}
        else:
            row["difficulty"] = difficulty(instance, seconds)
            row["measured_on"] = datetime.now(UTC).date().isoformat()
            row["measured_with"] = f"cp-sat, {this_version()}, one worker, {seconds:g} s"
        print(*row.values(), flush=True)
        found.append(row)
    return found


def as_csv(rows: list[dict[str, Any]]) -> str:
    """The table of features."""
    text = io.StringIO()
    table = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    return text.getvalue()


def pack(archive: Path, table: str) -> None:
    """Write the archive; the same files make the same bytes."""
    top = LIBRARY.parent
    files = {
        "README.md": (LIBRARY / "README.md").read_bytes(),
        "LICENSE": (top / "LICENSE").read_bytes(),
        "CITATION.cff": (top / "CITATION.cff").read_bytes(),
        "check_solution.py": (LIBRARY / "check_solution.py").read_bytes(),
        INDEX: (LIBRARY / INDEX).read_bytes(),
        FEATURES: table.encode(),
        "VERSION": f"{VERSION}\n".encode(),
    }
    for name, path in graph_files(LIBRARY).items():
        files[f"graphs/{name}.json"] = graph_of(path).to_json().encode()
    for path in sorted((LIBRARY / SOLUTIONS).glob("*.json")):
        files[f"{SOLUTIONS}/{path.name}"] = path.read_bytes()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, content in files.items():
            packed.writestr(zipfile.ZipInfo(f"cellcolor-library-{VERSION}/{name}"), content)
    print(f"wrote {archive}: {len(LibraryIndex.read(LIBRARY / INDEX).entries)} entries")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("-o", type=Path, default=Path(f"cellcolor-library-{VERSION}.zip"))
    parser.add_argument("--measure", type=float, metavar="S")
    arguments = parser.parse_args()
    table = as_csv(measured(arguments.measure))
    (LIBRARY / FEATURES).write_text(table, encoding="utf-8")
    pack(arguments.o, table)


if __name__ == "__main__":
    main()
