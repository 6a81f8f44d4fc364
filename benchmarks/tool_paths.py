"""Tool paths on the six scenes: what each pattern covers, how often it passes, how long it takes.

    python benchmarks/tool_paths.py [VERTICES …]

Each scene is built at that many vertices (1000 and 2000), solved, painted and covered at 10 mm.
``docs/tool-paths.md`` has what it printed. Time is processor time.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

import cellcolor
from cellcolor.frontend import Scene
from cellcolor.frontend.prepared import prepare
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.registry import PATTERNS

SCENES = Path(__file__).parents[1] / "instances" / "scenes"
SPACING, RADIUS = 0.010, 0.015  # m, as in the setup


def main() -> None:
    """Print a row for each scene and pattern, and the worst segment of it."""
    print("| scene | vertices | pattern | in 1.5 | in 0.75 | worst | visits | worst | most | length"
          " | turns | step | s |")  # fmt: skip
    print("|---|--:|---|" + "--:|" * 10)
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
                    painted.surface, painted.segment_of, colors, normals, pattern=pattern,
                    spacing_m=SPACING, tool_radius_m=RADIUS,
                )  # fmt: skip
                spent = time.process_time() - begun
                whole, each = found.in_all, found.measures
                print(
                    f"| {file.stem} | {len(painted.surface.vertices)} | {pattern} "
                    f"| {100 * whole.covered_wide:.2f} % | {100 * whole.covered:.2f} % "
                    f"| {100 * min(one.covered for one in each):.2f} % "
                    f"| {whole.mean_visits:.2f} | {max(one.mean_visits for one in each):.2f} "
                    f"| {whole.most_visits} | {whole.density:.2f} "
                    f"| {100 * whole.sharp_turns:.1f} % | {1000 * whole.longest_step_m:.1f} mm "
                    f"| {spent:.1f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
