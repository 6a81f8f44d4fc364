"""Maps of where the parts of scenes may stand, and what the best placements are worth.

    python benchmarks/maps.py [--yaw] [--cluster] [SCENE ...]

Each row has a scene of the paper and a map of 31 x 31 places, 0.35 m along x and 0.5 m along y
around its own (``--yaw``: of 72 turns): lift-offs and area where the paper has the part, the least
and the most lift-offs on the map, how many tiles have fewer than the paper's placement (and as
much area), all on a coarse mesh; the best placement found, on the scene's own mesh; what its
motion drives and what the judge says; seconds of processor time of this process and its children;
and a fingerprint of all rows, so that two runs can be compared. With ``--cluster`` two workers of
a Dask cluster do the work, one of which is killed after a minute.
"""

from __future__ import annotations

import argparse
import hashlib
import math
import os
import signal
import threading
from typing import Any

import cellcolor
from cellcolor.door.shipped import find_file
from cellcolor.errors import InputError
from cellcolor.frontend import Scene
from cellcolor.questions.placements import PlacedMinimum, Placements

SCENES = ("half_pipe", "hemisphere_flat", "hemisphere_tilted", "square", "wok", "wok_obstacle")
TILES, TURNS = 31, 72
ALONG_M, ACROSS_M = 0.35, 0.5
KILLED_AFTER_S = 60.0


def mapped(scene: Scene, yaw: bool, cluster: bool) -> Placements:
    """The map of a scene."""
    x, y, _ = scene.placement.position_m
    asked: dict[str, Any] = {"tiles": TURNS, "yaw": (-math.pi, math.pi)}
    if not yaw:
        sides = (x - ALONG_M / 2, x + ALONG_M / 2), (y - ACROSS_M / 2, y + ACROSS_M / 2)
        asked = {"tiles": TILES, "x": sides[0], "y": sides[1]}
    if not cluster:
        return cellcolor.place(scene, **asked)
    from distributed import Client, LocalCluster

    from cellcolor.lab.cluster import ClusterWorkers

    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as workers:
        with Client(workers) as client:
            first = next(iter(client.run(os.getpid).values()))
        killing = threading.Timer(KILLED_AFTER_S, os.kill, (first, signal.SIGKILL))
        killing.start()
        found = cellcolor.place(scene, **asked, jobs=ClusterWorkers(workers.scheduler_address))
        assert not killing.is_alive(), "all was done before the worker was killed"
    return found


def driven(scene: Scene, row: PlacedMinimum) -> str:
    """What the motion at a placement does; from another home if the part stands in the setup's."""
    there = scene.moved(position_m=row.pose[:3], rpy_rad=row.pose[3:])
    try:
        planned = cellcolor.plan(there)
    except InputError as error:
        if "home_rad" not in str(error):
            return f"refused: {error}"
        planned = cellcolor.plan(there, home_rad="free")
    valid = "valid" if planned.verdict.valid else f"{len(planned.verdict.faults)} faults"
    return f"{planned.trajectory.lift_offs}, {valid}"


def said(row: PlacedMinimum) -> str:
    """Lift-offs and area."""
    return f"{row.lift_offs}, {100 * row.covered_share:.1f} %"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--yaw", action="store_true")
    parser.add_argument("--cluster", action="store_true")
    parser.add_argument("scene", nargs="*", default=SCENES)
    asked = parser.parse_args()
    for name in asked.scene:
        scene = Scene.read(find_file(name))
        begun = sum(os.times()[:4])
        found = mapped(scene, asked.yaw, asked.cluster)
        seconds = sum(os.times()[:4]) - begun
        paper = found.tried[0]
        assert found.map is not None and paper.segments is not None
        tiles = [row for row in found.map.rows if row is not None and row.segments is not None]
        fewer = [row for row in tiles if (row.segments or 0) < paper.segments]
        as_much = [row for row in fewer if row.covered_share >= paper.covered_share]
        counts = [row.segments - 1 for row in tiles if row.segments is not None]
        assert found.complete and all(row.proved_for_surface for row in tiles)
        fingerprint = hashlib.sha256(repr(list(found)).encode()).hexdigest()[:12]
        cells = (
            name,
            said(paper),
            f"{min(counts)} to {max(counts)}",
            f"{len(fewer)} ({len(as_much)})",
            said(found.best[0]),
            driven(scene, found.best[0]),
            f"{seconds:.0f} s",
            fingerprint,
        )
        print(f"| {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
