"""Random patches and large blobs: what is left between the best division and the bound.

    python benchmarks/patches.py [KIND …] [--count 10] [--limit 10]

Solves seeds 0, 1, … of each kind one after the other in this process, in the search space paper,
and prints a row of a Markdown table for each kind.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable
from functools import partial
from statistics import median
from typing import Any

from cellcolor.data.bounds import greatest
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import blobs, voronoi
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

MANY_COLORS: dict[str, Any] = {"colors": 30, "scattered": True, "coverage": (0.2, 0.4)}
KINDS: dict[str, Callable[[int], LabelledSurface]] = {
    "disc": partial(voronoi, shape="disc", size=24, regions=78, **MANY_COLORS),
    "overlapping": partial(voronoi, shape="disc", size=24, regions=78, colors=20, scattered=True),
    "sphere": partial(voronoi, shape="sphere", size=16, regions=42, **MANY_COLORS),
    "torus": partial(voronoi, shape="torus", size=16, regions=34, **MANY_COLORS),
    "blobs": partial(blobs, size=96, colors=12, waves=3.0),
}


def row(kind: str, count: int, limit: float) -> list[str]:
    """One row of the table."""
    instances = [decompose(KINDS[kind](seed)) for seed in range(count)]
    cells = [len(instance.cells) for instance in instances]
    found = []
    for instance in instances:
        solution = solve(instance, Options(deadline=Deadline.after(limit)))
        bound = greatest(solution.bounds or (), "strands")
        found.append((solution.segments or 0, bound, solution.seconds))
    best, bounds, seconds = zip(*found, strict=True)
    gaps = [one - other for one, other in zip(best, bounds, strict=True)]
    proved = str(gaps.count(0))
    range_of_cells = f"{min(cells)} to {max(cells)}"
    totals = [str(sum(numbers)) for numbers in (best, bounds, gaps)]
    return [kind, range_of_cells, str(count), proved, *totals, f"{median(seconds):.1f}"]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("kinds", nargs="*", metavar="KIND", help=f"of {', '.join(KINDS)}")
    parser.add_argument("--count", type=int, default=10, help="seeds of each kind")
    parser.add_argument("--limit", type=float, default=10.0, help="seconds for each")
    arguments = parser.parse_args()
    load = os.getloadavg()[0]
    print("| kind | cells | of | proved | segments | at least | gaps | median s |")
    print("|---|---|---|---|---|---|---|---|")
    for kind in arguments.kinds or KINDS:
        print(f"| {' | '.join(row(kind, arguments.count, arguments.limit))} |", flush=True)
    print(f"\nLoad {load:.1f} before, {os.getloadavg()[0]:.1f} after.")


if __name__ == "__main__":
    main()
