"""The order and direction of strokes, chosen so that the ways between them are short."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise, permutations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.joint_space import JointSpace
from cellcolor.motion.strokes import Stroke

_STARTS = 12  # of a closed stroke that are tried
_ALL_ORDERS = 6  # up to this many strokes, every order is tried


def ordered(
    strokes: Sequence[Stroke],
    space: JointSpace,
    velocities: Array,
    home: Array | None,
    deadline: Deadline,
) -> list[Stroke]:
    """The strokes in order, each in its direction and from its start; turns are chosen later.

    For a few strokes every order is tried; for more, the nearest stroke comes next. A way between
    two strokes is as long as its slowest joint takes in the shorter direction.

    Args:
        strokes: each fits into the limits.
        space: of the joints.
        velocities: (joints,) the greatest, rad/s or m/s.
        home: (joints,) where the arm begins and ends; None if that does not matter.
        deadline: when to give up.

    Raises:
        OutOfTime: the deadline came first.
    """
    own = [_ways(stroke, space) for stroke in strokes]
    ways = [way for some in own for way in some]
    first = np.cumsum([0, *map(len, own)])
    rows = [np.arange(a, b) for a, b in pairwise(first.tolist())]
    starts, ends = (np.array([way.joints[at] for way in ways]) for at in (0, -1))
    between = _seconds(space.step(ends[:, None], starts[None]), velocities)
    from_home, to_home = np.zeros(len(ways)), np.zeros(len(ways))
    if home is not None:
        from_home = _seconds(space.step(home, starts), velocities)
        to_home = _seconds(space.step(ends, home), velocities)

    def best_of(order: Sequence[int]) -> tuple[float, list[int]]:
        """The time of the quickest choice of a way for each stroke of an order, and the ways."""
        total, came = from_home[rows[order[0]]], []
        for before, after in pairwise(order):
            whole = total[:, None] + between[np.ix_(rows[before], rows[after])]
            came.append(whole.argmin(axis=0))
            total = whole.min(axis=0)
        total = total + to_home[rows[order[-1]]]
        at = [int(total.argmin())]
        for back in reversed(came):
            at.append(int(back[at[-1]]))
        chosen = [int(rows[stroke][way]) for stroke, way in zip(order, reversed(at), strict=True)]
        return float(total.min()), chosen

    if len(strokes) <= _ALL_ORDERS:
        every = [list(order) for order in permutations(range(len(strokes)))]
        best = min(deadline.watch(every), key=lambda order: best_of(order)[0])
    else:
        best = _nearest_next(rows, between, from_home)
    return [ways[number] for number in best_of(best)[1]]


def _ways(stroke: Stroke, space: JointSpace) -> list[Stroke]:
    """A stroke in both directions, and if it is closed from several starts."""
    starts = [0]
    if stroke.is_closed(space):
        evenly = np.linspace(0, len(stroke) - 1, _STARTS, endpoint=False)
        starts = sorted(set(evenly.astype(int).tolist()))
    begun = [stroke.begun_at(start, space) for start in starts]
    fitting = [way for way in begun if space.fits(way.joints)]
    return [way for one in fitting for way in (one, one.reversed())]


def _seconds(way: Array, velocities: Array) -> Array:
    """How long the slowest joint takes at least, whatever whole turns are chosen, s."""
    return np.asarray((np.abs(way) / velocities).max(axis=-1))


def _nearest_next(rows: Sequence[Index], between: Array, from_home: Array) -> list[int]:
    left = list(range(len(rows)))
    order = [min(left, key=lambda stroke: float(from_home[rows[stroke]].min()))]
    left.remove(order[0])
    while left:
        near = {at: float(between[np.ix_(rows[order[-1]], rows[at])].min()) for at in left}
        order.append(min(left, key=near.__getitem__))
        left.remove(order[-1])
    return order
