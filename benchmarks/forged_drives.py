"""How many forged drives the judge of trajectories refuses, by kind.

    python benchmarks/forged_drives.py [COUNT] [SEED] [START]

plans four shipped scenes, and forges COUNT drives (1,000 without it) from draw START on, the sorts
of ``tests/support/forged_drives.py`` in turn. Before draw 0 it checks that every plan stays valid
in ways that change nothing, and drops each stroke in turn. Exit code 1 if anything was not as it
has to be. A draw takes a second or two, and the same thousand can be had in pieces::

    for start in $(seq 0 100 900); do python benchmarks/forged_drives.py 100 0 $start; done
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
from forged_drives import FORGERS
from honest_drives import HONEST, Honest, dropped_stroke

import cellcolor
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import TrajectoryVerdict
from cellcolor.door.planned import PlannedScene
from cellcolor.trajectory_checker.check import check_trajectory

SCENES = ("wok", "wok_obstacle", "half_pipe", "hemisphere_tilted")


def main(count: int, seed: int, start: int) -> int:
    """Plan, forge, judge and print."""
    begun = time.process_time()
    plans = [cellcolor.plan(name) for name in SCENES]
    drives = [
        Honest(made.built.prepared, made.trajectory, made.solution.lift_offs) for made in plans
    ]
    good = start > 0 or honest_accepted(plans, drives)
    forged, refused, none = Counter[str](), Counter[str](), Counter[str]()
    names = list(FORGERS)
    for number in range(start, start + count):
        name, place = names[number % len(names)], number // len(names) % len(plans)
        try:
            drive = FORGERS[name](drives[place], np.random.default_rng([seed, number]))
        except LookupError:
            none[name] += 1
            continue
        forged[name] += 1
        if judged(plans[place], drive).valid:
            print(f"accepted: {name}, {SCENES[place]}, draw {number}", flush=True)
        else:
            refused[name] += 1
    print("\n| forged | times | refused | nothing to forge |\n|---|--:|--:|--:|")
    for name in names:
        print(f"| {name} | {forged[name]} | {refused[name]} | {none[name]} |")
    print(f"| all {len(names)} sorts | {forged.total()} | {refused.total()} | {none.total()} |")
    seconds = time.process_time() - begun
    print(f"\nDraws {start} to {start + count - 1}, {seconds:.0f} s")
    return 0 if good and forged == refused else 1


def honest_accepted(plans: list[PlannedScene], drives: list[Honest]) -> bool:
    """Whether plans are accepted in other forms as well, and none without one of its strokes."""
    honest = [
        judged(made, forge(drive)).valid
        for made, drive in zip(plans, drives, strict=True)
        for forge in HONEST.values()
    ]
    print(f"honest: {honest.count(True)} of {len(honest)} accepted", flush=True)
    strokes = [
        judged(made, dropped_stroke(drive, number)).valid
        for made, drive in zip(plans, drives, strict=True)
        for number in range(len(drive.trajectory.strokes))
    ]
    print(f"a stroke dropped: {strokes.count(False)} of {len(strokes)} refused", flush=True)
    return all(honest) and not any(strokes)


def judged(made: PlannedScene, trajectory: Trajectory) -> TrajectoryVerdict:
    """The verdict, with the proved minimum beside it."""
    least = made.solution.lift_offs
    return check_trajectory(made.built, trajectory, minimum_lift_offs=least)


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    sys.exit(main(*given, *(1000, 0, 0)[len(given) :]))
