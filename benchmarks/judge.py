"""What the judge of trajectories refuses: ``python benchmarks/judge.py [COUNT]``.

Drives are forged from plans of four shipped scenes, in the sorts of
``tests/support/forged_drives.py``; before the first, every plan has to stay valid in ways that
change nothing, and not without one of its strokes.

Measures how many of COUNT draws (1,000) are refused, by sort; the sorts take turns, and the seed of
a draw is its number. Exit code 1 if anything was not as it has to be.
docs/judging-trajectories.md says what came out.
"""

from __future__ import annotations

import argparse
import sys
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


def forged(count: int) -> bool:
    """Plan, forge, judge and print; whether all were refused."""
    plans = [cellcolor.plan(name) for name in SCENES]
    drives = [
        Honest(made.built.prepared, made.trajectory, made.solution.lift_offs) for made in plans
    ]
    good = honest_accepted(plans, drives)
    tally = Tally(list(FORGERS))
    for number in range(count):
        name, place = tally.sort(number), number // len(FORGERS) % len(plans)
        try:
            drive = FORGERS[name](drives[place], np.random.default_rng([0, number]))
        except LookupError:  # there is nothing to forge in this plan
            continue
        tally.add(name, number, not judged(plans[place], drive).valid)
    return tally.printed() and good


def honest_accepted(plans: list[PlannedScene], drives: list[Honest]) -> bool:
    """Whether plans are accepted in other forms as well, and none without one of its strokes."""
    honest, strokes = [], []
    for made, drive in zip(plans, drives, strict=True):
        honest += [judged(made, forge(drive)).valid for forge in HONEST.values()]
        every = range(len(drive.trajectory.strokes))
        strokes += [judged(made, dropped_stroke(drive, number)).valid for number in every]
    print(f"honest: {honest.count(True)} of {len(honest)} accepted", flush=True)
    print(f"a stroke dropped: {strokes.count(False)} of {len(strokes)} refused", flush=True)
    return all(honest) and not any(strokes)


def judged(made: PlannedScene, trajectory: Trajectory) -> TrajectoryVerdict:
    """The verdict, with the proved minimum beside it."""
    return check_trajectory(made.built, trajectory, minimum_lift_offs=made.solution.lift_offs)


class Tally:
    """How many of each sort were drawn and refused."""

    def __init__(self, sorts: list[str]) -> None:
        self.sorts, self.drawn, self.refused = sorts, Counter[str](), Counter[str]()

    def sort(self, number: int) -> str:
        """The sort of a draw."""
        return self.sorts[number % len(self.sorts)]

    def add(self, sort: str, number: int, refused: bool) -> None:
        """Count a draw; one that was not refused is printed."""
        self.drawn[sort] += 1
        self.refused[sort] += refused
        if not refused:
            print(f"not refused: {sort}, draw {number}", flush=True)

    def printed(self) -> bool:
        """Print the table; whether everything was refused."""
        print("| sort | times | refused |\n|---|--:|--:|")
        for sort in self.sorts:
            print(f"| {sort} | {self.drawn[sort]} | {self.refused[sort]} |")
        print(f"| all {len(self.sorts)} | {self.drawn.total()} | {self.refused.total()} |")
        return self.drawn == self.refused


def main(arguments: list[str] | None = None) -> int:
    """Print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("count", nargs="?", type=int, default=1000)
    asked = parser.parse_args(arguments)
    return 0 if forged(asked.count) else 1


if __name__ == "__main__":
    sys.exit(main())
