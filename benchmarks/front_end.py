"""The front end on fine meshes: ``python benchmarks/front_end.py [VERTICES …] [--scenes NAME …]``.

Measures, for shipped scenes with about so many vertices (8000 and 32000): seconds by the wall clock
for building and for the decomposition after it, microseconds of the tests and of continuity for
each candidate, and the largest resident memory of the process, with that of its largest child
added. Each row is a process of its own. docs/measured.md has the table.
"""

from __future__ import annotations

import argparse
import resource
import time
from math import inf

import cellcolor
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend import build_surface
from cellcolor.processes import run_alone

SCENES = ("square", "half_pipe", "wok", "wok_obstacle", "hemisphere_flat", "hemisphere_tilted")
NOT_TESTS = (
    "preparation",
    "inverse kinematics",
    "continuity",
    "validity between vertices",
    "colors and cracks",
)


def measured(name: str, vertices: int) -> str:
    """One row of the table, of this process."""
    scene = cellcolor.read(f"{name}.toml").varied(object={"target_vertices": vertices})
    began = time.perf_counter()
    built = build_surface(scene)
    seconds = time.perf_counter() - began
    began = time.perf_counter()
    cells = len(decomposition_of(built.surface).instance.cells)
    after = time.perf_counter() - began
    stages, candidates = built.report.seconds, built.reasons.size
    tests = sum(took for stage, took in stages.items() if stage not in NOT_TESTS)
    links = stages["continuity"] + stages["validity between vertices"]
    used = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    memory = sum(resource.getrusage(who).ru_maxrss for who in used) / 2**20
    numbers = f"{len(built.surface.vertices):,} | {cells} | {seconds:.1f} | {after:.1f}"
    each = f"{1e6 * tests / candidates:.1f} | {1e6 * links / candidates:.1f}"
    return f"| {name} | {numbers} | {each} | {memory:.2f} |"


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("vertices", nargs="*", type=int, default=[8_000, 32_000])
    parser.add_argument("--scenes", nargs="+", default=SCENES, metavar="NAME")
    asked = parser.parse_args()
    print(
        "| scene | vertices | cells | build, s | decomposition, s | tests, µs | links, µs | GiB |"
    )
    print("|---|--:|--:|--:|--:|--:|--:|--:|", flush=True)
    for vertices in asked.vertices:
        for name in asked.scenes:
            ended = run_alone(measured, (name, vertices), inf, inf)
            print(ended.value or f"| {name} | {ended.error} |", flush=True)


if __name__ == "__main__":
    from front_end import measured  # by the name that other processes can import

    main()
