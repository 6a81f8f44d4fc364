"""How many planted faults the judge of trajectories finds with their kind, joint and time.

    python benchmarks/planted_faults.py [COUNT]

plants COUNT faults (1,000 without it), the seven sorts in turn, in two trajectories without any,
and prints a table. The seed of each draw is its number.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
import rasters
from planted_faults import PLANTERS, found

from cellcolor.trajectory_checker.check import check_trajectory


def main(count: int) -> None:
    """Plant, judge and print."""
    begun = time.monotonic()
    untouched = [rasters.cap(), rasters.square()]
    for _, built, trajectory in untouched:
        verdict = check_trajectory(built, trajectory)
        faults = sum(verdict.fault_counts.values())
        print(f"untouched: {verdict}, {faults} faults", flush=True)
    planted_of, found_of = Counter[str](), Counter[str]()
    names = list(PLANTERS)
    for number in range(count):
        name = names[number % len(names)]
        # Only the first scene has an obstacle.
        place = 0 if name == "1 mm inside an obstacle" else number // len(names) % 2
        prepared, built, trajectory = untouched[place]
        planted = PLANTERS[name](prepared, trajectory, np.random.default_rng(number))
        verdict = check_trajectory(built, planted.trajectory)
        planted_of[name] += 1
        if found(planted, verdict):
            found_of[name] += 1
        else:
            print(f"not found: {name}, seed {number}: {planted.joint} {planted.samples}")
    print("\n| planted | times | found with kind, joint and time |\n|---|--:|--:|")
    for name in names:
        print(f"| {name} | {planted_of[name]} | {found_of[name]} |")
    print(f"\n{sum(found_of.values())} of {count}, {time.monotonic() - begun:.0f} s")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000)
