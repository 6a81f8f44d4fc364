"""The front end on fine meshes: ``python benchmarks/frontend_scale.py [LEVEL …]``.

Three scenes with the UR5 setup: the wok, a free-form part (``instances/parts/blend``), and the same
part as a scanner sees it, every vertex off by 0.1 mm along its normal (normal distribution). The
free-form part has about 2,000 vertices at level 0; each level has four times as many and is
smoother (Loop's scheme). Levels 1 to 3 are the default, 8,000 to 125,000 vertices.

Each line is a process of its own: seconds by the wall clock for building and for the decomposition
after it, seconds of the slowest stages, and the largest resident memory, with that of the largest
child process added. The last column is the surface's fingerprint, so that two versions can be
compared.
"""

from __future__ import annotations

import argparse
import resource
import sys
import time
from math import inf
from pathlib import Path

import numpy as np
import trimesh

from cellcolor.decomposition import decomposition_of
from cellcolor.frontend import Scene, build_surface
from cellcolor.processes import Limits, run_alone

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP / "benchmarks" / "parts"))

from shapes import blend  # noqa: E402

KINDS = ("wok", "free-form", "scan")
NOISE_M = 1e-4


def scene_of(kind: str, level: int) -> Scene:
    """A scene with about 2,000 times 4^level vertices."""
    if kind == "wok":
        wok = Scene.read(TOP / "instances" / "scenes" / "wok.toml")
        return wok.varied(object={"target_vertices": 2_000 * 4**level})
    vertices, faces = blend(7.8)
    mesh = trimesh.Trimesh(vertices / 1000, faces, process=False)
    if level:
        mesh = mesh.subdivide_loop(level)
    points = mesh.vertices
    if kind == "scan":
        off = np.random.default_rng(0).normal(0, NOISE_M, len(points))
        points = points + off[:, None] * mesh.vertex_normals
    part = trimesh.Trimesh(points, mesh.faces, process=False)
    return Scene.read(TOP / "instances" / "parts" / "blend.toml").with_object(part)


def measured(kind: str, level: int) -> str:
    """One line of the table, of this process."""
    scene = scene_of(kind, level)
    started = time.perf_counter()
    built = build_surface(scene)
    seconds = time.perf_counter() - started
    started = time.perf_counter()
    cells = len(decomposition_of(built.surface).instance.cells)
    after = time.perf_counter() - started
    stages = sorted(built.surface.meta["seconds"].items(), key=lambda item: -item[1])[:4]
    slowest = ", ".join(f"{name} {value:.1f}" for name, value in stages)
    used = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    memory = sum(resource.getrusage(who).ru_maxrss for who in used) / 2**20
    numbers = f"{len(built.surface.vertices):,} | {cells} | {seconds:.1f} | {after:.1f}"
    return f"| {kind} | {numbers} | {memory:.2f} | {slowest} | {built.surface.sha256[:8]} |"


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("levels", nargs="*", type=int, default=[1, 2, 3], metavar="LEVEL")
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS)
    arguments = parser.parse_args()
    print("| scene | vertices | cells | build s | decomposition s | GiB | slowest | surface |")
    print("|---|--:|--:|--:|--:|--:|---|---|", flush=True)
    for kind in arguments.kinds:
        for level in arguments.levels:
            ended = run_alone(measured, (kind, level), Limits(inf, inf))
            print(ended.value or f"| {kind} | {ended.error} |", flush=True)


if __name__ == "__main__":
    from frontend_scale import measured  # by the name that other processes can import

    main()
