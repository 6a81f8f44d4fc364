"""Walls on a segment that keep joints inside their limits where the segment winds them.

Inverse kinematics gives a joint's angle modulo full circles. After a closed walk on a segment
around a hole, or around a place that is out of reach, an angle may have changed by full circles, as
that of the first joint does after a walk around the robot's base. A path that goes around often
enough leaves any limits. So each vertex gets the one angle of such a joint that is in a window of a
full circle, and neighbors whose angles do not go on from each other get a **wall** between them,
which no path may cross. Of several windows inside the limits the one is taken whose walls leave the
fewest pieces, then the one with the fewest walls, then the middle one.

Colors of joints with less than two circles are divided before (``docs/frontend.md``, "Turns"), so a
window is well inside the limits. The shipped part ``blend`` needs walls: without them one stroke is
cut in two.

Example. Vertices A, B, C, D lie around the base, with the first joint at 0, 90, 180 and -90
degrees. The step from C to D has 1 turn: from 180 degrees the joint goes on to 270. In the window
from -180 to 180 degrees the one wall is between C and D.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.mesh.triangle_mesh import grouped
from cellcolor.motion.small_triangles import CornerStates

_CIRCLE = 2 * np.pi
_WINDOWS = 9  # evenly over the limits


class Steps(NamedTuple):
    """The vertices of a segment, and the steps between them.

    Attributes:
        vertex: (p,) of the mesh.
        angles: (p, joints) in the middle of those around each vertex, unwound from it, rad or m.
        ends: (s, 2) the two vertices of each step, by their places in ``vertex``.
        turns: (s, joints) full circles to add at the second: the angles continued from the first,
            less those that inverse kinematics gives at the second.
    """

    vertex: Index
    angles: Array
    ends: Index
    turns: Index


def steps_of(states: CornerStates, space: JointSpace, segment: int, closed: Mask) -> Steps:
    """The steps on a segment, without small triangles that are not valid all over.

    A step leads across each side between the middle of a mesh edge and a centroid. On one side of
    it is the small triangle (vertex, middle, centroid), on the other (next vertex, centroid,
    middle).

    Args:
        closed: (k,) mesh edges that no path crosses.
    """
    joints = states.joints
    kept = (states.segment == segment) & ~states.bad
    vertex, place = np.unique(states.fine.corners[kept, 0], return_inverse=True)
    lowest = np.full((len(vertex), joints.shape[2]), np.inf)
    highest = -lowest
    np.minimum.at(lowest, place, joints[kept].min(axis=1))
    np.maximum.at(highest, place, joints[kept].max(axis=1))
    numbers = np.arange(len(kept)).reshape(-1, 3, 2)
    here, there = numbers[:, :, 0].ravel(), np.roll(numbers[:, :, 1], -1, axis=1).ravel()
    crossed = kept[here] & kept[there] & ~closed[states.side[here]]
    here, there = here[crossed], there[crossed]
    place_of = np.full(len(kept), -1)
    place_of[kept] = place
    turns = space.periods(joints[here, 1] - joints[there, 2]).astype(np.int64)
    return Steps(
        vertex, (lowest + highest) / 2, np.column_stack([place_of[here], place_of[there]]), turns
    )


def walls_of(steps: Steps, space: JointSpace) -> tuple[list[tuple[int, int]], int | None]:
    """Walls between which the joints of a segment stay inside their limits.

    Returns:
        Mesh edges; no path may cross from one end's part to the other end's. And the joint that
        parts a connected piece of the segment; None if none does.
    """
    one, other = steps.ends.T
    torn: Mask = np.zeros(len(one), dtype=bool)
    parting: int | None = None
    for joint in np.flatnonzero(_winding(steps) & np.isfinite(space.lower + space.upper)).tolist():
        turns, before = steps.turns[:, joint], _pieces(steps, torn)
        lower, upper = space.lower[joint] + np.pi, space.upper[joint] - np.pi
        found = []
        for middle in np.linspace(lower, upper, _WINDOWS) if lower < upper else [lower]:
            own = np.rint((middle - steps.angles[:, joint]) / _CIRCLE)
            walls = torn | (own[other] != own[one] + turns)
            aside = abs(middle - (lower + upper) / 2)
            found.append((_pieces(steps, walls), int(walls.sum()), aside, walls))
        pieces, *_, torn = min(found, key=lambda window: window[:3])
        parting = joint if pieces > before else parting
    walls = np.unique(np.sort(steps.vertex[steps.ends[torn]], axis=1), axis=0)
    return [(int(a), int(b)) for a, b in walls], parting


def _pieces(steps: Steps, torn: Mask) -> int:
    """Into how many pieces a segment falls without some of its steps (s,)."""
    return int(grouped(len(steps.vertex), steps.ends[~torn]).max(initial=-1)) + 1


def _winding(steps: Steps) -> Mask:
    """Which joints (joints,) have come back turned by full circles on some closed walk."""
    turns, (one, other) = np.zeros(steps.angles.shape, dtype=np.int64), steps.ends.T
    piece = grouped(len(turns), steps.ends)
    known = np.zeros(len(turns), dtype=bool)
    known[np.unique(piece, return_index=True)[1]] = True
    while not known.all():
        on, back = known[one] & ~known[other], known[other] & ~known[one]
        turns[other[on]] = turns[one[on]] + steps.turns[on]
        turns[one[back]] = turns[other[back]] - steps.turns[back]
        known[other[on]] = known[one[back]] = True
    return np.asarray((turns[one] + steps.turns != turns[other]).any(axis=0))
