"""What the oracle for other planners finds, and how fast: ``python benchmarks/oracle.py TABLE``.

    faults [COUNT]    COUNT faults (1,000) planted in valid plans on 63 surfaces, 17 sorts in turn
    valid [COUNT]     COUNT valid plans (10,000) of six sorts on the same surfaces; every seventh
                      is judged by an oracle whose time limit left its range open
    tampered [COUNT]  COUNT kept proofs (500) that somebody has changed, in 32 sorts in turn
    speed             plans on 8,000 vertices; a suite of 100 plans, run twice
    planners          what three planners pay on the six scenes, beside what is proved

Each prints Markdown; ``faults``, ``valid`` and ``tampered`` end with exit code 1 if anything was
not as it has to be. The seed of each draw is its number.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "support"))

import numpy as np
from planners import (
    SORTS,
    Colors,
    any_colors,
    configurations_of,
    contradictions,
    in_patches,
    largest_set_first,
    nearest_along_raster,
    random_branches,
    segments_counted,
    valid_plans,
)
from planted_plans import PLANTERS, Case, caught
from tampered import TAMPERERS, Kept, is_honest, what_is_wrong

import cellcolor
from cellcolor.arrays import Array
from cellcolor.data.candidate_table import CandidateTable
from cellcolor.data.surface import LabelledSurface
from cellcolor.lab.families import MEDIUM, SHAPES, SMALL, blobs, voronoi

ROOT = Path(__file__).resolve().parents[1]
SCENES = sorted((ROOT / "instances" / "scenes").glob("*.surface.json"))
STORED = sorted(set((ROOT / "instances").rglob("*.surface.json")) - set(SCENES))
DRAWS = 18  # directions of the raster, and seeds
LIMIT = 20.0  # seconds for each proof
LARGEST = 600  # vertices, of a surface whose proofs are tampered with
SUITE_SURFACES = PLANS_EACH = 10
SUITE = """
import json
from pathlib import Path

import pytest

PLANS = json.loads(Path("plans.json").read_text())


@pytest.mark.parametrize("number", range(len(PLANS)))
def test_plan(cellcolor_oracle, number):
    name, colors = PLANS[number]
    cellcolor_oracle(name).assert_valid(colors)
"""
COUNTING = """
import cellcolor.door.oracle as module

prove = module.prove


def counted(surface, *arguments, **options):
    with open("proved.txt", "a") as file:
        print(surface.name, file=file)
    return prove(surface, *arguments, **options)


module.prove = counted
"""
"""What a suite's ``conftest.py`` does: a line for each surface that is proved."""


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
            row = (
                True,
                verdict.optimal is True,
                bool(verdict.beatable_by),
                verdict.beatable_by is None,
                bool(wrong),
            )
            for column, holds in zip(columns, row, strict=True):
                found[column][sort] += holds
    print(f"{len(pool)} surfaces, the minimum of {exact} is known\n")
    print(f"| plans | {' | '.join(columns)} |\n|---|{'--:|' * len(columns)}")
    for sort in SORTS:
        print(f"| {sort} | {' | '.join(str(found[column][sort]) for column in columns)} |")
    print(f"| all | {' | '.join(str(found[column].total()) for column in columns)} |")
    return not found[columns[-1]].total()


def tampered(count: int) -> bool:
    """Change what is kept, judge with it and print; whether nothing was believed."""
    pool = [surface for surface, _ in surfaces()]
    pairs = zip(pool, [*pool[1:], pool[0]], strict=True)
    small = [Kept(*pair) for pair in pairs if len(pair[0].vertices) < LARGEST]
    made, believed, names = Counter[str](), Counter[str](), list(TAMPERERS)
    for number in itertools.count():
        if made.total() == count:
            break
        # Shifted by one each round, so that every sort meets every surface.
        name, round_number = names[number % len(names)], number // len(names)
        kept = small[(number + round_number) % len(small)]
        random = np.random.default_rng(number)
        tamper, proves_nothing = TAMPERERS[name]
        content = tamper(kept, random)
        if is_honest(kept, content):
            continue
        wrong = what_is_wrong(kept, content, proves_nothing, random)
        made[name] += 1
        believed[name] += bool(wrong)
        for text in wrong:
            print(f"{name}, seed {number}, {kept.surface.name}: {text}", flush=True)
    print(f"{len(small)} surfaces, each with its minimum proved\n")
    print("| what was kept is changed | times | believed, or a traceback |\n|---|--:|--:|")
    for name in names:
        print(f"| {name} | {made[name]} | {believed[name]} |")
    print(f"| all | {made.total()} | {believed.total()} |")
    return not believed.total()


def planners() -> bool:
    """Lift-offs of three planners on the six scenes, beside the proven minimum."""
    print("| scene | fewest, proved | greedy | nearest along a raster | random, mended |")
    print("|---|--:|--:|--:|--:|")
    for file in SCENES:
        print(f"| {' | '.join(row_of_planners(file))} |", flush=True)
    return True


def row_of_planners(file: Path) -> list[str]:
    """The table's row of one scene, from its stored surface and the configurations beside it."""
    surface = LabelledSurface.read(file)
    configurations = configurations_of(surface, CandidateTable.beside(surface, file))
    oracle = cellcolor.Oracle(surface)

    def lift_offs(colors: Colors) -> int:
        found = oracle.judge(colors).lift_offs
        assert found is not None
        return found

    def spread(numbers: list[int]) -> str:
        return f"{min(numbers)}, {median(numbers):g}, {max(numbers)}"

    angles = np.arange(DRAWS) * np.pi / DRAWS
    randoms = [np.random.default_rng(seed) for seed in range(DRAWS)]
    assert oracle.bounds.exact
    return [
        file.name.removesuffix(".surface.json"),
        str(max(0, oracle.bounds.lower - 1)),
        str(lift_offs(largest_set_first(surface))),
        spread([lift_offs(nearest_along_raster(surface, configurations, a)) for a in angles]),
        spread([lift_offs(random_branches(surface, random)) for random in randoms]),
    ]


def speed() -> bool:
    """How long a verdict takes, and what the second run of a suite proves again."""
    print(f"Load {os.getloadavg()[0]:.1f}\n")
    print(
        "| surface | vertices | its proof, s | first plan, s | further plans, median and worst s |"
    )
    print("|---|--:|--:|--:|--:|")
    for surface in large_surfaces():
        oracle = cellcolor.Oracle(surface)
        random = np.random.default_rng(0)
        proof = _seconds(lambda oracle=oracle: oracle.bounds)
        makers = (any_colors, in_patches, random_branches)
        plans = [make(surface, random) for make in makers for _ in range(10)]
        first, *further = [
            _seconds(lambda oracle=oracle, colors=colors: oracle.judge(colors)) for colors in plans
        ]
        row = [surface.name, str(len(surface.vertices)), f"{proof:.2f}", f"{first:.2f}"]
        row.append(f"{median(further):.2f}, {max(further):.2f}")
        print(f"| {' | '.join(row)} |", flush=True)
    print("\n| run of a suite of 100 plans on 10 surfaces | proved | kept anew | passed, failed |")
    print("|---|--:|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        runs = [run_of_suite(Path(folder)) for _ in range(2)]
    for name, run in zip(("first", "second"), runs, strict=True):
        print(f"| {name} | {' | '.join(map(str, run[:2]))} | {run[2]}, {run[3]} |")
    plans = SUITE_SURFACES * PLANS_EACH
    return runs == [(SUITE_SURFACES, SUITE_SURFACES, plans, 0), (0, 0, plans, 0)]


def large_surfaces() -> Iterator[LabelledSurface]:
    """Random colors on a sheet, and two scenes finer than they are stored."""
    from cellcolor.frontend import Scene, build_surface  # the other tables need no extra

    yield blobs(3, 90, 8)
    for name in ("wok", "hemisphere_tilted"):
        scene = Scene.read(ROOT / "instances" / "scenes" / f"{name}.toml")
        yield build_surface(scene.varied(object={"target_vertices": 8000})).surface


def run_of_suite(folder: Path) -> tuple[int, int, int, int]:
    """Run pytest in a process of its own on a suite of plans, which is written the first time.

    Returns:
        Surfaces proved, files in the cache that are new or changed, tests passed and failed.
    """
    if not (folder / "plans.json").exists():
        _write_suite(folder)
    cache = folder / ".pytest_cache" / "d" / "cellcolor"
    before = _states(cache)
    (folder / "proved.txt").write_text("")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:xdist", "--tb=no"]
    done = subprocess.run(
        command,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    after = _states(cache)
    proved = len((folder / "proved.txt").read_text().splitlines())
    changed = sum(before.get(name) != state for name, state in after.items())
    passed, failed = (
        int(found[1]) if (found := re.search(rf"(\d+) {word}", done.stdout)) else 0
        for word in ("passed", "failed")
    )
    return proved, changed, passed, failed


def _write_suite(folder: Path) -> None:
    """Some plans on each of some surfaces: valid ones of all sorts; most can be beaten."""
    plans = []
    for seed in range(SUITE_SURFACES):
        surface = blobs(seed, 24, 6)
        name = f"{seed}.surface.json"
        (folder / name).write_text(surface.to_json(), encoding="utf-8")
        made = valid_plans(cellcolor.Oracle(surface), np.random.default_rng(seed))
        plans += [(name, colors) for _, (_, colors) in zip(range(PLANS_EACH), made, strict=False)]
    (folder / "plans.json").write_text(json.dumps(plans), encoding="utf-8")
    (folder / "test_plans.py").write_text(SUITE, encoding="utf-8")
    (folder / "conftest.py").write_text(COUNTING, encoding="utf-8")


def _states(folder: Path) -> dict[str, tuple[int, int]]:
    return {
        file.name: (file.stat().st_ino, file.stat().st_mtime_ns) for file in folder.glob("*.json")
    }


def _seconds(what: Callable[[], object]) -> float:
    begun = time.monotonic()
    what()
    return time.monotonic() - begun


def main() -> int:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    tables = parser.add_subparsers(dest="table", required=True)
    tables.add_parser("faults").add_argument("count", nargs="?", type=int, default=1000)
    tables.add_parser("valid").add_argument("count", nargs="?", type=int, default=10_000)
    tables.add_parser("tampered").add_argument("count", nargs="?", type=int, default=500)
    tables.add_parser("speed")
    tables.add_parser("planners")
    chosen = parser.parse_args()
    if chosen.table in ("faults", "valid", "tampered"):
        counted = {"faults": faults, "valid": valid, "tampered": tampered}
        good = counted[chosen.table](chosen.count)
    else:
        good = {"speed": speed, "planners": planners}[chosen.table]()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
