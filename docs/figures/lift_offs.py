"""Draw what choosing the path first costs on the wok: ``docs/figures/lift_offs.py [FOLDER]``.

Left, seen from above: the raster path whose number of lift-offs is the median of 18 directions, and
its lift-offs. Right: a painting with the proved minimum.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

import cellcolor
from cellcolor.arrays import Array, Index
from cellcolor.frontend import build_surface
from cellcolor.pictures.picture import FAINT, INK, LINES, PAINTS, WARNING

TOP = Path(__file__).resolve().parents[2]
sys.path.append(str(TOP / "benchmarks"))
from path_first import DIRECTIONS, counted  # noqa: E402


def main(folder: Path) -> None:
    """Draw the wok."""
    built = build_surface(TOP / "instances" / "scenes" / "wok.toml")
    angles = (np.arange(DIRECTIONS) * np.pi / DIRECTIONS).tolist()
    each = sorted((counted(built, angle) for angle in angles), key=lambda one: len(one[2]))
    path, reached, changes = each[len(each) // 2]
    result = cellcolor.solve(built)
    painted = cellcolor.paint(built, result)
    figure = Figure(figsize=(10, 5), dpi=100)
    left, right = figure.subplots(1, 2)
    for axes in (left, right):
        axes.set_aspect("equal")
        axes.set_axis_off()
    nobody = np.full(len(built.surface.vertices), -1)
    _areas(left, built.surface.vertices, built.surface.faces, nobody)
    _areas(right, painted.surface.vertices, painted.surface.faces, painted.segment_of)
    _strokes(left, path.points[reached], changes)
    left.set_title(f"a raster path: {len(changes)} lift-offs", color=INK)
    lift_offs = result.solution.lift_offs
    right.set_title(f"the proved minimum: {lift_offs} lift-off", color=INK)
    figure.tight_layout()
    figure.savefig(folder / "path-first.png")


def _areas(axes: Axes, vertices: Array, faces: Index, owner: Index) -> None:
    """The third of each triangle that is nearest to a corner has the corner's color."""
    corners = vertices[faces][:, :, :2]
    middle = corners.mean(axis=1)
    for k in range(3):
        here, after, before = (corners[:, (k + turn) % 3] for turn in (0, 1, 2))
        kites = np.stack([here, (here + after) / 2, middle, (here + before) / 2], axis=1)
        numbers = owner[faces[:, k]].tolist()
        fills = [FAINT if number < 0 else PAINTS[number % len(PAINTS)] for number in numbers]
        axes.add_collection(PolyCollection(kites, facecolors=fills, edgecolors=fills))
    axes.autoscale_view()


def _strokes(axes: Axes, points: Array, changes: Index) -> None:
    """The path (n, 3), in another color from each change on."""
    for number, stroke in enumerate(np.split(points, changes)):
        axes.plot(*stroke[:, :2].T, color=LINES[number % len(LINES)], linewidth=1.0)
    for number, (x, y, _) in enumerate(points[changes], 1):
        axes.plot(x, y, "o", color=WARNING, markersize=7)
        axes.annotate(f" {number}", (x, y), color=WARNING, fontsize=11, weight="bold")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
