"""Strokes and the transfers between them, timed and assembled into one trajectory.

It says where strokes run along another pass of their own segment: into a narrow place and back, or
beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from cellcolor.arrays import Array, Index, Mask, stretches
from cellcolor.data.trajectory import ExtraLiftOff, RepeatedStretch, Trajectory
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.setup import Motion
from cellcolor.motion.strokes import Parting, Stroke
from cellcolor.motion.timing import Speeds, evenly_timed, timed
from cellcolor.motion.ways import Transfer

_BESIDE = 0.25  # spacings; passes nearer to each other than that leave the same trace
_APART = 1.0  # spacings along the path, between places of different passes
_FINE = 0.05  # spacings, about, between two of the points that are compared
_ALONG = 0.9  # cosine of the angle up to which two passes run along each other


def retraced(strokes: Sequence[Array], spacing: float) -> list[Mask]:
    """Which points of a segment's strokes have another pass of these strokes beside them.

    Both passes are marked, so it does not matter which of them comes first: a stroke may be
    reversed. A path that is cut at the end of a narrow place goes in on one stroke and comes back
    on the next.

    Args:
        strokes: (k, 3) points on the way of each, in their order, m.
        spacing: desired between passes, m.
    """
    lengths = [np.linalg.norm(np.diff(points, axis=0), axis=1) for points in strokes]
    # With a wide spacing there would be millions of pairs of points a millimeter apart.
    count, length = sum(map(len, strokes)), sum(float(steps.sum()) for steps in lengths)
    every = max(1, int(_FINE * spacing * count / max(length, spacing)))
    ways, thin, begin = [], [], 0.0
    for points, steps in zip(strokes, lengths, strict=True):
        ways.append((begin + np.concatenate([[0.0], np.cumsum(steps)]))[::every])
        thin.append(points[::every])
        begin += float(steps.sum()) + 2 * _APART * spacing  # another stroke is another pass
    way, points = np.concatenate(ways), np.concatenate(thin)
    # From the point before to the one after; zero if there is only one.
    steps = np.concatenate([np.gradient(p, axis=0) if len(p) > 1 else 0 * p for p in thin])
    sizes = np.linalg.norm(steps, axis=1, keepdims=True)
    directions = steps / np.where(sizes > 0, sizes, 1.0)
    near = cKDTree(points).query_pairs(_BESIDE * spacing, output_type="ndarray")
    one, other = near.T
    parallel = np.abs(np.einsum("ij,ij->i", directions[one], directions[other])) >= _ALONG
    passes = near[parallel & (np.abs(way[one] - way[other]) > _APART * spacing)]
    marked = np.zeros(len(points), dtype=bool)
    marked[passes.ravel()] = True
    parts = np.split(marked, np.cumsum([len(own) for own in thin])[:-1])
    return [np.repeat(part, every)[: len(own)] for part, own in zip(parts, strokes, strict=True)]


_NEAR = 0.01  # m, of the tip's way to and from contact, on which it keeps to the approach speed


@dataclass
class _Rows:
    """The samples of a trajectory as they come: times, joints, points, normals and segments."""

    parts: list[tuple[Array, Array, Array, Array, Index]] = field(default_factory=list)
    count: int = 0
    now: float = 0.0

    def add(self, times: Array, joints: Array, points: Array, normals: Array, segment: int) -> None:
        """Samples; their times are those of the trajectory."""
        segments = np.full(len(times), segment, dtype=np.int64)
        self.parts.append((times, joints, points, normals, segments))
        self.count += len(times)


def assembled(
    robot: Robot,
    motion: Motion,
    speeds: Speeds,
    strokes: Sequence[Stroke],
    transfers: Sequence[Transfer],
    deadline: Deadline,
) -> Trajectory:
    """The trajectory: every stroke, and every planned motion in between, from rest to rest.

    Args:
        motion: of the setup; by the distance between passes it decides what is passed twice.
        transfers: the way to the first stroke, those between strokes, and that from the last one.
    """
    rows = _Rows()
    unplanned: dict[int, str] = {}
    extra: list[ExtraLiftOff] = []
    repeated: list[RepeatedStretch] = []
    last_of: dict[int, int] = {}
    between = motion.transfer_speed_m_per_s or np.inf
    approach = min(motion.approach_speed_m_per_s or motion.speed_m_per_s, between)
    marked = _retraced(strokes, motion.spacing_m)
    # Why segments have more than one stroke, as often as they have more.
    partings: dict[int, list[Parting]] = {}
    for stroke in strokes:
        if stroke.parting is not None:
            partings.setdefault(stroke.segment, []).append(stroke.parting)
    for number, transfer in enumerate(transfers):
        deadline.check()
        at_stroke = 1 if number else 0  # the first sample is the stroke's last one
        ends = at_stroke, number < len(strokes)
        gap = _add_transfer(rows, robot, transfer, ends, speeds, (approach, between))
        if gap is not None:
            unplanned[gap] = transfer.blocked
        if number == len(strokes):
            break
        stroke = strokes[number]
        if stroke.segment in last_of:
            why = partings[stroke.segment].pop(0)
            last = last_of[stroke.segment]
            x, y, z = why.place.tolist()
            extra.append(ExtraLiftOff(last, stroke.segment, why.reason, why.text, (x, y, z)))
        begun = _add_stroke(rows, robot, stroke, motion, speeds)
        repeated += [
            RepeatedStretch(begun + first, begun + after - 1, "beside another pass")
            for first, after in stretches(marked[number])
            if after - first > 1
        ]
        last_of[stroke.segment] = begun + len(stroke) - 1
    times, joints, points, normals, segment = map(np.concatenate, zip(*rows.parts, strict=True))
    return Trajectory(
        name="",
        joint_names=robot.joint_names,
        times=times,
        joints=joints,
        points=points,
        normals=normals,
        contact=segment >= 0,
        segment=segment,
        unplanned=tuple(unplanned),
        extra_lift_offs=tuple(extra),
        repeated=tuple(repeated),
        meta={"blocked": list(unplanned.values())} if unplanned else {},
    )


def _add_stroke(rows: _Rows, robot: Robot, stroke: Stroke, motion: Motion, speeds: Speeds) -> int:
    """Add a stroke with its leads, as one motion; the number of its first sample in contact."""
    joints, poses = stroke.whole, forward(robot, stroke.whole)
    first = len(stroke.leads[0]) if stroke.leads else 0
    own = slice(first, first + len(stroke))
    points, normals = poses.tip, -poses.tool_axis
    points[own], normals[own] = stroke.points, stroke.normals
    how = joints, speeds, points, motion.speed_m_per_s
    times = evenly_timed(*how, 2 * motion.tool_radius_m) if motion.even_feed else timed(*how)
    times = times + rows.now
    begun = rows.count + first
    parts = ((slice(first), -1), (own, stroke.segment), (slice(own.stop, None), -1))
    for part, segment in parts:
        rows.add(times[part], joints[part], points[part], normals[part], segment)
    rows.now = float(times[-1])
    return begun


def _retraced(strokes: Sequence[Stroke], spacing: float) -> dict[int, Mask]:
    """Of each stroke, which samples run along another pass over its segment."""
    found: dict[int, Mask] = {}
    for segment in {stroke.segment for stroke in strokes}:
        own = [number for number, stroke in enumerate(strokes) if stroke.segment == segment]
        marked = retraced([strokes[number].points for number in own], spacing)
        found.update(zip(own, marked, strict=True))
    return found


def _add_transfer(
    rows: _Rows,
    robot: Robot,
    transfer: Transfer,
    ends: tuple[int, bool],
    speeds: Speeds,
    tip_speeds: tuple[float, float],
) -> int | None:
    """Add the samples of a transfer that no stroke has; where its gap is, if it has one.

    Args:
        ends: the first sample that no stroke has, and whether it leads to a stroke.
        tip_speeds: at most, m/s: near contact, and elsewhere.
    """
    first, to_stroke = ends
    joints, count = transfer.joints, len(transfer.joints)
    pieces = [(0, count - 1)]
    if transfer.gap is not None:
        cuts = [0, transfer.gap, transfer.gap + 1, count - 1]
        pieces = [(a, b) for a, b in pairwise(cuts) if b > a]
    times, poses = np.zeros(count), forward(robot, joints)
    steps = np.linalg.norm(np.diff(poses.tip, axis=0), axis=1)
    way = np.cumsum(steps)
    left = steps.sum() - way + steps
    near = ((way <= _NEAR) & (first > 0)) | ((left <= _NEAR) & to_stroke)
    fastest = np.where(near, *tip_speeds)
    for a, b in pieces:
        times[a : b + 1] = times[a] + timed(
            joints[a : b + 1], speeds, poses.tip[a : b + 1], fastest[a:b]
        )
    times += rows.now
    base = rows.count - first
    own = slice(first, count - 1 if to_stroke else count)
    rows.add(times[own], joints[own], poses.tip[own], -poses.tool_axis[own], -1)
    rows.now = float(times[-1])
    return None if transfer.gap is None else base + transfer.gap
