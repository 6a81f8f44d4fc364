"""Strokes and the transfers between them, timed and assembled into one trajectory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory import ExtraLiftOff, LeftOut, RepeatedStretch, Trajectory
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.robot import Robot
from cellcolor.motion.retraced import retraced, stretches
from cellcolor.motion.strokes import Parting, Stroke
from cellcolor.motion.timing import Speeds, timed
from cellcolor.motion.ways import Transfer

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
    name: str,
    robot: Robot,
    strokes: Sequence[Stroke],
    transfers: Sequence[Transfer],
    speeds: Speeds,
    tool_speed: float,
    approach_speed: float,
    spacing: float,
    left_out: tuple[LeftOut, ...],
    meta: dict[str, Any],
    deadline: Deadline,
) -> Trajectory:
    """The trajectory: every stroke, and every planned motion in between, from rest to rest.

    Args:
        name: what to call it.
        robot: the arm.
        strokes: in their order.
        transfers: the way to the first stroke, those between strokes, and that from the last one.
        speeds: of the joints.
        tool_speed: of the tool in contact, m/s.
        approach_speed: of the tool shortly before and after contact, m/s.
        spacing: desired between passes, m; it decides what counts as passed twice.
        left_out: parts that the tool does not visit.
        meta: as of the trajectory.
        deadline: when to give up.

    Raises:
        OutOfTime: the deadline came first.
    """
    rows = _Rows()
    unplanned: dict[int, str] = {}
    extra: list[ExtraLiftOff] = []
    repeated: list[RepeatedStretch] = []
    last_of: dict[int, int] = {}
    marked = _retraced(strokes, spacing)
    # Why segments have more than one stroke, as often as they have more.
    partings: dict[int, list[Parting]] = {}
    for stroke in strokes:
        if stroke.parting is not None:
            partings.setdefault(stroke.segment, []).append(stroke.parting)
    for number, transfer in enumerate(transfers):
        deadline.check()
        at_stroke = 1 if number else 0  # the first sample is the stroke's last one
        gap = _add_transfer(
            rows, robot, transfer, at_stroke, number < len(strokes), speeds, approach_speed
        )
        if gap is not None:
            unplanned[gap] = transfer.blocked
        if number == len(strokes):
            break
        stroke = strokes[number]
        if stroke.segment in last_of:
            why = partings[stroke.segment].pop(0)
            last = last_of[stroke.segment]
            extra.append(ExtraLiftOff(last, stroke.segment, why.reason, why.text, why.place))
        times = rows.now + timed(stroke.joints, speeds, stroke.points, tool_speed)
        repeated += [
            RepeatedStretch(rows.count + a, rows.count + b, "beside another pass")
            for a, b in stretches(marked[number])
        ]
        rows.add(times, stroke.joints, stroke.points, stroke.normals, stroke.segment)
        rows.now = float(times[-1])
        last_of[stroke.segment] = rows.count - 1
    times, joints, points, normals, segment = map(np.concatenate, zip(*rows.parts, strict=True))
    return Trajectory(
        name=name,
        joint_names=robot.joint_names,
        times=times,
        joints=joints,
        points=points,
        normals=normals,
        contact=segment >= 0,
        segment=segment,
        unplanned=tuple(unplanned),
        extra_lift_offs=tuple(extra),
        left_out=left_out,
        repeated=tuple(repeated),
        meta=meta | ({"blocked": list(unplanned.values())} if unplanned else {}),
    )


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
    first: int,
    to_stroke: bool,
    speeds: Speeds,
    approach_speed: float,
) -> int | None:
    """Add the samples of a transfer that no stroke has; where its gap is, if it has one."""
    joints, count = transfer.joints, len(transfer.joints)
    pieces = [(0, count - 1)]
    if transfer.gap is not None:
        ends = [0, transfer.gap, transfer.gap + 1, count - 1]
        pieces = [(a, b) for a, b in pairwise(ends) if b > a]
    times, poses = np.zeros(count), forward(robot, joints)
    steps = np.linalg.norm(np.diff(poses.tip, axis=0), axis=1)
    way = np.cumsum(steps)
    left = steps.sum() - way + steps
    near = ((way <= _NEAR) & (first > 0)) | ((left <= _NEAR) & to_stroke)
    fastest = np.where(near, approach_speed, np.inf)
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
