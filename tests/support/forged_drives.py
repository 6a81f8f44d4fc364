"""Drives forged from an honest one, each with the kinds of faults of which one has to be found.

A sort draws what it needs at random, so one sort stands for many drives. A part left out is one
that is missed: a tenth of a stroke may be so winding that a straight line instead of it covers as
much.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from honest_drives import Honest, Random, dropped_stroke, rows_of

from cellcolor.arrays import Array, Index
from cellcolor.data.trajectory import ExtraLiftOff, LeftOut, RepeatedStretch, Trajectory

_DRAWS = 60

Forger = Callable[[Honest, Random], Trajectory]


def _part_dropped(share: float) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:
        for _ in range(_DRAWS):
            first, after = honest.stroke(random)
            length = int(share * (after - first))
            begin = int(random.integers(first, after - length + 1))
            rows = np.delete(
                np.arange(len(honest.trajectory.times)), np.arange(begin, begin + length)
            )
            forged = rows_of(honest.trajectory, rows)
            if honest.misses(forged):
                return forged
        raise LookupError(f"no {share:.0%} of a stroke whose lack misses anything")

    return forge


def _lifted(share: float, height: float) -> Forger:
    """A part of a stroke is driven above the surface, and stated as contact or not."""

    def forge(honest: Honest, random: Random) -> Trajectory:
        first, after = honest.stroke(random)
        rows = np.arange(first, first + max(20, int(share * (after - first))))
        trajectory, joints = honest.trajectory, honest.trajectory.joints.copy()
        points = trajectory.points[rows] + height * trajectory.normals[rows]
        joints[rows] = honest.reached(points, trajectory.normals[rows], joints[rows])
        return honest.posed(joints)

    return forge


def _never_touching(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    none = np.zeros_like(honest.trajectory.contact)
    return replace(honest.trajectory, contact=none, repeated=(), left_out=())


def _contact_off(length: int) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:
        contact = honest.trajectory.contact.copy()
        contact[honest.inside(random, length)] = False
        return replace(honest.trajectory, contact=contact, repeated=())

    return forge


def _contact_on(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    return replace(honest.trajectory, contact=np.ones_like(honest.trajectory.contact))


def _stroke_off(honest: Honest, random: Random) -> Trajectory:
    contact = honest.trajectory.contact.copy()
    contact[slice(*honest.stroke(random))] = False
    return replace(honest.trajectory, contact=contact, repeated=())


def _bump(size: float, length: int = 1) -> Forger:
    """Joints off the way for a few samples."""

    def forge(honest: Honest, random: Random) -> Trajectory:
        joints = honest.trajectory.joints.copy()
        rows, joint = honest.inside(random, length), int(random.integers(5))
        joints[rows, joint] += size
        return honest.posed(joints)

    return forge


def _claimed_pose(member: str, size: float) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:
        values = getattr(honest.trajectory, member).copy()
        rows = honest.inside(random, int(random.integers(1, 40)))
        values[rows] += size * random.choice([-1.0, 1.0], 3)
        if member == "normals":
            values[rows] /= np.linalg.norm(values[rows], axis=1, keepdims=True)
        changes: dict[str, Any] = {member: values}
        return replace(honest.trajectory, **changes)

    return forge


def _times(change: Callable[[Array, Index, Random], Array], length: int = 60) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:
        times = np.array(honest.trajectory.times)
        return replace(
            honest.trajectory, times=change(times, honest.inside(random, length), random)
        )

    return forge


def _scaled(factor: float) -> Callable[[Array, Index, Random], Array]:
    """A stretch of time is compressed."""

    def change(times: Array, rows: Index, random: Random) -> Array:  # noqa: ARG001
        steps = np.diff(times)
        steps[rows] *= factor
        return np.concatenate([times[:1], times[0] + np.cumsum(steps)])

    return change


def _backwards(times: Array, rows: Index, random: Random) -> Array:
    times = times.copy()
    times[rows[0] :] -= times[rows[0]] - times[rows[0] - 1] + random.uniform(1e-3, 0.5)
    return times


def _equal(times: Array, rows: Index, random: Random) -> Array:  # noqa: ARG001
    times = times.copy()
    times[rows[0] + 1] = times[rows[0]]
    return times


def _doubled(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    """A row comes again 0.1 s later, where the arm is fastest."""
    trajectory = honest.trajectory
    speed = np.abs(np.diff(trajectory.joints, axis=0)).max(axis=1) / np.diff(trajectory.times)
    row = int(np.argmax(speed)) + 1
    rows = np.insert(np.arange(len(trajectory.times)), row, row)
    times = np.array(trajectory.times)[rows]
    times[row + 1 :] += 0.1
    return rows_of(trajectory, rows, times=times)


def _begins_fast(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    """Cut where the arm is fast, on the first way to the surface."""
    trajectory = honest.trajectory
    first = trajectory.strokes[0][0]
    speed = np.abs(np.diff(trajectory.joints[:first], axis=0)).max(axis=1)
    row = int(np.argmax(speed / np.diff(trajectory.times[:first])))
    return rows_of(trajectory, np.arange(row, len(trajectory.times)))


def _ends_fast(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    trajectory = honest.trajectory
    last = trajectory.strokes[-1][1]
    speed = np.abs(np.diff(trajectory.joints[last:], axis=0)).max(axis=1)
    row = last + int(np.argmax(speed / np.diff(trajectory.times[last:]))) + 1
    return rows_of(trajectory, np.arange(row + 1))


def _too_fast(factor: float) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
        return replace(honest.trajectory, times=np.array(honest.trajectory.times) / factor)

    return forge


def _over_limit(honest: Honest, random: Random) -> Trajectory:
    joints = honest.trajectory.joints.copy()
    joint = int(random.integers(joints.shape[1]))
    joints[:, joint] += 2 * math.pi * 3
    return honest.posed(joints)


def _jump(honest: Honest, random: Random) -> Trajectory:
    joints = honest.trajectory.joints.copy()
    row = int(honest.inside(random, 1)[0])
    joints[row:, int(random.integers(joints.shape[1]))] += random.choice([-1, 1]) * 2 * math.pi
    return honest.posed(joints)


def _exchanged(honest: Honest, random: Random) -> Trajectory:
    joints = honest.trajectory.joints.copy()
    i, j = random.choice(joints.shape[1], 2, replace=False)
    joints[:, [i, j]] = joints[:, [j, i]]
    return replace(honest.trajectory, joints=joints)


def _reversed_stroke(honest: Honest, random: Random) -> Trajectory:
    first, after = honest.stroke(random)
    rows = np.arange(len(honest.trajectory.times))
    rows[first:after] = rows[first:after][::-1]
    times = np.array(honest.trajectory.times)
    return rows_of(honest.trajectory, rows, times=times, repeated=())


def _swapped_strokes(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    (a, b), (c, d) = honest.trajectory.strokes[:2]
    rows = np.arange(len(honest.trajectory.times))
    rows = np.concatenate([rows[:a], rows[c:d], rows[b:c], rows[a:b], rows[d:]])
    return rows_of(honest.trajectory, rows, times=np.array(honest.trajectory.times), repeated=())


def _shortcut(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
    """The tool goes from stroke to stroke without being lifted, and all is called contact."""
    strokes = honest.trajectory.strokes
    rows = np.arange(len(honest.trajectory.times))
    rows = np.delete(rows, np.arange(strokes[0][1], strokes[1][0]))
    return rows_of(honest.trajectory, rows)


def _twice(honest: Honest, random: Random) -> Trajectory:
    rows = honest.inside(random, 150)
    all_rows = np.arange(len(honest.trajectory.times))
    order = np.concatenate(
        [all_rows[: rows[-1] + 1], rows[-2::-1], rows[1:], all_rows[rows[-1] + 1 :]]
    )
    times = np.array(honest.trajectory.times)
    steps = np.concatenate([np.diff(times[: rows[-1] + 1]), np.diff(times[rows])[::-1],
                            np.diff(times[rows]), np.diff(times[rows[-1] :])])  # fmt: skip
    assert len(steps) + 1 == len(order)
    return rows_of(
        honest.trajectory, order, times=np.concatenate([[0.0], np.cumsum(steps)]), repeated=()
    )


def _other_branch(honest: Honest, random: Random) -> Trajectory:
    """The same poses in another configuration."""
    rows, trajectory = honest.inside(random, 80), honest.trajectory
    found = honest.prepared.arm.inverse(trajectory.points[rows], -trajectory.normals[rows])
    off = found[:, :, :5] - trajectory.joints[rows, None, :5]
    off = np.abs(np.remainder(off + np.pi, 2 * np.pi) - np.pi).max(axis=2)
    there = np.flatnonzero(~np.isnan(off).any(axis=0) & (off.min(axis=0) > 0.05))
    joints = trajectory.joints.copy()
    joints[rows] = found[:, int(random.choice(there))]
    return honest.posed(joints)


def _stated(**changes: Any) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:  # noqa: ARG001
        return replace(honest.trajectory, **changes)

    return forge


def _unplanned(honest: Honest, random: Random) -> Trajectory:
    row = int(random.integers(len(honest.trajectory.times) - 1))
    return replace(honest.trajectory, unplanned=(row,))


def _left_out_on_the_way(honest: Honest, random: Random) -> Trajectory:
    """A tenth of a stroke is dropped and its middle stated as left out."""
    first, after = honest.stroke(random)
    length = (after - first) // 4
    begin = int(random.integers(first, after - length))
    gone = np.arange(begin, begin + length)
    kept = np.delete(np.arange(len(honest.trajectory.times)), gone)
    part = LeftOut(0, 0.01, "no solution", tuple(honest.trajectory.points[gone[length // 2]]))
    left = (*honest.trajectory.left_out, part)
    return rows_of(honest.trajectory, kept, left_out=left)


def _stroke_left_out(honest: Honest, random: Random) -> Trajectory:
    """A stroke is dropped, and all of its segment stated as left out."""
    number = int(random.integers(len(honest.trajectory.strokes)))
    first, after = honest.trajectory.strokes[number]
    segment = int(honest.trajectory.segment[first])
    place = tuple(honest.trajectory.points[(first + after) // 2])
    part = LeftOut(segment, 0.02, "no branch", place)
    return replace(dropped_stroke(honest, number), left_out=(part,))


def _claimed_extra(sample: str) -> Forger:
    def forge(honest: Honest, random: Random) -> Trajectory:
        trajectory = honest.trajectory
        row = trajectory.strokes[0][1] - 1
        if sample == "inside":
            row = int(honest.inside(random, 1)[0])
        extra = ExtraLiftOff(row, 0, "winding", "as said", tuple(trajectory.points[row]))
        return replace(trajectory, extra_lift_offs=(*trajectory.extra_lift_offs, extra))

    return forge


def _needless(honest: Honest, random: Random) -> Trajectory:
    """The tool is lifted off and put down once more, on the spot, and nothing is stated."""
    trajectory = honest.trajectory
    row = int(honest.inside(random, 1)[0])
    up, down = np.linspace(0, 0.02, 200), np.linspace(0.02, 0, 200)
    heights = np.concatenate([up, down])
    points = trajectory.points[row] + heights[:, None] * trajectory.normals[row]
    normals = np.tile(trajectory.normals[row], (len(points), 1))
    own = np.tile(trajectory.joints[row], (len(points), 1))
    ways = honest.reached(points, normals, own)
    ways = np.where(np.isnan(ways), own, ways)

    def put(of: Array, new: Array) -> Array:
        return np.concatenate([of[: row + 1], new, of[row:]])

    times = np.array(trajectory.times)
    return replace(
        trajectory,
        times=np.concatenate(
            [times[: row + 1], times[row] + 0.05 * np.arange(1, 401), times[row:] + 20.05]
        ),
        joints=put(trajectory.joints, ways),
        points=put(trajectory.points, points),
        normals=put(trajectory.normals, normals),
        contact=put(trajectory.contact, np.zeros(400, dtype=bool)),
        segment=put(trajectory.segment, np.full(400, -1)),
        repeated=(),
        extra_lift_offs=(),
        unplanned=(),
    )


FAR = (9.0, 9.0, 9.0)
FORGERS: dict[str, Forger] = {
    **{f"{share:.0%} of a stroke dropped": _part_dropped(share) for share in (0.1, 0.25, 0.5, 0.9)},
    "a stroke dropped": lambda h, r: dropped_stroke(h, int(r.integers(len(h.trajectory.strokes)))),
    "a stroke dropped and stated as left out": _stroke_left_out,
    "a quarter of a stroke dropped and stated as left out": _left_out_on_the_way,
    "strokes in another order, joints leap": _swapped_strokes,
    "a stroke backwards, joints leap": _reversed_stroke,
    "never in contact by the column": _never_touching,
    "always in contact by the column": _contact_on,
    "a stroke off contact by the column": _stroke_off,
    **{f"{n} samples off contact by the column": _contact_off(n) for n in (10, 40, 100, 150)},
    **{f"{h * 1000:g} mm above, {s:.0%} of a stroke": _lifted(s, h)
       for h in (0.0015, 0.005, 0.02) for s in (0.1, 0.5, 1.0)},
    "no lift between two strokes": _shortcut,
    "a stretch twice": _twice,
    "lifted once more than stated": _needless,
    "an extra lift-off stated inside a stroke": _claimed_extra("inside"),
    "a needed lift-off stated as extra": _claimed_extra("end"),
    "left out: a place off the surface": _stated(left_out=(LeftOut(0, 1e-5, "x", FAR),)),
    "left out: more than there is": _stated(left_out=(LeftOut(0, 1e3, "x", FAR),)),
    "a move not planned": _unplanned,
    **{f"joint off by {size:g} rad, {n} samples": _bump(size, n)
       for size in (0.01, 0.02, 0.1, 0.6) for n in (1, 20, 120)},
    **{f"{m} off by {size:g}": _claimed_pose(m, size)
       for m, size in (("points", 2e-4), ("points", 0.001), ("points", 0.01), ("normals", 0.01),
                    ("normals", 0.05), ("normals", 0.3))},
    "time backwards": _times(_backwards),
    "two samples at one time": _times(_equal),
    **{f"a stretch {1 / f:g} times as fast": _times(_scaled(f)) for f in (0.5, 0.2, 0.02)},
    "one step ten times as fast": _times(_scaled(0.1), 1),
    **{f"all {f:g} times as fast": _too_fast(f) for f in (1.1, 2.0, 10.0)},
    "a row doubled 0.1 s later at full speed": _doubled,
    "begins in motion": _begins_fast,
    "ends in motion": _ends_fast,
    "a part of a stroke in another branch": _other_branch,
    "a joint three turns farther": _over_limit,
    "a jump by a full circle": _jump,
    "two columns of joints exchanged": _exchanged,
    "repeated stated, but not driven twice": lambda h, r: replace(
        _twice(h, r), repeated=(RepeatedStretch(0, 1, "x"),)),
}  # fmt: skip
