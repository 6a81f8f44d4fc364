"""Compare the encodings on files and families: ``encodings.py [--limit S] [--workers N …]``.

Prints a table in Markdown, with the load of the machine before and after: for every solver and
number of workers the seconds of processor time that a proof took, building the model included, or
``bound..best`` where the limit, in seconds of the clock, came first. Every solve is a process of
its own, that has imported the solver before it is measured. docs/encodings.md has the results.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from itertools import product
from pathlib import Path

from cellcolor.data.cells_and_edges import Cell
from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import hub_grid
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

INSTANCES = Path(__file__).resolve().parents[1] / "instances"


def stored(name: str) -> Instance:
    """An instance or a labelled surface of the library."""
    path = INSTANCES / name
    if name.endswith(".surface.json"):
        return decompose(LabelledSurface.read(path))
    return Instance.read(path)


FILES: dict[str, Callable[[], Instance]] = {
    "half_pipe_b_500": partial(stored, "scenes/feasibility/half_pipe_b_500.surface.json"),
    "hemisphere_flat_2000": partial(stored, "scenes/feasibility/hemisphere_flat_2000.surface.json"),
    "wok_obstacle_2000": partial(stored, "scenes/feasibility/wok_obstacle_2000.surface.json"),
    "blobs_0": partial(stored, "random/blobs_0.surface.json"),
    "blobs_1": partial(stored, "random/blobs_1.surface.json"),
    "blobs_3": partial(stored, "random/blobs_3.surface.json"),
    "hub_24": partial(stored, "random/hub_24.json"),
    "hub_44": partial(stored, "random/hub_44.json"),
    "2 × 2 hubs": partial(hub_grid, 0, 2, 2, 4),
    "3 × 3 hubs": partial(hub_grid, 0, 3, 3, 4),
}
"""The files of docs/benchmarks.md whose cells have one live loop each, and grids of hubs."""

ENCODINGS = ("cp-sat-pointers", "cp-sat-ranks", "cp-sat-contour")
OTHERS = (("choco", 1), ("cp-sat-model", 8), ("cp-sat", 8))
"""With their workers. The last two are this package's own: its full model, and all of it."""


def processor_seconds() -> float:
    """Of this process and of those that it has waited for."""
    used = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


def one(name: str, solver: str, workers: int, limit: float) -> str:
    """What a table shows of one solve."""
    instance = FILES[name]()
    nothing = Instance("warm-up", ("any",), (Cell(0, (0,), ()),), ())
    solve(nothing, Options(), solver)
    before = processor_seconds()
    solution = solve(instance, Options(deadline=Deadline.after(limit), workers=workers), solver)
    if solution.status == "optimal":
        return f"{processor_seconds() - before:.2f}"
    return f"{solution.lower_bound}..{'?' if solution.segments is None else solution.segments}"


def main() -> None:
    """Run everything, one solve at a time."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--limit", type=float, default=10.0)
    parser.add_argument("--files", nargs="*", default=list(FILES), choices=list(FILES))
    parser.add_argument("--workers", type=int, nargs="*", default=[1, 2, 8])
    parser.add_argument("--one", nargs=3, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.one:
        name, solver, workers = asked.one
        print(json.dumps(one(name, solver, int(workers), asked.limit)))
        return
    print("load before:", *(f"{load:.1f}" for load in os.getloadavg()))
    runs = [*product(ENCODINGS, asked.workers), *OTHERS]
    titles = [f"{solver.removeprefix('cp-sat-')} {workers}" for solver, workers in runs]
    print("| file | cells | darts |", " | ".join(titles), "|")
    print("|---" * (3 + len(runs)) + "|")
    for name in asked.files:
        instance = FILES[name]()
        row = [name, str(len(instance.cells)), str(instance.most_live_darts)]
        for solver, workers in runs:
            command = [sys.executable, __file__, "--limit", str(asked.limit)]
            command += ["--one", name, solver, str(workers)]
            done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
            row.append(json.loads(done.stdout) if done.returncode == 0 else "failed")
        print("|", " | ".join(row), "|", flush=True)
    print("load after:", *(f"{load:.1f}" for load in os.getloadavg()))


if __name__ == "__main__":
    main()
