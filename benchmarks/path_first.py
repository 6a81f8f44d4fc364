"""What planners pay that choose the path first: ``python benchmarks/path_first.py [SCENE …]``.

A raster path over each scene's surface, back and forth in strips, in 18 directions; then the best
choice of inverse-kinematic branches along it. Prints the best, the median and the worst number of
lift-offs of the directions as Markdown, beside the proven minimum.

See :mod:`cellcolor.lab.path_first` for why a planner of this kind pays at least that much.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from statistics import median

import numpy as np

import cellcolor
from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.frontend import build_surface
from cellcolor.lab.path_first import fewest_lift_offs, raster

ROOT = Path(__file__).resolve().parents[1]
DIRECTIONS = 18


def row(path: Path) -> str:
    """The table's row of one scene."""
    built = build_surface(path)
    valid: Mask = built.reasons == VALID
    # Points that a sliver policy gave up are left out on both sides of the comparison.
    covered = (built.node_color >= 0).any(axis=1)
    counts: list[int] = []
    angles: Array = np.arange(DIRECTIONS) * np.pi / DIRECTIONS
    for angle in angles:
        order = raster(built.surface, float(angle))
        counts.append(fewest_lift_offs(valid[order[covered[order]]]))
    proved = cellcolor.solve(built)
    assert proved.solution.proved_for_surface
    spread = f"{min(counts)} | {median(counts):g} | {max(counts)}"
    return f"| {path.stem} | {spread} | {proved.solution.lift_offs} |"


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", metavar="SCENE", nargs="*", type=Path)
    scenes = parser.parse_args().scenes or sorted((ROOT / "instances" / "scenes").glob("*.toml"))
    print("| scene | path first: best | median | worst | fewest, proved |")
    print("|---|--:|--:|--:|--:|")
    for scene in scenes:
        print(row(scene), flush=True)


if __name__ == "__main__":
    main()
