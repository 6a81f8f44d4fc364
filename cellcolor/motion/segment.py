"""The strokes of one segment: paths that the arm can follow, one stroke if possible.

Paths are laid out, followed and judged, and laid out again without the places that fail. Where one
stroke is not enough, each further one has its reason.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Mask
from cellcolor.data.candidate_table import VALID
from cellcolor.data.tool_paths import ToolPath
from cellcolor.deadline import Deadline
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.setup import Motion
from cellcolor.motion.following import (
    Followed,
    Samples,
    blocked,
    bowed,
    even_places,
    follow,
    joint_space,
    normals_at,
    off_way,
    sampled,
    unwound,
)
from cellcolor.motion.small_triangles import JUMP, ArmRefusals, CornerStates
from cellcolor.motion.strokes import Parting, Stroke, cut_where_full, trimmed
from cellcolor.motion.windings import steps_of, walls_of
from cellcolor.tool_paths.cover import Covered, cover
from cellcolor.tool_paths.region import Overlap, Segments

_SHORT = 2.0  # spacings; no place of such a stroke is as large as a footprint
_SPARED = 0.005  # of the strokes' length, at most, of what is left out because it is short

_AROUND = 0.2  # spacings; so far from a sample that fails no path is laid
_ROUNDS = 5  # of paths laid out; what still fails on the last ones is cut out of them
_FARTHEST = 0.4  # rad, m; of a joint from a sample to the next
_HALVINGS = 9  # of a step in which one goes farther, or the tool leaves its way
_BETWEEN = (0.25, 0.5, 0.75)  # of a step, where that is tested


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
        covered, strokes = _laid_out(ground, segment, branch, refusals, overlap=overlap)
        if len(strokes) == 1 and space.fits(strokes[0].joints):
            return covered, strokes
    refusals = refused_near(own)
    covered, strokes = _laid_out(ground, segment, branch, refusals)
    if all(space.fits(stroke.joints) for stroke in strokes):
        return covered, strokes
    return _between_walls(ground, segment, branch, refusals, len(strokes))


def _laid_out(
    ground: Ground,
    segment: int,
    branch: int,
    refusals: ArmRefusals,
    walls: Collection[tuple[int, int]] = (),
    overlap: Overlap | None = None,
) -> tuple[Covered, list[Stroke]]:
    """Lay out the paths of a segment, and again without the places where a sample fails.

    Hardly any sample of the last ones fails; those that still do are cut out.
    """
    segments, motion, prepared = ground.segments, ground.motion, ground.prepared
    alone = np.where(segments.segment_of == segment, segment, -1)
    names, spacing = prepared.judge.reason_names, motion.spacing_m
    for left in reversed(range(_ROUNDS)):
        covered = cover(
            segments._replace(segment_of=alone),
            pattern=ground.pattern,
            spacing_m=spacing,
            tool_radius_m=motion.tool_radius_m,
            walls=walls,
            refusals=refusals,
            overlap=overlap,
            deadline=ground.deadline,
        )
        courses = [
            course(ground, path, even_places(path, corners), branch)
            for path, corners in zip(covered.paths.paths, covered.along_border, strict=True)
        ]
        if not left or all(followed.good for _, followed in courses):
            break
        for samples, followed in courses:
            for at, why in _failures(followed, names):
                refusals.add(int(samples.faces[at]), samples.points[at], why)
    found: list[Stroke] = []
    for path, (samples, followed) in zip(covered.paths.paths, courses, strict=True):
        space = joint_space(prepared)
        parts = trimmed(segment, branch, samples, followed, spacing, names, space)
        if parts and found:
            text = "places that no sample may touch divide the segment"
            parts[0] = replace(parts[0], parting=Parting("trimmed", text, path.points[0]))
        found += parts
    return covered, _worth_a_lift_off(found, spacing)


def course(ground: Ground, path: ToolPath, places: Array, branch: int) -> tuple[Samples, Followed]:
    """A branch along a path, with samples so close that joints may move evenly between them.

    A step is halved where a joint moves far, as beside a singularity, where the tool leaves its way
    or the surface's normal between the samples, as beside a sharp edge, and where a configuration
    between them fails a test. A step that still does on the last round is torn.
    """

    prepared, deadline = ground.prepared, ground.deadline
    mesh, normals = ground.segments.surface.mesh, ground.segments.normals

    def at(places: Array) -> Samples:
        points, faces = sampled(path, places)
        return Samples(points, normals_at(mesh, normals, faces, points), faces)

    samples = at(places)
    followed = follow(prepared, samples, branch, deadline)
    for halvings in range(_HALVINGS + 1):
        joints, reasons, torn = followed.joints, followed.reasons, followed.torn
        valid = reasons == VALID
        bad = np.abs(np.diff(joints, axis=0)).max(axis=1) > _FARTHEST
        bad |= bowed(prepared.robot, joints)
        for share in _BETWEEN:
            way = joints[:-1] + share * np.diff(joints, axis=0)
            inner = places[:-1] + share * np.diff(places)
            points, faces = sampled(path, inner)
            bad |= off_way(prepared.robot, way, points, partial(normals_at, mesh, normals, faces))
        ends = valid[:-1] & valid[1:] & ~torn
        bad &= ends
        if not bad.any():
            bad = blocked(prepared, joints, ends, deadline)
        rows = np.flatnonzero(bad)
        if not len(rows) or halvings == _HALVINGS:
            break
        # Only the new samples are followed, each between its neighbors.
        middle = (places[rows] + places[rows + 1]) / 2
        threes = np.column_stack([places[rows], middle, places[rows + 1]]).ravel()
        between = follow(prepared, at(threes), branch, deadline, together=3)
        places = np.insert(places, rows + 1, middle)
        joints = np.insert(joints, rows + 1, between.joints[1::3], axis=0)
        torn = torn.copy()
        torn[rows] = between.torn[::3]
        followed = Followed(
            unwound(joints, joint_space(prepared)),
            np.insert(reasons, rows + 1, between.reasons[1::3]),
            np.insert(torn, rows + 1, between.torn[1::3]),
        )
        samples = at(places)
    return samples, replace(followed, torn=followed.torn | bad)


def _failures(followed: Followed, names: tuple[str, ...]) -> Iterator[tuple[int, str]]:
    """The samples that fail, and why; of two that are torn from each other both do."""
    for at in np.flatnonzero(followed.reasons != VALID).tolist():
        yield at, names[followed.reasons[at]]
    for at in np.flatnonzero(followed.torn).tolist():
        yield at, JUMP
        yield at + 1, JUMP


def _between_walls(
    ground: Ground, segment: int, branch: int, refusals: ArmRefusals, parted: int
) -> tuple[Covered, list[Stroke]]:
    """As :func:`strokes_of`, with walls between which the joints stay in their limits.

    Args:
        parted: how many strokes there are without walls.
    """
    surface = ground.segments.surface
    space, names = joint_space(ground.prepared), ground.prepared.robot.joint_names
    color = ground.segments.colors[segment]
    cracks = [crack for crack in surface.cracks if color in crack.colors]
    closed = surface.mesh.marked([(crack.i, crack.j) for crack in cracks])
    steps = steps_of(ground.states, space, segment, closed)
    walls, joint = walls_of(steps, space)
    covered, strokes = _laid_out(ground, segment, branch, refusals, walls)
    if joint is not None:
        text = f"{names[joint]} cannot follow the whole segment"
        for at in range(parted, len(strokes)):
            parting = Parting("winding", text, strokes[at].points[0])
            strokes[at] = replace(strokes[at], parting=parting)
    cut = [part for stroke in strokes for part in cut_where_full(stroke, space, names)]
    return covered, _worth_a_lift_off(cut, ground.motion.spacing_m)


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
