"""What the oracle for other planners finds: ``python benchmarks/oracle.py TABLE [COUNT]``.

    faults    COUNT faults (1,000) planted in valid plans on 64 surfaces, 17 sorts in turn
    valid     COUNT valid plans (1,000) of six sorts on the same surfaces; every seventh is judged
              by an oracle whose time limit left its range open
    planners  what two planners pay on the six scenes, beside what is proved

Measures how many were refused or contradicted; the seed of each draw is its number. Exit
code 1 if anything was not as it has to be. docs/measured.md has the first two tables,
docs/paper.md the last one.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
from planners import (
    SORTS,
    Colors,
    configurations_of,
    contradictions,
    largest_set_first,
    nearest_along_raster,
    segments_counted,
    valid_plans,
)
from planted_plans import PLANTERS, Case, caught

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import MEDIUM, SHAPES, SMALL, voronoi

ROOT = Path(__file__).resolve().parents[1]
SCENES = sorted((ROOT / "instances" / "scenes").glob("*.surface.json"))
STORED = sorted(set((ROOT / "instances").rglob("*.surface.json")) - set(SCENES))
DIRECTIONS = 18  # of the raster
LIMIT = 20.0  # seconds for each proof


def surfaces() -> Iterator[tuple[LabelledSurface, Array | None]]:
    """What plans are judged on, and the configurations of those that were built from a scene."""
    for file in SCENES:
        surface = LabelledSurface.read(file)
        yield surface, configurations_of(surface, CandidateTable.beside(surface, file))
    for file in STORED:
        yield LabelledSurface.read(file), None
    for family in SMALL.values():
        for seed in range(3):
            made = family(seed)
            if isinstance(made, LabelledSurface):
                yield made, None
    for name in MEDIUM:
        made = MEDIUM[name](0)
        assert isinstance(made, LabelledSurface)
        yield made, None
    for shape in SHAPES:
        for seed in range(2):
            yield voronoi(seed, shape, 12, 16, 4, cracks=4, islands=2, holes=2), None


def faults(count: int) -> bool:
    """Plant, judge and print; whether all were caught."""
    planted_of, caught_of = Counter[str](), Counter[str]()
    every = [surface for surface, _ in surfaces()]
    names, number = list(PLANTERS), 0
    with tempfile.TemporaryDirectory() as folder:
        pairs = zip(every, [*every[1:], every[0]], strict=True)
        cases = [Case(surface, other, Path(folder)) for surface, other in pairs]
        while planted_of.total() < count:
            # The two numbers have no common divisor, so that every sort meets every surface.
            name, case = names[number % len(names)], cases[number % len(cases)]
            planted = PLANTERS[name](case, np.random.default_rng(number))
            number += 1
            if planted is None:
                continue
            planted_of[name] += 1
            if caught(case, planted):
                caught_of[name] += 1
            else:
                print(f"not caught: {name}, seed {number - 1}, {case.surface.name}")
    print(f"{len(cases)} surfaces\n\n| planted | times | caught with kind and place |")
    print("|---|--:|--:|")
    for name in names:
        print(f"| {name} | {planted_of[name]} | {caught_of[name]} |")
    print(f"| all | {planted_of.total()} | {caught_of.total()} |")
    return planted_of == caught_of


def valid(count: int) -> bool:
    """Judge valid plans and print; whether no verdict was contradicted."""
    pool = list(surfaces())
    columns = ("judged", "optimal", "can be beaten", "open", "refused or contradicted")
    found: dict[str, Counter[str]] = {column: Counter() for column in columns}
    exact = 0
    for number, (surface, configurations) in enumerate(pool):
        oracle = cellcolor.Oracle(surface, time_limit=LIMIT)
        hurried = cellcolor.Oracle(surface, time_limit=1e-9)
        exact += oracle.bounds.exact
        fewest = oracle.bounds.upper
        if oracle.best is not None:
            painted = oracle.best.painted
            fewest = segments_counted(painted.surface, painted.plan.vertex_colors)
        plans = valid_plans(oracle, np.random.default_rng(number), configurations)
        share = count // len(pool) + (number < count % len(pool))
        for turn, (sort, colors) in zip(range(share), plans, strict=False):
            judge = hurried if turn % 7 == 6 else oracle
            verdict = judge.judge(colors)
            wrong = contradictions(judge, colors, verdict, fewest)
            for text in wrong:
                print(f"{surface.name}, {sort}: {text}")
            fewer = verdict.beatable_by
            row = (True, verdict.optimal is True, bool(fewer), fewer is None, bool(wrong))
            for column, holds in zip(columns, row, strict=True):
                found[column][sort] += holds
    print(f"{len(pool)} surfaces, the minimum of {exact} is known\n")
    print(f"| plans | {' | '.join(columns)} |\n|---|{'--:|' * len(columns)}")
    for sort in SORTS:
        print(f"| {sort} | {' | '.join(str(found[column][sort]) for column in columns)} |")
    print(f"| all | {' | '.join(str(found[column].total()) for column in columns)} |")
    return not found[columns[-1]].total()


def planners() -> None:
    """Lift-offs of two planners on the six scenes, beside the proven minimum."""
    print("| scene | fewest, proved | greedy | nearest along a raster |\n|---|--:|--:|--:|")
    for file in SCENES:
        print(f"| {' | '.join(row_of_planners(file))} |", flush=True)


def row_of_planners(file: Path) -> list[str]:
    """The table's row of one scene, from its stored surface and the configurations beside it."""
    surface = LabelledSurface.read(file)
    configurations = configurations_of(surface, CandidateTable.beside(surface, file))
    oracle = cellcolor.Oracle(surface)

    def lift_offs(colors: Colors) -> int:
        return oracle.judge(colors).lift_offs or 0

    angles = np.arange(DIRECTIONS) * np.pi / DIRECTIONS
    nearest = [lift_offs(nearest_along_raster(surface, configurations, a)) for a in angles]
    assert oracle.bounds.exact
    return [
        file.name.removesuffix(".surface.json"),
        str(max(0, oracle.bounds.lower - 1)),
        str(lift_offs(largest_set_first(surface))),
        f"{min(nearest)}, {median(nearest):g}, {max(nearest)}",
    ]


def main() -> int:
    """Print a table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("table", choices=["faults", "valid", "planners"])
    parser.add_argument("count", nargs="?", type=int)
    asked = parser.parse_args()
    if asked.table != "planners":
        return 0 if {"faults": faults, "valid": valid}[asked.table](asked.count or 1000) else 1
    planners()
    return 0


if __name__ == "__main__":
    sys.exit(main())
