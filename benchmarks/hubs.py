"""What is proved of hubs: many petals, several loops, and grids of hubs.

    python benchmarks/hubs.py [SECONDS]

One solve at a time, each with the time limit, 10 seconds if none is given. Processor time is that
of all threads of this process together.
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Callable

import cellcolor
from cellcolor.data.instance import Instance
from cellcolor.lab.families import hub, hub_grid, hub_with_loops

SEEDS = range(5)
GROUPS: dict[str, Callable[[int], Instance]] = {
    **{
        f"{petals} petals, {colors} colors": lambda seed, p=petals, c=colors: hub(seed, p, c)
        for petals in (60, 200, 300)
        for colors in (4, 40)
    },
    **{
        f"{loops} loops × {petals} petals, {colors} colors": (
            lambda seed, k=loops, p=petals, c=colors: hub_with_loops(seed, k, p, c)
        )
        for loops, petals, colors in (
            *((loops, petals, 4) for loops in (2, 3, 4, 5, 6) for petals in (4, 6)),
            (4, 6, 8),
        )
    },
    **{
        f"grid of {side} × {side} hubs": lambda seed, s=side: hub_grid(seed, s, s, 4)
        for side in (3, 4)
    },
}


def main(seconds: float) -> None:
    """Print the table."""
    print(f"load {os.getloadavg()[0]:.1f}")
    print("| hubs | proved | segments less bound of the others | median CPU s | most |")
    print("|---|---|---|---|---|")
    for name, make in GROUPS.items():
        used, gaps = [], []
        for seed in SEEDS:
            instance = make(seed)
            started = time.process_time()
            solution = cellcolor.solve(instance, time_limit=seconds).solution
            used.append(time.process_time() - started)
            gaps.append(solution.segments - max(b.value for b in solution.bounds or ()))
        others = ", ".join(str(gap) for gap in sorted(gaps) if gap)
        times = f"{statistics.median(used):.2f} | {max(used):.2f}"
        print(f"| {name} | {gaps.count(0)} of {len(gaps)} | {others} | {times} |", flush=True)
    print(f"load {os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 10.0)
