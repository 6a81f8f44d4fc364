"""Draw what choosing the path first costs on the wok: ``docs/figures/lift_offs.py [FOLDER]``.

Left, seen from above: the raster path whose number of lift-offs is the median of 18 directions,
each stroke in the color of its branch, and its lift-offs. Right: a painting with the proven
minimum.
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
from cellcolor.frontend import Scene, build_surface
from cellcolor.frontend.prepared import prepare
from cellcolor.pictures.palette import AREAS, FAINT, INK, LINES, WARNING

TOP = Path(__file__).resolve().parents[2]
sys.path.append(str(TOP / "benchmarks"))
from path_first import DIRECTIONS, Counted, counted  # noqa: E402


def main(folder: Path) -> None:
    """Draw the wok."""
    scene = Scene.read(TOP / "instances" / "scenes" / "wok.toml")
    assert scene.setup.motion is not None
    built = build_surface(scene)
    prepared = prepare(scene.with_setup(scene.setup.varied(motion=None)))
    angles = (np.arange(DIRECTIONS) * np.pi / DIRECTIONS).tolist()
    each = [counted(prepared, built, angle, scene.setup.motion.spacing_m) for angle in angles]
    each.sort(key=lambda one: one.judged)
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
    _strokes(left, each[len(each) // 2])
    left.set_title(f"a raster path: {each[len(each) // 2].judged} lift-offs", color=INK)
    lift_offs = result.solution.lift_offs
    right.set_title(f"the proven minimum: {lift_offs} lift-off", color=INK)
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
        fills = [FAINT if number < 0 else AREAS[number % len(AREAS)] for number in numbers]
        axes.add_collection(PolyCollection(kites, facecolors=fills, edgecolors=fills))
    axes.autoscale_view()


def _strokes(axes: Axes, one: Counted) -> None:
    names: dict[int, str] = {}
    for stroke in one.strokes:
        color = names.setdefault(stroke.branch, LINES[len(names) % len(LINES)])
        points = one.path.points[stroke.first : stroke.after]
        axes.plot(*points[:, :2].T, color=color, linewidth=1.0)
    for number, stroke in enumerate(one.strokes[1:], 1):
        x, y = one.path.points[stroke.first, :2]
        axes.plot(x, y, "o", color=WARNING, markersize=7)
        axes.annotate(f" {number}", (x, y), color=WARNING, fontsize=11, weight="bold")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
