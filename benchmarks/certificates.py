"""How many minima carry a certificate that verifies: ``python benchmarks/certificates.py``.

    python benchmarks/certificates.py [GROUP …] [--seeds 10] [--limit 5]

Solves groups of graphs in the search space ``paper`` and hands every solution that is optimal to
the checker, which knows no solver. Measures, for each group, by which kind of bound minima were
verified, what is taken from the solver on trust, and the choices and the seconds of processor time
that the checker took. docs/measured.md has the table.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import cellcolor
from cellcolor.checker.certificates import BoundVerdict, verify_bound
from cellcolor.checker.color_regions import regions_of_cells
from cellcolor.data.instance import Instance
from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.errors import InputError
from cellcolor.lab.families import LARGE, MEDIUM, hub, hub_grid
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

INSTANCES = Path(__file__).resolve().parents[1] / "instances"

Named = Iterator[tuple[str, Instance]]


def built(folder: str, raw: bool) -> Named:
    """Graphs of scenes, built anew, with the setup's sliver policy or without."""
    for file in sorted((INSTANCES / folder).glob("*.toml")):
        scene = cellcolor.read(file)
        if raw:
            scene = scene.with_setup(scene.setup.varied(slivers=None))
        try:
            yield file.stem, decompose(cellcolor.build(scene).surface)
        except InputError as error:  # what the front end refuses is no graph
            print(f"{file.stem}: {error}", file=sys.stderr)


def stored(*patterns: str) -> Named:
    """Graphs and surfaces that are files of the library; of a graph and its surface the graph."""
    found = {file for pattern in patterns for file in INSTANCES.glob(pattern)}
    for file in sorted(found):
        if file.with_name(file.name.replace(".surface.json", ".json")) not in found - {file}:
            yield file.name, cellcolor.decompose(file)


def family(make: Callable[[int], Instance | LabelledSurface], seeds: int) -> Named:
    """The first seeds of a random family."""
    for seed in range(seeds):
        made = make(seed)
        yield str(seed), made if isinstance(made, Instance) else decompose(made)


GROUPS: dict[str, Callable[[int], Named]] = {
    "scenes": lambda _: built("scenes", raw=False),
    "scenes, raw": lambda _: built("scenes", raw=True),
    "real parts": lambda _: built("parts", raw=False),
    "real parts, raw": lambda _: built("parts", raw=True),
    "paper and random files": lambda _: stored("paper/*.json", "random/*.json"),
    "blobs": lambda n: family(MEDIUM["blobs"], n),
    "blobs, 64 × 64 points": lambda n: family(MEDIUM["64 × 64 points, 10 colors"], n),
    "rim": lambda n: family(MEDIUM["rim"], n),
    "thin bands": lambda n: family(MEDIUM["thin"], n),
    "hubs, 6 leaf cells and more": lambda n: family(lambda seed: hub(seed, 6 + seed, 4), n),
    "grids of hubs": lambda n: family(
        lambda seed: hub_grid(seed, 2, 2 + seed % 3, 4, 2 + seed % 2), n
    ),
    "tori": lambda n: family(LARGE["torus"], n),
    "double tori": lambda n: family(LARGE["double torus"], n),
    "random parts": lambda n: family(LARGE["parts"], n),
    "patches": lambda n: family(LARGE["patches"], n),
}


def verdict_on(instance: Instance, solution: Solution) -> tuple[BoundVerdict, float]:
    """What the checker says of the bounds that prove a minimum, at best, and its seconds."""
    begun = time.process_time()
    regions = regions_of_cells(instance)
    proving = [bound for bound in solution.bounds or () if bound.value == solution.segments]
    verdicts = [verify_bound(instance, bound, regions) for bound in proving]
    verified = [verdict for verdict in verdicts if verdict.outcome == "verified"]
    return (verified or verdicts)[0], time.process_time() - begun


def row(name: str, graphs: Named, limit: float) -> str:
    """The line of a group."""
    number, verified, trusted = 0, Counter[str](), Counter[str]()
    tried, seconds = [0], [0.0]
    for label, graph in graphs:
        number += 1
        solution = solve(graph, Options(deadline=Deadline.after(limit)))
        if solution.status != "optimal":
            continue
        verdict, took = verdict_on(graph, solution)
        if verdict.outcome == "verified":
            verified[verdict.bound.kind] += 1
            tried.append(verdict.tried)
            seconds.append(took)
        else:
            trusted[verdict.bound.kind] += 1
            print(f"{name}, {label}: {verdict}", file=sys.stderr, flush=True)
    cover = verified["strangers"] + verified["cover"]
    others = ", ".join(f"{count} {kind}" for kind, count in sorted(trusted.items())) or "0"
    counts = f"{number} | {verified.total() + trusted.total()} | {cover} | {verified['conflicts']}"
    return f"| {name} | {counts} | {others} | {max(tried):,} | {max(seconds):.2f} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}")
    parser.add_argument("--seeds", type=int, default=10, help="of each random family")
    parser.add_argument("--limit", type=float, default=5.0, help="seconds for each graph")
    asked = parser.parse_args()
    columns = "by cover | by conflicts | by the solver alone | most choices | worst s"
    print(f"| group | graphs | proved | {columns} |")
    print("|---|--:|--:|--:|--:|---|--:|--:|")
    for name in asked.groups or GROUPS:
        print(row(name, GROUPS[name](asked.seeds), asked.limit), flush=True)


if __name__ == "__main__":
    main()
