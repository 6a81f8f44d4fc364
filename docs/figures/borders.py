"""Draw how borders are moved: ``python docs/figures/borders.py [FOLDER]``.

The wok before an obstacle at 2,000 vertices without sliver policy, seen from above: as its
solution is drawn first, and with its borders moved.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from PIL import Image

from cellcolor.arrays import Index
from cellcolor.data.surface import LabelledSurface
from cellcolor.decomposition import decomposition_of
from cellcolor.frontend import Scene, build_surface
from cellcolor.motion.scene_painting import paint_scene
from cellcolor.painting.paint import paint
from cellcolor.solvers.checked import solve
from cellcolor.solvers.interface import Options

SCENE = Path(__file__).resolve().parents[2] / "instances" / "scenes" / "wok_obstacle.toml"
COLORS = ("#4477aa", "#ee6677", "#228833", "#ccbb44", "#66ccee", "#aa3377")
UNREACHED = "#dddddd"


def parts(surface: LabelledSurface, segment_of: Index) -> tuple[np.ndarray, list[str]]:
    """Each triangle in three parts, one for each of its corners, and their colors."""
    corners = surface.vertices[surface.faces][:, :, :2]
    middle, center = (corners + np.roll(corners, -1, axis=1)) / 2, corners.mean(axis=1)
    quadrangles, colors = [], []
    for k in range(3):
        rows = [corners[:, k], middle[:, k], center, middle[:, k - 1]]
        quadrangles.append(np.stack(rows, axis=1))
        own = segment_of[surface.faces[:, k]]
        colors += [COLORS[number % len(COLORS)] if number >= 0 else UNREACHED for number in own]
    return np.concatenate(quadrangles), colors


def main(folder: Path) -> None:
    """Draw both, side by side."""
    scene = Scene.read(SCENE)
    scene = scene.varied(setup=scene.setup.varied(slivers=None), object={"target_vertices": 2000})
    built = build_surface(scene)
    decomposition = decomposition_of(built.surface)
    solution = solve(decomposition.instance, Options("surface"))
    drawn = paint(built.surface, decomposition, solution)
    asked = paint_scene(built, decomposition, solution)
    matplotlib.use("Agg")
    figure, axes = plt.subplots(1, 2, figsize=(8, 4.5), layout="tight")
    for axis, painted, title in (
        (axes[0], drawn, "as drawn first"),
        (axes[1], asked.painted, "borders moved"),
    ):
        areas, colors = parts(painted.surface, painted.segment_of)
        axis.add_collection(PolyCollection(areas, facecolors=colors, edgecolors="face", lw=0.2))
        axis.set(title=title, aspect="equal")
        axis.autoscale_view()
        axis.axis("off")
    target = folder / "borders-moved.png"
    figure.savefig(target, dpi=110)
    with Image.open(target) as large:
        small = large.convert("RGB").quantize(128, dither=Image.Dither.NONE)
    small.save(target, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
