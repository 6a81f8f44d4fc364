"""Write the six scenes as other scenes: ``benchmarks/displaced.py FOLDER [SEEDS]``.

2000 vertices, no sliver policy, the object moved at random by up to 40 mm and 12 degrees an axis,
far beyond what a fixture would allow. ``cellcolor bench run FOLDER/*`` solves them.
"""

from __future__ import annotations

import sys
from math import radians
from pathlib import Path

import experiments


def main(folder: Path, seeds: int) -> None:
    """Write a labelled surface for each scene and seed."""
    experiments.SHIFT_M, experiments.TURN_RAD = 0.04, radians(12)
    for name in experiments.NAMES:
        (folder / name).mkdir(parents=True, exist_ok=True)
        for seed in range(1, seeds + 1):
            surface = experiments.build(name, 2000, seed, raw=True).surface
            file = folder / name / f"{name}_{seed}.surface.json"
            file.write_text(surface.to_json(), encoding="utf-8")
            print(file, flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if sys.argv[2:] else 12)
