"""The strokes of one segment: one if possible, otherwise several with the reason."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Mask
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.courses import Course, laid_out
from cellcolor.motion.following import joint_space
from cellcolor.motion.small_triangles import ArmRefusals, CornerStates
from cellcolor.motion.strokes import Parting, Stroke, cut_where_full, trimmed
from cellcolor.motion.windings import steps_of, walls_of
from cellcolor.tool_paths.cover import Bounds, Covered, cover
from cellcolor.tool_paths.region import Overlap, Segments

_SHORT = 2.0  # spacings; no place of such a stroke is as large as a footprint
_SPARED = 0.005  # of the strokes' length, at most, of what is left out because it is short

_AROUND = 0.2  # spacings; so far from a sample that fails no path is laid


@dataclass(frozen=True)
class Ground:
    """What the strokes of all segments have in common.

    Attributes:
        segments: of the painted surface.
        states: what the arm does at the corners of its small triangles.
    """

    prepared: PreparedScene
    segments: Segments
    states: CornerStates
    pattern: str
    motion: Motion
    deadline: Deadline


def strokes_of(ground: Ground, segment: int, branch: int) -> tuple[Covered, list[Stroke]]:
    """Lay out a segment's paths so that the arm can follow them, and follow them.

    They go beyond the segment's border if neighbors are to overlap and one stroke is enough then.
    Walls are put up only where a joint would exceed its limits without them.

    Returns:
        Its tool paths, and the strokes on them, each within the limits of the joints.
    """
    segments, motion, space = ground.segments, ground.motion, joint_space(ground.prepared)
    own = segments.segment_of == segment

    def refused_near(touched: Mask) -> ArmRefusals:
        around = _AROUND * motion.spacing_m
        return ArmRefusals(
            ground.prepared, branch, ground.states, segment, touched, around, ground.deadline
        )

    if motion.overlap_m:
        overlap = Overlap.of(segments, segment, motion.overlap_m)
        refusals = refused_near(overlap.widened(segments.surface, own))
        covered, courses = _courses(ground, segment, branch, refusals, overlap=overlap)
        strokes = _on(ground, courses, branch)
        if len(strokes) == 1 and space.fits(strokes[0].joints):
            return covered, strokes
    refusals = refused_near(own)
    covered, courses = _courses(ground, segment, branch, refusals)
    strokes = _on(ground, courses, branch)
    if all(space.fits(stroke.joints) for stroke in strokes):
        return covered, strokes
    return _between_walls(ground, segment, branch, refusals, len(strokes))


def _courses(
    ground: Ground,
    segment: int,
    branch: int,
    refusals: ArmRefusals,
    walls: Collection[tuple[int, int]] = (),
    overlap: Overlap | None = None,
) -> tuple[Covered, list[Course]]:
    """Paths on a segment, and the arm on them."""
    segments, motion = ground.segments, ground.motion
    alone = np.where(segments.segment_of == segment, segment, -1)

    def lay() -> Covered:
        return cover(
            segments._replace(segment_of=alone),
            pattern=ground.pattern,
            spacing_m=motion.spacing_m,
            tool_radius_m=motion.tool_radius_m,
            bounds=Bounds(walls, refusals, overlap),
            deadline=ground.deadline,
        )

    surface, normals = segments.surface, segments.normals
    return laid_out(ground.prepared, surface, normals, branch, lay, refusals, ground.deadline)


def _between_walls(
    ground: Ground, segment: int, branch: int, refusals: ArmRefusals, parted: int
) -> tuple[Covered, list[Stroke]]:
    """As :func:`strokes_of`, with walls between which the joints stay in their limits.

    Args:
        parted: how many strokes there are without walls.
    """
    surface, mesh = ground.segments.surface, ground.states.small.whole
    space, names = joint_space(ground.prepared), ground.prepared.robot.joint_names
    color = ground.segments.colors[segment]
    cracks = [crack for crack in surface.cracks if color in crack.colors]
    closed = mesh.marked([(crack.i, crack.j) for crack in cracks])
    steps = steps_of(ground.states, segment, closed)
    walls, joint = walls_of(steps, space)
    covered, courses = _courses(ground, segment, branch, refusals, walls)
    strokes = _on(ground, courses, branch)
    if joint is not None:
        text = f"{names[joint]} cannot follow the whole segment"
        for at in range(parted, len(strokes)):
            parting = Parting("winding", text, strokes[at].points[0])
            strokes[at] = replace(strokes[at], parting=parting)
    cut = [part for stroke in strokes for part in cut_where_full(stroke, space, names)]
    return covered, _worth_a_lift_off(cut, ground.motion.spacing_m)


def _on(ground: Ground, courses: list[Course], branch: int) -> list[Stroke]:
    """The strokes on all paths of a segment, what fails cut out of them."""
    found: list[Stroke] = []
    names, space = ground.prepared.judge.reason_names, joint_space(ground.prepared)
    spacing = ground.motion.spacing_m
    for course in courses:
        segment = course.path.segment
        parts = trimmed(segment, branch, course.samples, course.followed, spacing, names, space)
        if parts and found:
            text = "places that no sample may touch divide the segment"
            parting = Parting("trimmed", text, course.path.points[0])
            parts[0] = replace(parts[0], parting=parting)
        found += parts
    return _worth_a_lift_off(found, spacing)


def _worth_a_lift_off(strokes: list[Stroke], spacing: float) -> list[Stroke]:
    """Strokes without those that hardly cover anything that longer ones do not.

    Left out are strokes shorter than two spacings, and those whose every sample is within a spacing
    of a longer one, while what they leave is less than half a percent of the whole length.
    """
    lengths = [stroke.length for stroke in strokes]
    kept: list[int] = []
    spared = _SPARED * sum(lengths)
    for at in sorted(range(len(strokes)), key=lambda at: (-lengths[at], at)):
        if kept:
            points = np.concatenate([strokes[other].points for other in kept])
            beside = cKDTree(points).query(strokes[at].points)[0].max() <= spacing
            short = lengths[at] < _SHORT * spacing and lengths[at] <= spared
            if beside or short:
                spared -= 0.0 if beside else lengths[at]
                continue
        kept.append(at)
    return [
        strokes[at] if number else replace(strokes[at], parting=None)
        for number, at in enumerate(sorted(kept))
    ]
