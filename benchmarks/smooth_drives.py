"""How evenly drives go: ``python benchmarks/smooth_drives.py [OPTIONS] [SCENE …]``, a row each.

Within strokes: the share of time above 90 % of the speed asked for; turns over 60 degrees in a
meter; near-stops, which are stretches of 8 ms or more below a tenth of the speed, more than 0.3 s
from both ends of a stroke. Of the whole drive: the jerk of joints that 99 % stay below, by third
differences every 8 ms. docs/measured/motions.md has what came out.
"""

from __future__ import annotations

import argparse

import numpy as np

import cellcolor
from cellcolor.data.trajectory import Trajectory

SCENES = ["square", "wok", "hemisphere_flat", "saddle", "sphere", "torus", "blend", "bracket"]
SPEED = 0.05  # m/s, as in the setup
END, EVERY = 0.3, 0.008  # s; a controller takes a position that often


def measures(trajectory: Trajectory) -> tuple[float, float, int, float]:
    """Share of time at speed, turns in 1 m, near-stops, jerk in rad/s³."""
    at_speed = time = length = 0.0
    turns = stops = 0
    ends = np.flatnonzero(np.diff(trajectory.contact.astype(int), prepend=0, append=0))
    for first, last in ends.reshape(-1, 2):
        steps = np.diff(trajectory.points[first:last], axis=0)
        lengths = np.linalg.norm(steps, axis=1)
        times = trajectory.times[first:last] - trajectory.times[first]
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
    even = np.arange(trajectory.times[0], trajectory.times[-1], EVERY)
    joints = np.stack([np.interp(even, trajectory.times, row) for row in trajectory.joints.T])
    jerk = np.abs(np.diff(joints, 3)).max(axis=0) / EVERY**3
    return at_speed / time, turns / length, stops, float(np.percentile(jerk, 99))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("--pattern", default="contour")
    asked = parser.parse_args()
    print("| scene | valid | s | time above 90 % of the speed | turns in 1 m | near-stops | jerk |")
    print("|---|---|--:|--:|--:|--:|--:|")
    for scene in asked.scenes:
        plan = cellcolor.plan(scene, pattern=asked.pattern)
        share, turns, stops, jerk = measures(plan.trajectory)
        row = f"{plan.verdict.valid} | {plan.trajectory.times[-1]:.1f} | {share:.1%} | {turns:.1f}"
        print(f"| {scene} | {row} | {stops} | {jerk:,.0f} |", flush=True)


if __name__ == "__main__":
    main()
