"""The arms that come along: their inverse kinematics against ssik, and minima of their scenes.

    python benchmarks/arms.py solutions [--poses 5000] [ARM ...]
    python benchmarks/arms.py scenes [SCENE ...]

``solutions`` compares the sets of all solutions, both ways and modulo full turns: of the poses of
random configurations, and of a fiftieth as many near each kind of singularity, 1e-2, 1e-4, 1e-7 and
0 rad from it. Of the SCARA the other solver is Newton's method on Pinocchio's Jacobian from 16
starts for each pose, and near singularities only lost ones are counted. Of the calibrated arm it is
Newton's method from 240 starts (tests/support/solution_sets.py), and a line says how often its
solutions were found. ``scenes`` builds and solves; ``benchmarks/motions.py SCENE`` plans motions on
the same ones and judges them. Without names: all arms, and all scenes in instances/arms.
docs/arms.md has what came out.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

TOP = Path(__file__).parents[1]
sys.path.insert(0, str(TOP / "tests" / "support"))

from cellcolor.deadline import Deadline  # noqa: E402
from cellcolor.decomposition import decompose  # noqa: E402
from cellcolor.frontend import build_surface  # noqa: E402
from cellcolor.frontend.arm.turned import TurnedKinematics  # noqa: E402
from cellcolor.frontend.prepared import prepare  # noqa: E402
from cellcolor.frontend.setup import Setup  # noqa: E402
from cellcolor.solvers.checked import solve  # noqa: E402
from cellcolor.solvers.interface import Options  # noqa: E402

if TYPE_CHECKING:
    from solution_sets import Arm, Compared

    from cellcolor.arrays import Array, Index

ROBOTS, SCENES = TOP / "models" / "robots", TOP / "instances" / "arms"
SCARA, CALIBRATED = "cobra600", "ur5e_calibrated"
STARTS = 240
OFF = (1e-2, 1e-4, 1e-7, 0.0)  # rad


def solutions(name: str, poses: int) -> str:
    """A row: how the arm's family and another solver agree, ssik or many starts."""
    from solution_sets import KINDS, Arm, near_singular

    arm = Arm.of(Setup.read(ROBOTS / f"{name}_polishing.toml"))
    judge = ByStarts(arm) if name == CALIBRATED else None
    compared = judge.compared if judge else arm.compared
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (poses, 6))
    found = compared(q)
    near = [
        (compared(rows), arm.lost(rows, 1e-9 / off) if off >= 1e-4 else 0)
        for kind in KINDS
        for off in OFF
        for rows in [near_singular(arm.robot, arm.family.reach, kind, off, max(1, poses // 50))]
    ]
    row = (
        f"| {name} | {found.poses} | {found.solutions} | {found.different} | {found.farthest:.0e} "
        f"| {sum(each.poses for each, _ in near)} | {sum(each.different for each, _ in near)} "
        f"| {sum(lost for _, lost in near)} |"
    )
    return row + (f"\n\n{judge.said()}" if judge else "")


class ByStarts:
    """An arm against Newton's method from many starts, and how often that found each solution."""

    def __init__(self, arm: Arm) -> None:
        from solution_sets import ManyStarts

        self.arm, self.other = arm, ManyStarts.of(arm.robot.model)
        self.poses = 0
        self.hits: list[Index] = []

    def compared(self, q: Array) -> Compared:
        """Both on the poses of configurations (n, 6)."""
        points, directions, _ = self.other.posed(q[:, :5])

        def progress(done: int) -> None:
            if done % 100 == 0:
                print(f"\r{self.poses + done} poses by many starts", end="", file=sys.stderr)

        found = self.other.solutions(points, directions, STARTS, self.poses, progress)
        self.poses += len(q)
        self.hits += [each.hits[self.arm.is_regular(each.joints)] for each in found]
        return self.arm.held_against([each.joints for each in found], q)

    def said(self) -> str:
        """How complete the starts were, of solutions that are compared."""
        from solution_sets import estimated_missing

        hits = np.concatenate(self.hits)
        few = [int(np.count_nonzero(hits == often)) for often in range(1, 6)]
        return (
            f"{STARTS} starts for each of {self.poses} poses: {len(hits)} solutions, each found "
            f"{hits.mean():.1f} times in the mean, {int(hits.min())} at least; {few} of them once "
            f"to five times; {estimated_missing(hits):.1f} missing by this (Chao)"
        )


def scara_solutions(name: str, poses: int) -> str:
    """The same row of an arm whose solutions the tests find by Newton's method."""
    from bent_tools import tip_frame, tip_frames
    from scaras import configurations, distance, newton_solutions, sets_apart

    prepared = prepare(TOP / "instances" / "planar" / f"{name}_pipe.toml")
    robot, family = prepared.robot, prepared.kinematics
    assert isinstance(family, TurnedKinematics)
    q = configurations(robot, poses, 6)
    count = different = lost = 0
    farthest = 0.0
    for row, ours in enumerate(family.solve_pose(*tip_frames(robot.model, q))):
        starts = configurations(robot, 16, row)
        apart = sets_apart(
            robot, ours, newton_solutions(robot, tip_frame(robot.model, q[row]), starts)
        )
        count += len(ours)
        different += apart > 1e-5
        farthest = max(farthest, apart if apart <= 1e-5 else 0.0)
    # A straight elbow and a folded one are all the singularities that there are.
    near = configurations(robot, 8 * max(1, poses // 50), 29)
    for number, rows in enumerate(np.array_split(np.arange(len(near)), 8)):
        near[rows, 1] = OFF[number % 4] + np.pi * (number // 4)
        for own, ours in zip(
            near[rows], family.solve_pose(*tip_frames(robot.model, near[rows])), strict=True
        ):
            off = OFF[number % 4]
            nearest = min((distance(robot, own, each) for each in ours), default=np.inf)
            lost += off >= 1e-4 and not nearest <= 1e-9 / off
    return (
        f"| {name} | {poses} | {count} | {different} | {farthest:.0e} | {len(near)} | not asked "
        f"| {lost} |"
    )


def scene(name: str) -> str:
    """A row: what a scene needs."""
    result = build_surface(SCENES / f"{name}.toml")
    instance = decompose(result.surface)
    solution = solve(instance, Options(deadline=Deadline.after(60), workers=2))
    report = result.report
    given_up = report.slivers.given_up_area_m2 if report.slivers else 0.0
    proved = "proved" if solution.status == "optimal" else f"at least {solution.lower_bound - 1}"
    anywhere = "any division" if solution.proved_for_surface else "the paper's divisions"
    return (
        f"| {name} | {len(result.surface.vertices)} "
        f"| {report.reachable_area_m2 / report.area_m2:.1%} | {given_up / report.area_m2:.2%} "
        f"| {len(report.colors)} | {len(instance.cells)} | {solution.lift_offs} "
        f"| {proved}, {anywhere} |"
    )


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["solutions", "scenes"])
    parser.add_argument("name", nargs="*")
    parser.add_argument("--poses", type=int, default=5000)
    given = parser.parse_intermixed_args()
    if given.what == "solutions":
        setups = sorted(path.stem for path in ROBOTS.glob("*_polishing.toml"))
        names = [name.removesuffix("_polishing") for name in setups]
        names.append(SCARA)
        print("| arm | poses | solutions | different | rad | near singular | different | lost |")
    else:
        names = sorted(path.stem for path in SCENES.glob("*.toml"))
        print("| scene | vertices | reached | given up | colors | cells | lift-offs | proof |")
    print("|---|" + "--:|" * 7)
    for name in given.name or names:
        asked = scara_solutions if name == SCARA else solutions
        row = asked(name, given.poses) if given.what == "solutions" else scene(name)
        print(row, flush=True)


if __name__ == "__main__":
    main()
