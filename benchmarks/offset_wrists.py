"""Arms with an offset wrist: the price of a pose, and how many solutions are found.

    python benchmarks/offset_wrists.py [--poses 1000] [ARM ...]

All solutions of the poses of random configurations, compared with Newton's method from 300 random
starts (tests/support/solution_sets.py), modulo full turns. Solutions that are about to meet, with a
task determinant below 1e-5 of the cube of the reach, are not compared. docs/arms.md has what came
out.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import dh_arms
from independent import wrapped
from solution_sets import SAME, Arm, ManyStarts, estimated_missing

from cellcolor.frontend.arm.offset_wrist import OffsetWrist
from cellcolor.frontend.setup import RobotFiles

FILES = RobotFiles(
    arm_urdf="<",
    flange_link="flange",
    tool_urdf="<",
    tip_link="tool_tip",
    kinematics="offset-wrist",
    locked_joint_6_rad=0.0,
)


def row(name: str, poses: int) -> str:
    """A row of the table."""
    robot = dh_arms.robot(dh_arms.urdf(name))
    arm, other = Arm(robot, OffsetWrist(robot, FILES)), ManyStarts.of(robot.model)
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (poses, 5))
    points, directions, _ = other.posed(q)
    start = time.process_time()
    solved = arm.solved(points, directions)
    price = (time.process_time() - start) / poses
    found = other.solutions(points, directions, 300, 3)
    hits = np.concatenate([each.hits[arm.is_regular(each.joints)] for each in found])
    both = lost = more = 0
    for ours, theirs in zip(solved, (arm.regular(each.joints) for each in found), strict=True):
        off = wrapped(theirs[:, None] - ours[None]).max(axis=2).min(axis=1, initial=np.inf)
        lost += int((off > SAME).sum())
        both += int((off <= SAME).sum())
        more += max(len(arm.regular(ours)) - int((off <= SAME).sum()), 0)
    most = max(map(len, solved))
    return (
        f"| {name} | {1e3 * price:.1f} | {both + lost} | {lost} | {more} | {most} "
        f"| {estimated_missing(hits):.1f} |"
    )


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("name", nargs="*")
    parser.add_argument("--poses", type=int, default=1000)
    given = parser.parse_intermixed_args()
    print(
        "| arm | ms a pose | by many starts | not found | more | most of a pose | missing by Chao |"
    )
    print("|---|" + "--:|" * 6)
    for name in given.name or dh_arms.OFFSET_WRISTS:
        print(row(name, given.poses), flush=True)


if __name__ == "__main__":
    main()
