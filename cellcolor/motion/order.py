"""In which order and direction strokes are made, so that the ways between them are short."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.deadline import Deadline
from cellcolor.motion.following import CIRCLE, whole_turns
from cellcolor.motion.strokes import Stroke

__all__ = ["ordered"]

_STARTS = 12  # of a closed stroke that are tried
_ALL_ORDERS = 6  # up to so many strokes every order is tried


def ordered(
    strokes: Sequence[Stroke],
    limits: tuple[Array, Array],
    velocities: Array,
    home: Array | None,
    deadline: Deadline,
) -> list[Stroke]:
    """The strokes in order, each in its direction, from its start, its joints turned for good.

    Every order is tried of a few strokes; of more, the nearest comes next, and then strokes are
    moved and stretches turned round as long as that helps.

    Args:
        strokes: each fits into the limits.
        limits: lower and upper (joints,) of the joints, rad.
        velocities: (joints,) the greatest, rad/s; a way is as long as its slowest joint takes.
        home: (joints,) where the arm begins and ends, rad; None if that does not matter.
        deadline: when to give up.
    """
    ways = [_ways(stroke, *limits) for stroke in strokes]
    flat = [way for own in ways for way in own]
    layer = np.repeat(np.arange(len(ways)), [len(own) for own in ways])
    seconds = _seconds(flat, *limits, velocities)
    from_home = np.zeros(len(flat)) if home is None else _home(flat, home, velocities, 0)
    to_home = np.zeros(len(flat)) if home is None else _home(flat, home, velocities, -1)
    rows = [np.flatnonzero(layer == number) for number in range(len(ways))]

    def cost(order: Sequence[int]) -> float:
        return _best(order, rows, seconds, from_home, to_home)[0]

    if len(strokes) <= _ALL_ORDERS:
        best = min(deadline.watch(permutations(range(len(strokes)))), key=lambda one: (cost(one), one))
    else:
        best = _improved(_nearest_next(rows, seconds, from_home), cost, deadline)
    chosen = _best(best, rows, seconds, from_home, to_home)[1]
    return _turned([flat[number] for number in chosen], *limits, home)


def _ways(stroke: Stroke, lower: Array, upper: Array) -> list[Stroke]:
    """A stroke in both directions, and if it is closed from several starts."""
    starts = [0]
    if stroke.closed:
        starts = sorted(set(np.linspace(0, len(stroke) - 1, _STARTS, endpoint=False).astype(int)))
    begun = [stroke.begun_at(int(start)) for start in starts]
    fitting = [way for way in begun if whole_turns(way.joints, lower, upper) is not None]
    return [way for one in fitting or [stroke] for way in (one, one.reversed())]


def _seconds(ways: Sequence[Stroke], lower: Array, upper: Array, velocities: Array) -> Array:
    """How long the arm takes at least from the end of each way to the start of each, s."""
    ends, starts = (np.array([way.joints[at] for way in ways]) for at in (-1, 0))
    apart = np.abs(np.remainder(ends[:, None] - starts[None] + np.pi, CIRCLE) - np.pi)
    return np.asarray((apart / velocities).max(axis=2))


def _home(ways: Sequence[Stroke], home: Array, velocities: Array, at: int) -> Array:
    apart = np.array([way.joints[at] for way in ways]) - home
    apart = np.abs(np.remainder(apart + np.pi, CIRCLE) - np.pi)
    return np.asarray((apart / velocities).max(axis=1))


def _best(
    order: Sequence[int], rows: Sequence[Index], seconds: Array, from_home: Array, to_home: Array
) -> tuple[float, list[int]]:
    """The quickest choice of a way for each stroke of an order."""
    total, came = from_home[rows[order[0]]], []
    for before, after in zip(order[:-1], order[1:], strict=True):
        whole = total[:, None] + seconds[np.ix_(rows[before], rows[after])]
        came.append(whole.argmin(axis=0))
        total = whole.min(axis=0)
    total = total + to_home[rows[order[-1]]]
    last = int(total.argmin())
    chosen = [last]
    for back in reversed(came):
        chosen.append(int(back[chosen[-1]]))
    return float(total[last]), [
        int(rows[stroke][way]) for stroke, way in zip(order, reversed(chosen), strict=True)
    ]


def _nearest_next(rows: Sequence[Index], seconds: Array, from_home: Array) -> list[int]:
    left = set(range(len(rows)))
    here = min(left, key=lambda stroke: (from_home[rows[stroke]].min(), stroke))
    order = [here]
    left.remove(here)
    while left:
        near = {stroke: seconds[np.ix_(rows[here], rows[stroke])].min() for stroke in left}
        here = min(left, key=lambda stroke: (near[stroke], stroke))
        order.append(here)
        left.remove(here)
    return order


def _improved(order, cost, deadline):  # type: ignore[no-untyped-def]
    best, value = list(order), cost(order)
    better = True
    while better:
        better = False
        for first in range(len(best)):
            deadline.check()
            for last in range(first + 1, len(best)):
                moved = best[:first] + best[first + 1 : last + 1] + [best[first]] + best[last + 1 :]
                back = best[:first] + [best[last]] + best[first:last] + best[last + 1 :]
                turned = best[:first] + best[first : last + 1][::-1] + best[last + 1 :]
                for other in (moved, back, turned):
                    found = cost(other)
                    if found < value - 1e-9:
                        best, value, better = other, found, True
    return best


def _turned(
    strokes: Sequence[Stroke], lower: Array, upper: Array, home: Array | None
) -> list[Stroke]:
    """Choose whole turns of each joint: those with the least to turn between the strokes."""
    choices = [whole_turns(stroke.joints, lower, upper) for stroke in strokes]
    circles = np.zeros((len(strokes), strokes[0].joints.shape[1]), dtype=np.int64)
    for joint in range(circles.shape[1]):
        options = [
            np.zeros(1, dtype=np.int64) if found is None else found[joint] for found in choices
        ]
        starts, ends = (
            [stroke.joints[at, joint] + CIRCLE * own for stroke, own in zip(strokes, options, strict=True)]
            for at in (0, -1)
        )
        # With nothing else to choose by, the middle of the limits is the best place to be.
        middle = 0.0 if not np.isfinite(lower[joint] + upper[joint]) else (lower[joint] + upper[joint]) / 2
        aside = [1e-3 * np.abs((start + end) / 2 - middle) for start, end in zip(starts, ends, strict=True)]
        total = aside[0] + (0.0 if home is None else np.abs(starts[0] - home[joint]))
        came = []
        for number in range(1, len(strokes)):
            whole = total[:, None] + np.abs(ends[number - 1][:, None] - starts[number][None])
            came.append(whole.argmin(axis=0))
            total = whole.min(axis=0) + aside[number]
        if home is not None:
            total = total + np.abs(ends[-1] - home[joint])
        chosen = [int(total.argmin())]
        for back in reversed(came):
            chosen.append(int(back[chosen[-1]]))
        circles[:, joint] = [own[at] for own, at in zip(options, reversed(chosen), strict=True)]
    return [stroke.turned(own) for stroke, own in zip(strokes, circles, strict=True)]
