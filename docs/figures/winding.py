"""Draw the winding of docs/motion.md: ``python docs/figures/winding.py [FOLDER]``.

A flat ring about the robot's base, for an arm whose first joint turns by 200 degrees each way: the
path as it is laid out overruns that joint, and the one between walls does not.
"""

from __future__ import annotations

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests" / "support"))
from motions import planned_scene, ring_scene

from cellcolor.motion.following import follow, sampled
from cellcolor.tool_paths.cover import cover
from cellcolor.tool_paths.region import Segments

LIMIT = 200.0  # degrees


def main(folder: Path) -> None:
    """Both paths on the ring, and the first joint along them."""
    ring = planned_scene(ring_scene(np.deg2rad(LIMIT)))
    motion = ring.prepared.setup.motion
    assert motion is not None
    color = max(color for color in ring.painted.plan.vertex_colors if color is not None)
    covered = cover(
        Segments(ring.painted.surface, ring.painted.segment_of, [color], ring.normals),
        spacing_m=motion.spacing_m,
        tool_radius_m=motion.tool_radius_m,
    )
    (naive,) = covered.paths.paths
    samples = sampled(naive)
    branch = ring.built.coloring.branch[color]
    followed = follow(ring.prepared, samples, branch).joints[:, 0]
    # The start turn that keeps it inside the longest.
    trajectory = ring.plan.trajectory
    chosen = trajectory.joints[trajectory.contact][:, 0]
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), width_ratios=(1, 1, 1.5))
    vertices, faces = ring.painted.surface.vertices, ring.painted.surface.faces
    for axis, points, title in (
        (axes[0], samples.points, "as laid out first"),
        (axes[1], trajectory.points[trajectory.contact], "between walls"),
    ):
        axis.triplot(vertices[:, 0], vertices[:, 1], faces, color="0.9", linewidth=0.4, zorder=0)
        axis.plot(points[:, 0], points[:, 1], color="tab:blue", linewidth=0.8)
        axis.plot(0, 0, "k+")
        axis.set_aspect("equal")
        axis.set_title(title)
        axis.axis("off")
    axes[2].axhspan(-LIMIT, LIMIT, color="tab:green", alpha=0.1)
    axes[2].plot(
        np.arange(len(followed)) / 1000,
        np.rad2deg(followed),
        color="0.5",
        label="as laid out first",
    )
    axes[2].plot(
        np.arange(len(chosen)) / 1000, np.rad2deg(chosen), color="tab:blue", label="between walls"
    )
    axes[2].set_xlabel("way of the tool in m")
    axes[2].set_ylabel("first joint in degrees")
    axes[2].legend()
    figure.tight_layout()
    figure.savefig(folder / "winding.png", dpi=90)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
