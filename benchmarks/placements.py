"""What one placement of a small part costs: ``python benchmarks/placements.py``.

The part of each scene of ``instances/scenes`` has a mesh of about 300 vertices and is moved by up
to 15 cm along each axis, drawn with a fixed seed. Each line has a scene and milliseconds of
processor time for one placement in one process, the best of some rounds: for the surface, and for
the minimum with its proof. The last column is a fingerprint of all surfaces, so that two versions
can be compared.
"""

from __future__ import annotations

import argparse
import hashlib
import os
import time
from pathlib import Path

import numpy as np

import cellcolor
from cellcolor.deadline import NEVER
from cellcolor.frontend import Scene
from cellcolor.frontend.build import labelled
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.stage_clock import StageClock
from cellcolor.frontend.stages import judged

SCENES = sorted((Path(__file__).parents[1] / "instances" / "scenes").glob("*.toml"))
VERTICES, FARTHEST_M = 300, 0.15


def row(file: Path, placements: int, rounds: int) -> tuple[float, float, str]:
    """Milliseconds of surface and of proof, and the fingerprint."""
    scene = Scene.read(file).varied(object={"target_vertices": VERTICES})
    prepared, here = prepare(scene), np.array(scene.placement.position_m)
    shifts = np.random.default_rng(1).uniform(-FARTHEST_M, FARTHEST_M, (placements, 3))
    times = []
    for _ in range(rounds):
        found, building, proving = hashlib.sha256(), 0.0, 0.0
        for shift in shifts:
            place = scene.placement.varied(position_m=tuple((here + shift).tolist()))
            started = time.process_time()
            there = prepared.at(place)
            surface, _ = labelled(there, judged(there, StageClock(NEVER, None)), {})
            built = time.process_time()
            cellcolor.solve(surface, workers=1)
            proving += time.process_time() - built
            building += built - started
            found.update(surface.sha256.encode())
        times.append((building, proving))
    best = 1000 * np.min(times, axis=0) / placements
    return float(best[0]), float(best[1]), found.hexdigest()[:12]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--placements", type=int, default=12)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})  # then there is one process
    for file in SCENES:
        building, proving, fingerprint = row(file, asked.placements, asked.rounds)
        print(f"{file.stem:<18} {building:6.0f} {proving:5.0f}  {fingerprint}", flush=True)


if __name__ == "__main__":
    main()
