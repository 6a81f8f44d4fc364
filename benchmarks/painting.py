"""Paint many solutions, and look at each painting: ``python benchmarks/painting.py [TABLE …]``.

- ``families``: every random family that makes surfaces, ``--count`` seeds of each. Divisions are
  drawn at random, which divides far more cells than any solver does; with ``--solve SECONDS`` they
  are solved instead, in the search space ``surface``.
- ``library``: every surface of the instance library, solved in both search spaces.
- ``scenes``: the six scenes without sliver policy, at 500, 2,000 and 8,000 vertices, likewise.

A painting is counted if it is valid, every segment is one connected set of vertices, and it has as
many segments as its solution (fewer only where parts are named that touch). All else is printed
with its seed. Added vertices are a share of those that the surface had; seconds are of CPU.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import Decomposition, decomposition_of
from cellcolor.lab.families.registry import LARGE, MEDIUM, SMALL, Family
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import paint
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "support"))

from painted import assert_whole, random_solution  # noqa: E402

SIZES = (500, 2_000, 8_000)
SECONDS = 60.0  # to solve one file of the library, or one scene

FAMILIES: dict[str, Family] = {
    f"{size}: {name}": family
    for size, group in (("small", SMALL), ("medium", MEDIUM), ("large", LARGE))
    for name, family in group.items()
    if isinstance(family(0), LabelledSurface)
}


@dataclass
class Row:
    """What became of all paintings of one kind."""

    kind: str
    divided: int = 0
    shares: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    moving: list[float] = field(default_factory=list)
    lengths: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    def paint(
        self, name: str, surface: LabelledSurface, decomposition: Decomposition, found: Solution
    ) -> None:
        """Paint a solution and note what came of it."""
        self.divided += sum(len(cell.subcells) > 1 for cell in found.cells or ())
        started = time.process_time()
        try:
            painted = paint(surface, decomposition, found, Deadline.after(600))
            drawn = time.process_time()
            moved = move_borders(painted)
            finished = time.process_time()
            assert_whole(surface, painted, found)
            assert_whole(surface, moved, found)
            assert moved.segments == painted.segments and moved.borders is not None
        except Exception as error:  # whatever happens is a failure to be listed
            self.failures.append(f"{self.kind} {name}: {type(error).__name__}: {error}")
            return
        before, after = len(surface.vertices), len(painted.surface.vertices)
        self.shares.append((after - before) / before)
        self.seconds.append(drawn - started)
        self.moving.append(finished - drawn)
        if moved.borders.before.length_m:
            self.lengths.append(moved.borders.after.length_m / moved.borders.before.length_m)

    def __str__(self) -> str:
        done, failed = len(self.shares), len(self.failures)
        added = _spread(self.shares, "{:.0%}")
        lengths = f"{median(self.lengths):.0%}" if self.lengths else ""
        times = f"{_spread(self.seconds, '{:.2f}')} | {_spread(self.moving, '{:.2f}')}"
        counts = f"{done + failed} | {self.divided} | {done}"
        return f"| {self.kind} | {counts} | {added} | {lengths} | {times} |"


def _spread(values: list[float], kind: str) -> str:
    """Median and greatest, as two cells of a table."""
    return f"{kind.format(median(values))} | {kind.format(max(values))}" if values else " | "


def families(kinds: list[str], count: int, first: int, limit: float | None) -> Iterator[Row]:
    """One row for each family."""
    for kind in kinds:
        row = Row(kind)
        for seed in range(first, first + count):
            surface = FAMILIES[kind](seed)
            assert isinstance(surface, LabelledSurface)
            decomposition = decomposition_of(surface)
            rng = random.Random(f"{kind} {seed}")
            if limit is None:
                found = random_solution(decomposition.instance, rng.randint(1, 3), rng)
            else:
                options = Options("surface", deadline=Deadline.after(limit))
                found = solve(decomposition.instance, options)
            if found.cells is not None:
                row.paint(str(seed), surface, decomposition, found)
        yield row


def library() -> Iterator[Row]:
    """One row for each search space."""
    files = sorted((ROOT / "instances").rglob("*.surface.json"))
    yield from _both_spaces("library", [(f.name, LabelledSurface.read(f)) for f in files])


def scenes() -> Iterator[Row]:
    """One row for each size and search space."""
    from cellcolor.frontend import Scene, build_surface

    for size in SIZES:
        surfaces = []
        for file in sorted((ROOT / "instances" / "scenes").glob("*.toml")):
            scene = Scene.read(file)
            setup = scene.setup.varied(slivers=None)
            scene = scene.varied(setup=setup, object={"target_vertices": size})
            surfaces.append((file.stem, build_surface(scene).surface))
        yield from _both_spaces(f"scenes, {size:,} vertices", surfaces)


def _both_spaces(kind: str, surfaces: list[tuple[str, LabelledSurface]]) -> Iterator[Row]:
    for space in ("paper", "surface"):
        row = Row(f"{kind}, `{space}`")
        for name, surface in surfaces:
            decomposition = decomposition_of(surface)
            options = Options(space, deadline=Deadline.after(SECONDS))
            row.paint(name, surface, decomposition, solve(decomposition.instance, options))
        yield row


def main() -> int:
    """Print the tables, then what failed; the exit code says whether anything did."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    names = ("families", "library", "scenes")
    parser.add_argument("tables", nargs="*", choices=[*names, []], metavar="TABLE")
    parser.add_argument("--kinds", nargs="+", choices=list(FAMILIES), default=list(FAMILIES))
    parser.add_argument("--count", type=int, default=200, help="seeds of each family")
    parser.add_argument("--seed", type=int, default=0, help="the first one")
    parser.add_argument("--solve", type=float, metavar="SECONDS", help="solve the families' draws")
    arguments = parser.parse_args()
    failures: list[str] = []
    columns = "added | worst | length | drawn s | worst | moved s | worst"
    print(f"| kind | draws | divided cells | painted | {columns} |")
    print(f"|---|{'--:|' * 10}")
    for table in arguments.tables or names:
        if table == "families":
            rows = families(arguments.kinds, arguments.count, arguments.seed, arguments.solve)
        else:
            rows = library() if table == "library" else scenes()
        for row in rows:
            print(row, flush=True)
            failures += row.failures
    print(*failures, sep="\n")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(main())
