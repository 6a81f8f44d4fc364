"""Tool paths on the six scenes: what each pattern covers, how often it passes, how long it takes.

    python benchmarks/tool_paths.py [VERTICES …]

Each scene is built at that many vertices (1000 and 2000), solved, painted and covered at 10 mm.
``docs/tool-paths.md`` has what it printed, ``docs/measured/motions.md`` the two columns on lines:
how far a path is from the parabola that fits it best over 2 cm, where it turns by less than 20
degrees within that (root mean square), and turns over 60 degrees in a meter of path. Time is
processor time.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from scipy.signal import savgol_filter

import cellcolor
from cellcolor.arrays import Array
from cellcolor.frontend import Scene
from cellcolor.frontend.prepared import prepare
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.region import Segments
from cellcolor.tool_paths.registry import PATTERNS

SCENES = Path(__file__).parents[1] / "instances" / "scenes"
SPACING, RADIUS = 0.010, 0.015  # m, as in the setup
FINE, WINDOW = 0.0005, 41  # m between samples, and how many are smoothed over: 2 cm


def bends(paths: list[Array]) -> tuple[float, float]:
    """How far paths (k, 3) waver, m, and their sharp turns per meter."""
    wavering, turns, length = [], 0, 0.0
    for points in paths:
        steps = np.diff(points, axis=0)
        points = points[np.append(True, np.linalg.norm(steps, axis=1) > 1e-9)]
        steps = np.diff(points, axis=0)
        each = np.linalg.norm(steps, axis=1)
        along = np.append(0.0, np.cumsum(each))
        length += along[-1]
        units = steps / each[:, None]
        turns += int(((units[1:] * units[:-1]).sum(axis=1) < np.cos(np.radians(60))).sum())
        grid = np.arange(0.0, along[-1], FINE)
        if len(grid) <= WINDOW:
            continue
        even = np.stack([np.interp(grid, along, axis) for axis in points.T], axis=1)
        half = WINDOW // 2
        middle = even[half:-half]
        smooth = savgol_filter(even, WINDOW, 2, axis=0)[half:-half]
        tangent = np.gradient(smooth, axis=0)
        tangent /= np.linalg.norm(tangent, axis=1, keepdims=True) + 1e-15
        off = middle - smooth
        off -= (off * tangent).sum(axis=1, keepdims=True) * tangent
        ahead, behind = even[2 * half :] - middle, middle - even[: -2 * half]
        sizes = np.linalg.norm(ahead, axis=1) * np.linalg.norm(behind, axis=1) + 1e-15
        calm = (ahead * behind).sum(axis=1) / sizes > np.cos(np.radians(20))
        wavering.append(np.linalg.norm(off, axis=1)[calm])
    return float(np.sqrt((np.concatenate(wavering) ** 2).mean())), turns / length


def main() -> None:
    """Print a row for each scene and pattern, and the worst segment of it."""
    print("| scene | vertices | pattern | in 1.5 | in 0.75 | worst | visits | worst | most | length"
          " | turns | step | waves | turns in 1 m | s |")  # fmt: skip
    print("|---|--:|---|" + "--:|" * 12)
    for vertices in [int(text) for text in sys.argv[1:]] or [1000, 2000]:
        for file in sorted(SCENES.glob("*.toml")):
            scene = Scene.read(file).varied(object={"target_vertices": vertices})
            result = cellcolor.solve(scene, search_space="surface")
            painted = cellcolor.paint(scene, result)
            normals = painted.interpolated(prepare(scene).surface.normals)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            cells = result.solution.cells or ()
            color = {sub.segment: sub.color for cell in cells for sub in cell.subcells}
            colors = [color[segment] for segment in sorted(color)]
            for pattern in PATTERNS:
                begun = time.process_time()
                found = cover(
                    Segments(painted.surface, painted.segment_of, colors, normals),
                    pattern=pattern, spacing_m=SPACING, tool_radius_m=RADIUS,
                )  # fmt: skip
                spent = time.process_time() - begun
                whole, each = found.in_all, found.measures
                waves, turns = bends([path.points for path in found.paths.paths])
                print(
                    f"| {file.stem} | {len(painted.surface.vertices)} | {pattern} "
                    f"| {100 * whole.covered_wide:.2f} % | {100 * whole.covered:.2f} % "
                    f"| {100 * min(one.covered for one in each):.2f} % "
                    f"| {whole.mean_visits:.2f} | {max(one.mean_visits for one in each):.2f} "
                    f"| {whole.most_visits} | {whole.density:.2f} "
                    f"| {100 * whole.sharp_turns:.1f} % | {1000 * whole.longest_step_m:.1f} mm "
                    f"| {1000 * waves:.2f} mm | {turns:.1f} "
                    f"| {spent:.1f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
