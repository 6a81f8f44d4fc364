"""Measure what docs/benchmarks.md reports: ``python benchmarks/run.py [TABLE …]``.

Prints each table as Markdown, with the date and the load of the machine before and after it.
Every run is a process of its own. ``--repeat`` is how often a whole command is run; its median is
printed.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import UTC, datetime
from itertools import count
from math import radians
from pathlib import Path
from statistics import median

from cellcolor.data.instance import Instance
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.lab.families import MEDIUM, blobs, hub, hub_grid
from cellcolor.lab.races import Run, measure
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

ROOT = Path(__file__).resolve().parents[1]
SCENES = sorted((ROOT / "instances/scenes/feasibility").glob("*.surface.json"))
BLOBS = sorted((ROOT / "instances/random").glob("blobs_*.surface.json"))
HUBS = sorted((ROOT / "instances/random").glob("hub_*.json"))

BLOB_SEEDS = 40
BLOB_CELLS = range(30, 49)
BLOB_LIMIT = 60.0
DISPLACED_SEEDS = 12
FAMILY_SEEDS = 60
FAMILY_LIMIT = 10.0
GRIDS = ((2, 2, 3), (3, 3, 2), (3, 3, 3), (4, 4, 2), (5, 5, 2), (4, 4, 3), (6, 6, 2))
GRID_COLORS = 4
GRID_LIMIT = 60.0
SPEED_UP_CELLS = range(4, 40, 3)
SPEED_UP_SEEDS = 400
SPEED_UP_PETALS = range(6, 31, 3)
SPEED_UP_EACH = 3
SPEED_UP_LIMIT = 60.0
ABLATION_LIMIT = 10.0

Rows = Iterator[list[str]]


def whole_command(file: Path, space: str, repeat: int) -> list[str]:
    """Cells, most live darts, answer, and the medians of whole command and solving alone."""
    command = [sys.executable, "-m", "cellcolor", "solve", str(file), "--json"]
    command += ["--search-space", space, "--time-limit", "60"]
    wholes, solves = [], []
    for _ in range(repeat):
        started = time.perf_counter()
        done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
        wholes.append(time.perf_counter() - started)
        solution = json.loads(done.stdout)
        solves.append(solution["seconds"])
    graph = read(file)
    sizes = [str(len(graph.cells)), str(graph.most_live_darts)]
    answer = f"{solution['segments']} ({solution['status']})"
    whole, alone = median(wholes), median(solves)
    return [*sizes, answer, f"{whole:.2f}", f"{alone:.2f}", f"{max(solves):.2f}"]


def read(file: Path) -> Instance:
    """The graph of an instance or of a labelled surface."""
    if file.name.endswith(".surface.json"):
        return decompose(LabelledSurface.read(file))
    return Instance.read(file)


def graph_of(made: Instance | LabelledSurface) -> Instance:
    """The graph of what a family made."""
    return made if isinstance(made, Instance) else decompose(made)


def scenes(repeat: int) -> Rows:
    """Surfaces of robot scenes, whole command."""
    yield ["file", "space", "cells", "darts", "segments", "whole s", "solve s", "worst solve s"]
    for file in SCENES:
        for space in ("paper", "surface"):
            name = file.name.removesuffix(".surface.json")
            yield [name, space, *whole_command(file, space, repeat)]


def stored(repeat: int) -> Rows:
    """Stored random instances in the search space paper, whole command."""
    yield ["file", "cells", "darts", "segments", "whole s", "solve s", "worst solve s"]
    for file in BLOBS + HUBS:
        yield [file.name.partition(".")[0], *whole_command(file, "paper", repeat)]


def seeds(_: int) -> Rows:
    """Further seeds of families.blobs, 24 × 24 points, 6 colors, 30 to 48 cells: solving alone."""
    yield ["seeds", "proved", "in 3 s", "in 10 s", "median s", "90 % s", "worst s", "worst seed"]
    found: list[tuple[float, int, bool]] = []
    for seed in count(1000):
        instance = decompose(blobs(seed))
        if len(instance.cells) in BLOB_CELLS:
            run = measure(instance, "cp-sat", BLOB_LIMIT)
            spent = BLOB_LIMIT if run.seconds is None else run.seconds
            found.append((spent, seed, run.optimal))
        if len(found) == BLOB_SEEDS:
            break
    found.sort()
    within = [sum(done and spent <= limit for spent, _, done in found) for limit in (3, 10)]
    yield [
        f"{BLOB_SEEDS} from 1000 to {max(seed for _, seed, _ in found)}",
        str(sum(done for _, _, done in found)),
        *(f"{100 * share / BLOB_SEEDS:.1f} %" for share in within),
        f"{median(spent for spent, _, _ in found):.2f}",
        f"{found[round(0.9 * BLOB_SEEDS) - 1][0]:.2f}",
        f"{found[-1][0]:.2f}",
        str(found[-1][1]),
    ]


def displaced(_: int) -> Rows:
    """Our six scenes without sliver policy, displaced at random, 2000 vertices: solving alone."""
    import experiments

    yield ["scene", "cells", "space", "of", "proved for any division", "median s", "worst s"]
    # Far beyond what a fixture would allow: these are other scenes.
    experiments.SHIFT_M, experiments.TURN_RAD = 0.04, radians(12)
    for name in experiments.NAMES:
        instances = []
        for seed in range(1, DISPLACED_SEEDS + 1):
            with tempfile.TemporaryDirectory() as folder:
                built = experiments.build(name, 2000, seed, raw=True, folder=Path(folder))
            instances.append(decompose(built.surface))
        cells = [len(instance.cells) for instance in instances]
        for space, strands in (("paper", 1), ("surface", 2)):
            options = Options(search_space=space, strands=strands)
            yield [name, f"{min(cells)} to {max(cells)}", space, *solve_all(instances, options)]


def families(_: int) -> Rows:
    """Random families, mostly on 24 × 24 points, in the search space paper: solving alone."""
    yield ["family", "cells", "of", "proved for any division", "median s", "worst s"]
    for name, make in MEDIUM.items():
        instances = [graph_of(make(seed)) for seed in range(FAMILY_SEEDS)]
        cells = [len(instance.cells) for instance in instances]
        found = solve_all(instances, Options())
        yield [name, f"{min(cells)} to {max(cells)}", *found]


def solve_all(instances: list[Instance], options: Options) -> list[str]:
    """How many, how many proved, seconds: one run each, all in this process."""
    solve(instances[0], options)  # imports
    proved, seconds = 0, []
    for instance in instances:
        found = solve(instance, replace(options, deadline=Deadline.after(FAMILY_LIMIT)))
        proved += found.proved_for_surface
        seconds.append(found.seconds)
    return [str(len(instances)), str(proved), f"{median(seconds):.2f}", f"{max(seconds):.2f}"]


def grids(_: int) -> Rows:
    """Grids of hubs: CP-SAT and clingo on the same instances, solving alone."""
    yield ["hubs × petals a side", "cells", "darts", "minimum", "cp-sat s", "clingo s"]
    for rows, columns, side in GRIDS:
        instance = hub_grid(0, rows, columns, GRID_COLORS, side)
        runs = [measure(instance, solver, GRID_LIMIT) for solver in ("cp-sat", "clingo")]
        proved = {run.segments for run in runs if run.optimal}
        assert len(proved) < 2, (instance.name, proved)
        minimum = str(proved.pop()) if proved else "open"
        sizes = [str(len(instance.cells)), str(instance.most_live_darts)]
        yield [f"{rows} × {columns} × {side}", *sizes, minimum, *map(spent, runs)]


def blob_speed_up(_: int) -> Rows:
    """The reference solver against CP-SAT on blobs of growing size, solving alone."""
    by_cells: dict[int, list[Instance]] = {cells: [] for cells in SPEED_UP_CELLS}
    for seed in range(SPEED_UP_SEEDS):
        instance = decompose(blobs(seed, colors=2 + seed % 5, waves=0.4 + 0.1 * (seed % 4)))
        if len(instance.cells) in by_cells:
            by_cells[len(instance.cells)].append(instance)
    yield from _speed_up(by_cells)


def hub_speed_up(_: int) -> Rows:
    """The reference solver against CP-SAT on hubs of growing size, solving alone."""
    seeds = range(SPEED_UP_EACH)
    yield from _speed_up({n + 1: [hub(seed, n, 4) for seed in seeds] for n in SPEED_UP_PETALS})


def _speed_up(by_cells: dict[int, list[Instance]]) -> Rows:
    """Rows until the reference solver does not finish most instances of a size."""
    yield ["cells", "darts", "dfs s", "cp-sat s", "ratio"]
    for cells, found in by_cells.items():
        rows = [_compare(instance) for instance in found[:SPEED_UP_EACH]]
        yield [
            str(cells),
            ", ".join(str(darts) for darts, _, _ in rows),
            ", ".join(spent(slow) for _, slow, _ in rows),
            ", ".join(spent(fast) for _, _, fast in rows),
            ", ".join(_ratio(slow, fast) for _, slow, fast in rows),
        ]
        if sum(slow.optimal for _, slow, _ in rows) < len(rows) / 2:
            return


def _compare(instance: Instance) -> tuple[int, Run, Run]:
    slow, fast = (measure(instance, solver, SPEED_UP_LIMIT) for solver in ("dfs", "cp-sat"))
    return instance.most_live_darts, slow, fast


def _ratio(slow: Run, fast: Run) -> str:
    if slow.seconds is None or not fast.seconds or not fast.optimal:
        return "?"
    return f"{'' if slow.optimal else '> '}{slow.seconds / fast.seconds:.3g}"


def spent(run: Run) -> str:
    """Seconds of a run that came to its end; of the others that they did not."""
    if run.optimal and run.seconds is not None:
        return f"{run.seconds:.2f}"
    return f"> {run.seconds:.0f}" if run.seconds is not None else "gave no answer"


def ablation(_: int) -> Rows:
    """The full model alone, without a first division, less one redundant group at a time."""
    from ablation import variants

    names = list(variants())
    yield ["instance", *names]
    subjects = [HUBS[0], BLOBS[0], BLOBS[2], SCENES[-1]]
    with tempfile.TemporaryDirectory() as folder:
        grid = Path(folder) / "hub_grid_2x2x3.json"
        grid.write_text(hub_grid(0, 2, 2, GRID_COLORS, 3).to_json(), encoding="utf-8")
        for file in [*subjects, grid]:
            cells = []
            for name in names:
                script = [sys.executable, str(ROOT / "benchmarks/ablation.py"), str(file)]
                done = subprocess.run(
                    [*script, name, str(ABLATION_LIMIT)],
                    capture_output=True,
                    encoding="utf-8",
                    check=True,
                )
                cells.append(done.stdout.strip())
            yield [file.name.partition(".")[0], *cells]


TABLES: dict[str, Callable[[int], Rows]] = {
    "scenes": scenes,
    "stored": stored,
    "seeds": seeds,
    "displaced": displaced,
    "families": families,
    "grids": grids,
    "speed-up-blobs": blob_speed_up,
    "speed-up-hubs": hub_speed_up,
    "ablation": ablation,
}


def main() -> None:
    """Print the tables that were asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", nargs="*", metavar="TABLE", help=f"of {', '.join(TABLES)}")
    parser.add_argument("--repeat", type=int, default=5)
    arguments = parser.parse_args()
    for name in arguments.tables or TABLES:
        make = TABLES[name]
        load = os.getloadavg()[0]
        print(f"\n## {name}: {(make.__doc__ or '').strip()}\n")
        for number, row in enumerate(make(arguments.repeat)):
            print(f"| {' | '.join(row)} |", flush=True)
            if number == 0:
                print("|---" * len(row) + "|", flush=True)
        after = os.getloadavg()[0]
        print(f"\n{datetime.now(UTC):%Y-%m-%d %H:%M} UTC, {os.cpu_count()} cores, ", end="")
        print(f"load {load:.1f} before, {after:.1f} after", flush=True)


if __name__ == "__main__":
    main()
