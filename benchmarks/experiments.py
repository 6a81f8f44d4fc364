"""The paper's six scenes at a resolution, raw and with the sliver policy, as shipped or displaced.

    python benchmarks/experiments.py VERTICES [SEEDS] [--raw-only | --policy-only] [SCENE ...]
    python benchmarks/experiments.py VERTICES --constraints [SCENE ...]

Measures the minimum, in lift-offs; "a-b" if the limit of 10 seconds left it between a and b. With
SEEDS the object is moved by up to 5 mm and 2 degrees an axis, once for each seed from 1 on, and
the line says how often each number came out. With ``--constraints``: how many candidates (a vertex
in a branch that has a solution there) fail each test of validity, and in brackets how many fail no
other. docs/paper.md has the tables.
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cellcolor.deadline import Deadline
from cellcolor.decomposition import decompose
from cellcolor.frontend import BuildResult, build_surface
from cellcolor.frontend.prepared import prepare
from cellcolor.frontend.scene import Scene
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

TOP = Path(__file__).parents[1]
SCENES = TOP / "instances" / "scenes"
NAMES = ("hemisphere_flat", "hemisphere_tilted", "half_pipe", "wok", "wok_obstacle", "square")
NEARBY = 0.005, np.deg2rad(2.0)  # the most that an object is moved: m and rad an axis


def build(name: str, vertices: int, seed: int, raw: bool) -> BuildResult:
    """A variant of a shipped scene; seed 0 leaves it where it is."""
    scene = Scene.read(SCENES / f"{name}.toml").varied(object={"target_vertices": vertices})
    if seed:
        random = np.random.default_rng(seed)
        shift, turn = (random.uniform(-limit, limit, 3) for limit in NEARBY)
        place = scene.placement
        scene = scene.moved(position_m=place.position_m + shift, rpy_rad=place.rpy_rad + turn)
    if raw:
        scene = scene.with_setup(scene.setup.varied(slivers=None))
    return build_surface(scene)


def lift_offs(result: BuildResult) -> tuple[str, int]:
    """Minimum as text, and number of cells."""
    instance = decompose(result.surface)
    solution = solve(instance, Options(deadline=Deadline.after(10), workers=2))
    found = "?" if solution.lift_offs is None else str(solution.lift_offs)
    if solution.status != "optimal":
        found = f"{max(0, solution.lower_bound - 1)}-{found}"
    return found, len(instance.cells)


def shares(result: BuildResult) -> tuple[float, float]:
    """Reachable and given up, in percent of the area."""
    report = result.report
    lost = report.slivers.given_up_area_m2 if report.slivers else 0.0
    return 100 * report.reachable_area_m2 / report.area_m2, 100 * lost / report.area_m2


def print_constraints(names: Sequence[str], vertices: int) -> None:
    """A table: a row for each test, a column for each scene."""
    columns = []
    for name in names:
        scene = Scene.read(SCENES / f"{name}.toml").varied(object={"target_vertices": vertices})
        prepared = prepare(scene)
        surface = prepared.surface
        solutions = prepared.arm.inverse(surface.vertices, -surface.normals).reshape(-1, 6)
        solved = solutions[~np.isnan(solutions[:, 0])]
        failures = prepared.judge.all_failures(solved)
        tests_failed = np.sum(list(failures.values()), axis=0)
        column = {"candidates": f"{len(solved)}", "valid": f"{(tests_failed == 0).sum()}"}
        for test, failed in failures.items():
            column[test] = f"{failed.sum()} ({(failed & (tests_failed == 1)).sum()})"
        columns.append(column)
    print(f"| | {' | '.join(names)} |\n|---|{'--:|' * len(names)}")
    for row in columns[0]:
        print(f"| {row} | {' | '.join(column[row] for column in columns)} |")


def main(arguments: list[str]) -> None:
    """Print the figures."""
    options = {argument for argument in arguments if argument.startswith("--")}
    numbers = [int(argument) for argument in arguments if argument.isdigit()]
    names = [argument for argument in arguments if argument in NAMES] or NAMES
    if "--constraints" in options:
        print_constraints(names, numbers[0])
        return
    left_out = {"--policy-only": True, "--raw-only": False}
    policies = [raw for raw in (True, False) if raw not in {left_out[key] for key in options}]
    for name in names:
        for raw in policies:
            label = f"{name} {numbers[0]} {'raw' if raw else 'policy'}:"
            if len(numbers) == 1:
                result = build(name, numbers[0], 0, raw)
                minimum, cells = lift_offs(result)
                reach, lost = shares(result)
                print(
                    f"{label} {minimum} lift-offs, {cells} cells, {result.report.cracks}"
                    f" cracks, {reach:.1f} % reachable, {lost:.2f} % given up,"
                    f" {sum(result.report.seconds.values()):.2f} s",
                    flush=True,
                )
                continue
            results = [build(name, numbers[0], seed, raw) for seed in range(1, numbers[1] + 1)]
            minima = Counter(lift_offs(result)[0] for result in results)
            reach, lost = zip(*map(shares, results), strict=True)
            print(
                f"{label} {dict(sorted(minima.items()))},"
                f" {min(reach):.1f} to {max(reach):.1f} % reachable,"
                f" at most {max(lost):.2f} % given up",
                flush=True,
            )


if __name__ == "__main__":
    main(sys.argv[1:])
