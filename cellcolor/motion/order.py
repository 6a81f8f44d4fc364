"""Order and direction of strokes, and whole turns of their joints, for short ways between them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, permutations, product

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
        velocities: (joints,) the greatest, rad/s or m/s.
        home: (joints,) where the arm begins and ends; None if that does not matter.
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
        own = [rows[stroke] for stroke in order]
        moves = [between[np.ix_(before, after)] for before, after in pairwise(own)]
        aside = [np.zeros(len(some)) for some in own]
        aside[0] += from_home[own[0]]
        aside[-1] += to_home[own[-1]]
        seconds, chosen = _quickest(moves, aside)
        return seconds, [int(some[at]) for some, at in zip(own, chosen, strict=True)]

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


_PER_JOINT = 3  # turns of one joint that are tried, those next to the middle of its limits
_ASIDE = 0.01  # s per rad; of two ways as quick as each other that nearer to the middle is taken
_UNKNOWN = 1000.0  # s; added to the time of a move that there was no time to test
_CHECKS = 150  # the most moves that are tested, for each between two visits


@dataclass(frozen=True)
class Visit:
    """Where a stroke begins and ends, and all positions in between; rad or m.

    Attributes:
        start, end: (joints,).
        span: (k, joints) what has to be inside the limits, whatever the turns.
    """

    start: Array
    end: Array
    span: Array


def chosen_turns(
    visits: Sequence[Visit],
    home: Array | None,
    space: JointSpace,
    velocities: Array,
    detour: Callable[[Array, Array], float],
) -> list[Index]:
    """The full circles (joints,) by which the joints of each visit are turned.

    The moves between the visits should be quick. Only straight moves on the best way are tested
    for collisions; if one is blocked, the best way is computed again.

    Args:
        visits: in their order; each fits into the limits.
        home: (joints,) where the arm begins and ends; None if that does not matter.
        velocities: (joints,) the greatest, rad/s or m/s.
        detour: how much longer the arm takes from one configuration (joints,) to another than
            a straight move, s; 0 if that is free.
    """
    limits = space.limits
    lower, upper = (np.where(np.isfinite(limits).all(axis=0), own, 0.0) for own in limits)
    middle = (lower + upper) / 2
    circles, starts, ends, aside = [], [], [], []
    for visit in visits:
        own = _choices(visit, space, middle)
        circles.append(own)
        starts.append(visit.start + space.period * own)
        ends.append(visit.end + space.period * own)
        aside.append(_ASIDE * np.abs((starts[-1] + ends[-1]) / 2 - middle).sum(axis=1))
    if home is not None:
        at_home = home[None]
        starts, ends = [at_home, *starts, at_home], [at_home, *ends, at_home]
        aside = [np.zeros(1), *aside, np.zeros(1)]
    moves = [
        (np.abs(after[None] - before[:, None]) / velocities).max(axis=2)
        for before, after in zip(ends[:-1], starts[1:], strict=True)
    ]
    known: set[tuple[int, int, int]] = set()
    best = _quickest(moves, aside)[1]
    for _ in range(_CHECKS * len(moves)):
        asked = next(
            (
                (layer, *pair)
                for layer, pair in enumerate(pairwise(best))
                if (layer, *pair) not in known
            ),
            None,
        )
        if asked is None:
            break
        known.add(asked)
        layer, one, other = asked
        longer = detour(ends[layer][one], starts[layer + 1][other])
        if longer > 0:
            moves[layer][one, other] += longer
            best = _quickest(moves, aside)[1]
    else:  # what was not asked about is not to look better than what was
        for layer, move in enumerate(moves):
            unknown = np.ones(move.shape, dtype=bool)
            asked_of = [(one, other) for at, one, other in known if at == layer]
            unknown[tuple(np.array(asked_of, dtype=np.int64).reshape(-1, 2).T)] = False
            move[unknown] += _UNKNOWN
        best = _quickest(moves, aside)[1]
    of_visits = best if home is None else best[1:-1]
    return [own[at] for own, at in zip(circles, of_visits, strict=True)]


def _choices(visit: Visit, space: JointSpace, middle: Array) -> Index:
    """Full circles (c, joints) by which a visit can be turned."""
    possible = space.turns(visit.span)
    assert all(map(len, possible))  # asked by who calls
    at = (visit.span.min(axis=0) + visit.span.max(axis=0)) / 2
    near = []
    for joint, turns in enumerate(possible):
        off = np.abs(at[joint] + space.period[joint] * turns - middle[joint])
        if visit.span[:, joint].min() == visit.span[:, joint].max():  # locked: it stays as it is
            near.append(turns[[np.abs(turns).argmin()]])
            continue
        near.append(turns[np.argsort(off, kind="stable")[:_PER_JOINT]])
    return np.array(list(product(*near)), dtype=np.int64)


def _quickest(moves: Sequence[Array], aside: Sequence[Array]) -> tuple[float, list[int]]:
    """The least time in all, and the choice of each layer that takes it."""
    total, came = aside[0], []
    for move, own in zip(moves, aside[1:], strict=True):
        whole = total[:, None] + move
        came.append(whole.argmin(axis=0))
        total = whole.min(axis=0) + own
    best = [int(total.argmin())]
    for back in reversed(came):
        best.append(int(back[best[-1]]))
    return float(total.min()), best[::-1]
