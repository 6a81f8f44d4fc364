"""The whole turns of the joints on each stroke, chosen so that moves between are short."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np

from cellcolor.arrays import Array, Index
from cellcolor.frontend.arm.joint_space import JointSpace

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
        space: of the joints.
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
    best = _quickest(moves, aside)
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
            best = _quickest(moves, aside)
    else:  # what was not asked about is not to look better than what was
        for layer, move in enumerate(moves):
            unknown = np.ones(move.shape, dtype=bool)
            asked_of = [(one, other) for at, one, other in known if at == layer]
            unknown[tuple(np.array(asked_of, dtype=np.int64).reshape(-1, 2).T)] = False
            move[unknown] += _UNKNOWN
        best = _quickest(moves, aside)
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


def _quickest(moves: Sequence[Array], aside: Sequence[Array]) -> list[int]:
    """One choice of each layer, with the least time in all."""
    total, came = aside[0], []
    for move, own in zip(moves, aside[1:], strict=True):
        whole = total[:, None] + move
        came.append(whole.argmin(axis=0))
        total = whole.min(axis=0) + own
    best = [int(total.argmin())]
    for back in reversed(came):
        best.append(int(back[best[-1]]))
    return best[::-1]
