"""Plan and judge motions on scenes, a row each: ``python benchmarks/motions.py [SCENE …]``.

Measures, for files or shipped names (without any: the six experiments of the paper and the parts of
real shape): lift-offs, proved and judged; the shares of the area within 1.5 and 0.75 spacings of a
pass, and of what is rightly left out; how often a place is visited; turns over 60 degrees in a
meter of path; the share of time in contact above 90 % of the speed that is asked for; near-stops,
which are stretches of 8 ms or more below a tenth of that speed, more than 0.3 s from both ends of a
stroke; seconds of the drive and of processor time. ``--pattern`` is that of ``cellcolor plan``.
docs/measured.md and docs/arms.md have the tables.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import cellcolor
from cellcolor.data.trajectory import Trajectory
from cellcolor.errors import InputError

SCENES = ["wok", "wok_obstacle", "half_pipe", "square", "hemisphere_flat", "hemisphere_tilted"]
PARTS = ["saddle", "perforated_sheet", "sphere", "torus", "blend", "bracket"]
COLUMNS = ["scene", "verdict", "lift-offs", "within 15 mm", "within 7.5 mm", "left out"]
COLUMNS += ["visits", "turns in 1 m", "at speed", "near-stops", "drive, s", "CPU s"]
SPEED = 0.05  # m/s, as in the setups
END, EVERY = 0.3, 0.008  # s; a controller takes a position that often


def evenness(trajectory: Trajectory) -> tuple[float, float, int]:
    """Turns in 1 m, share of time at speed, near-stops."""
    at_speed = time = length = 0.0
    turns = stops = 0
    for first, last in trajectory.strokes:
        steps = np.diff(trajectory.points[first : last + 1], axis=0)
        lengths = np.linalg.norm(steps, axis=1)
        times = trajectory.times[first : last + 1] - trajectory.times[first]
        spans = np.diff(times)
        speeds = lengths / np.maximum(spans, 1e-12)
        at_speed += spans[speeds > 0.9 * SPEED].sum()
        time += times[-1]
        length += lengths.sum()
        inner = (times[:-1] > END) & (times[1:] < times[-1] - END)
        slow = np.diff(((speeds < 0.1 * SPEED) & inner).astype(int), prepend=0, append=0)
        stops += int((times[slow < 0] - times[slow > 0] >= EVERY).sum())
        units = steps[lengths > 1e-9] / lengths[lengths > 1e-9, None]
        turns += int(((units[1:] * units[:-1]).sum(axis=1) < 0.5).sum())
    return turns / length, at_speed / time, stops


def row(scene: str, pattern: str) -> list[str]:
    """The figures of one scene, in the order of ``COLUMNS``."""
    begun = time.process_time()
    try:
        planned = cellcolor.plan(scene, pattern=pattern)
    except InputError as error:
        return [scene, f"refused: {error}"]
    seconds = time.process_time() - begun
    verdict, trajectory = planned.verdict, planned.trajectory
    area = verdict.covered
    assert area is not None
    faults = ", ".join(f"{number} {kind}" for kind, number in verdict.fault_counts.items())
    turns, at_speed, stops = evenness(trajectory)
    return [
        scene,
        "valid" if verdict.valid else faults,
        f"{verdict.minimum_lift_offs}, {verdict.lift_offs}",
        f"{area.covered_share:.2%}",
        f"{area.closely_covered_share:.2%}",
        f"{area.left_out_share:.2%}",
        f"{area.mean_visits:.2f}",
        f"{turns:.1f}",
        f"{at_speed:.1%}",
        str(stops),
        f"{trajectory.times[-1]:.0f}",
        f"{seconds:.1f}",
    ]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("scene", nargs="*", default=SCENES + PARTS)
    parser.add_argument("--pattern", default="contour")
    asked = parser.parse_args()
    print("| " + " | ".join(COLUMNS) + " |")
    print("|---|---|" + "--:|" * (len(COLUMNS) - 2))
    for scene in asked.scene:
        print("| " + " | ".join(row(scene, asked.pattern)) + " |", flush=True)


if __name__ == "__main__":
    main()
