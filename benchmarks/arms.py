"""The arms that come along: their inverse kinematics against ssik, and minima of their scenes.

    python benchmarks/arms.py solutions [--poses 5000] [ARM ...]
    python benchmarks/arms.py scenes [SCENE ...]

``solutions`` compares the sets of all solutions, both ways and modulo full turns: of the poses of
random configurations, and of a fiftieth as many near each kind of singularity, 1e-2, 1e-4, 1e-7 and
0 rad from it. ``scenes`` builds and solves; ``benchmarks/motions.py SCENE`` plans motions on the
same ones and judges them. Without names: all arms but the calibrated one, whose judge is another
(tests/frontend/arm/test_calibrated.py), and all scenes in instances/arms. docs/arms.md has what
came out.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

TOP = Path(__file__).parents[1]
sys.path.insert(0, str(TOP / "tests" / "support"))

from cellcolor.deadline import Deadline  # noqa: E402
from cellcolor.decomposition import decompose  # noqa: E402
from cellcolor.frontend import build_surface  # noqa: E402
from cellcolor.frontend.setup import Setup  # noqa: E402
from cellcolor.solvers.checked import solve  # noqa: E402
from cellcolor.solvers.interface import Options  # noqa: E402

ROBOTS, SCENES = TOP / "models" / "robots", TOP / "instances" / "arms"
OFF = (1e-2, 1e-4, 1e-7, 0.0)  # rad


def solutions(name: str, poses: int) -> str:
    """A row: how the arm's family and ssik agree."""
    from near_singular import KINDS, near_singular
    from solution_sets import Arm

    arm = Arm.of(Setup.read(ROBOTS / f"{name}_polishing.toml"))
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (poses, 6))
    found = arm.compared(q)
    near = [
        (arm.compared(rows), arm.lost(rows, 1e-9 / off) if off >= 1e-4 else 0)
        for kind in KINDS
        for off in OFF
        for rows in [near_singular(arm.robot, arm.family.reach, kind, off, max(1, poses // 50))]
    ]
    return (
        f"| {name} | {found.poses} | {found.solutions} | {found.different} | {found.farthest:.0e} "
        f"| {sum(each.poses for each, _ in near)} | {sum(each.different for each, _ in near)} "
        f"| {sum(lost for _, lost in near)} |"
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
        names = [name.removesuffix("_polishing") for name in setups if "calibrated" not in name]
        print("| arm | poses | solutions | different | rad | near singular | different | lost |")
    else:
        names = sorted(path.stem for path in SCENES.glob("*.toml"))
        print("| scene | vertices | reached | given up | colors | cells | lift-offs | proof |")
    print("|---|" + "--:|" * 7)
    for name in given.name or names:
        print(
            solutions(name, given.poses) if given.what == "solutions" else scene(name), flush=True
        )


if __name__ == "__main__":
    main()
