"""Paint many solutions, and look at each painting: ``python benchmarks/painting.py [FAMILY …]``.

Measures, for random families that make surfaces (all without a name), with divisions drawn at
random, which divide far more cells than any solver does: divided cells, vertices that painting
added as a share of those that the surface had, and seconds of processor time, for painting and for
moving the borders. Each painting has to be valid, with every segment one connected set of vertices
and as many segments as the solution; all else is printed with its seed. docs/measured.md has the
table.
"""

from __future__ import annotations

import argparse
import random
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

from cellcolor.data.solution import Solution
from cellcolor.data.surface import LabelledSurface
from cellcolor.deadline import Deadline
from cellcolor.decomposition import Decomposition, decomposition_of
from cellcolor.lab.families.registry import LARGE, MEDIUM
from cellcolor.painting.moving import move_borders
from cellcolor.painting.paint import paint

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "support"))

from painted import assert_whole, random_solution  # noqa: E402

FAMILIES = {
    f"{size}: {name}": family
    for size, group in (("medium", MEDIUM), ("large", LARGE))
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
            assert moved.segments == painted.segments
        except Exception as error:  # whatever happens is a failure to be listed
            self.failures.append(f"{self.kind} {name}: {type(error).__name__}: {error}")
            return
        before, after = len(surface.vertices), len(painted.surface.vertices)
        self.shares.append((after - before) / before)
        self.seconds.append(drawn - started)
        self.moving.append(finished - drawn)

    def __str__(self) -> str:
        done = len(self.shares)
        added = _spread(self.shares, "{:.0%}")
        times = f"{_spread(self.seconds, '{:.2f}')} | {_spread(self.moving, '{:.2f}')}"
        counts = f"{done} of {done + len(self.failures)} | {self.divided:,}"
        return f"| {self.kind} | {counts} | {added} | {times} |"


def _spread(values: list[float], kind: str) -> str:
    """Median and greatest, as one cell of a table."""
    return f"{kind.format(median(values))}, {kind.format(max(values))}" if values else ""


def painted(kind: str, count: int) -> Row:
    """What became of the first seeds of a family."""
    row = Row(kind)
    for seed in range(count):
        surface = FAMILIES[kind](seed)
        assert isinstance(surface, LabelledSurface)
        decomposition = decomposition_of(surface)
        rng = random.Random(f"{kind} {seed}")
        found = random_solution(decomposition.instance, rng.randint(1, 3), rng)
        row.paint(str(seed), surface, decomposition, found)
    return row


def main() -> int:
    """Print the table, then what failed; the exit code says whether anything did."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("families", nargs="*", metavar="FAMILY", default=list(FAMILIES))
    parser.add_argument("--count", type=int, default=20, help="seeds of each family")
    asked = parser.parse_args()
    failures: list[str] = []
    print("| family | painted | divided cells | vertices added | painting, s | moving, s |")
    print("|---|--:|--:|--:|--:|--:|")
    for kind in asked.families:
        row = painted(kind, asked.count)
        print(row, flush=True)
        failures += row.failures
    print(*failures, sep="\n")
    return int(bool(failures))


if __name__ == "__main__":
    sys.exit(main())
