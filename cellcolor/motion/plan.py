"""From a painting to a trajectory: tool paths that the arm can follow, and the arm on them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cellcolor.data.tool_paths import ToolPaths
from cellcolor.data.trajectory import LeftOut, Trajectory
from cellcolor.deadline import NEVER, Deadline
from cellcolor.errors import InputError
from cellcolor.frontend.build import BuildResult, Progress, StageClock
from cellcolor.motion.assembly import assembled
from cellcolor.motion.following import joint_space
from cellcolor.motion.limits import motion_of, speeds_of
from cellcolor.motion.order import ordered
from cellcolor.motion.segment import Ground, strokes_of
from cellcolor.motion.small_triangles import corner_states
from cellcolor.motion.strokes import Stroke
from cellcolor.motion.transfers import Transfers
from cellcolor.motion.ways import Transfer
from cellcolor.painting.paint import Painted
from cellcolor.tool_paths.cover import check_spacing
from cellcolor.tool_paths.region import Segments
from cellcolor.tool_paths.registry import DEFAULT_PATTERN


@dataclass(frozen=True)
class MotionPlan:
    """A motion over a painted surface.

    Attributes:
        paths: the tool paths that the trajectory follows.
        trajectory: the arm on them.
        cut_off: the colors of the strokes that no planned moves join to the home position, or
            to most of the other strokes without one.
    """

    paths: ToolPaths
    trajectory: Trajectory
    cut_off: tuple[int, ...]


def plan_motion(
    built: BuildResult,
    painted: Painted,
    *,
    pattern: str = DEFAULT_PATTERN,
    seed: int = 0,
    deadline: Deadline = NEVER,
    progress: Progress | None = None,
    on_paths: Callable[[ToolPaths], None] | None = None,
) -> MotionPlan:
    """Plan a motion that covers a painted surface (docs/motion.md).

    Args:
        seed: of the configurations that moves may lead over; the same seed gives the same motion.
        on_paths: called with the tool paths once they are laid, before the arm moves on them.

    Raises:
        InputError: the setup has no motion, or one that does not fit the arm, or the arm can
            follow no path at all.
    """
    prepared = built.prepared
    motion = motion_of(prepared)
    speeds = speeds_of(motion, prepared.robot)
    # Refuses a home that is no place for the arm, before anything takes time.
    planner = Transfers(prepared, motion, speeds.velocities, seed, deadline)
    clock = StageClock(deadline, progress)
    surface, segment_of = painted.surface, painted.segment_of
    check_spacing(surface, segment_of, motion.spacing_m)
    color_of = _colors(painted)
    own_branch = np.array([built.color_branch[color] for color in color_of], dtype=np.int64)
    # Not of length 1: so their means are on the same way as those of the given surface.
    normals = painted.interpolated(built.prepared.surface.normals)
    segments = Segments(surface, segment_of, color_of, normals)
    with clock.timed("corners of small triangles"):
        states = corner_states(prepared, segments, own_branch, deadline)
    ground = Ground(prepared, segments, states, pattern, motion, deadline)
    with clock.timed("tool paths"):
        found = [
            strokes_of(ground, segment, int(own_branch[segment]))
            for segment in np.unique(segment_of[segment_of >= 0]).tolist()
        ]
    covered = [laid for laid, _ in found]
    paths = ToolPaths(
        surface.name,
        pattern,
        motion.spacing_m,
        motion.tool_radius_m,
        tuple(path for laid in covered for path in laid.paths.paths),
        surface.sha256,
    )
    if on_paths is not None:
        on_paths(paths)
    strokes = [stroke for _, own in found for stroke in own]
    uncovered = [place for laid in covered for place in laid.uncovered]
    left_out = tuple(sorted(uncovered, key=lambda part: (-part.area_m2, part.segment, part.place)))
    if not strokes:
        whole = float(surface.mesh.vertex_areas[segment_of >= 0].sum())
        raise InputError(None, None, _no_stroke(whole, left_out, motion.spacing_m))
    with clock.timed("order of strokes"):
        strokes = ordered(strokes, joint_space(prepared), speeds.velocities, planner.home, deadline)
    with clock.timed("transfers"):
        strokes, transfers = planner.between_strokes(strokes)
    with clock.timed("times"):
        trajectory = assembled(prepared.robot, motion, speeds, strokes, transfers, deadline)
    trajectory = replace(
        trajectory,
        name=surface.name,
        left_out=left_out,
        meta={"pattern": pattern, "seed": seed} | trajectory.meta,
    )
    return MotionPlan(
        paths,
        trajectory,
        _cut_off(strokes, transfers, color_of, planner.home is not None),
    )


def _cut_off(
    strokes: Sequence[Stroke], transfers: Sequence[Transfer], color_of: Sequence[int], home: bool
) -> tuple[int, ...]:
    """See :attr:`MotionPlan.cut_off`; the first and the last move lead from and to home."""
    gaps = [transfer.gap is not None for transfer in transfers]
    group = np.cumsum(gaps[:-1])  # of each stroke: how many gaps are before it
    if home:
        group[group == group[-1] + gaps[-1]] = 0  # what leads home begins there as well
        main = 0
    else:
        main = int(np.bincount(group, [len(stroke) for stroke in strokes]).argmax())
    off = {
        color_of[stroke.segment]
        for stroke, own in zip(strokes, group.tolist(), strict=True)
        if own != main
    }
    return tuple(sorted(off))


def _colors(painted: Painted) -> list[int]:
    """The color of each segment, 0 for numbers that no vertex has."""
    colors = [0] * (int(painted.segment_of.max(initial=-1)) + 1)
    for segment, color in zip(painted.segment_of.tolist(), painted.plan.vertex_colors, strict=True):
        if segment >= 0 and color is not None:
            colors[segment] = color
    return colors


def _no_stroke(whole: float, left_out: Sequence[LeftOut], spacing_m: float) -> str:
    """Why the arm can follow no path on segments of this area in m^2, and what to try."""
    why = "the arm can follow no path on any segment"
    areas: defaultdict[str, float] = defaultdict(float)
    for part in left_out:
        areas[part.reason] += part.area_m2
    if not areas or sum(areas.values()) < whole / 2:
        return (
            f"{why}: it can follow only stretches shorter than motion.spacing_m, "
            f"{spacing_m:g} m; try a smaller one"
        )
    most = sorted(areas.items(), key=lambda item: -item[1])[:3]
    shares = ", ".join(f"{area / whole:.0%} ({reason})" for reason, area in most)
    return (
        f"{why}: left out of the segments' area: {shares}; try a finer mesh, or move the part to "
        "where these tests pass with more room"
    )
