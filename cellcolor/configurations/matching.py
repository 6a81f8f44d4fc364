"""Which configurations at the two ends of a mesh edge belong together.

A pair is **clear** if the step between the two is small and less than half as long as the way to
any other configuration at either end. Steps are measured by the joint that moves farthest, which is
a metric, so a step to any other configuration is longer. What is left over at both ends of an edge
is **doubtful**: there the caller may know (``linked``), or the two that are nearest to each other
are matched and listed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline

Linked = Callable[[int, int, int, int], bool]
"""``linked(i, a, j, b)``: whether the arm moves continuously along the mesh edge from configuration
a of vertex i to configuration b of vertex j."""

DOUBTFUL = 2
"""A step of so many times the longest clear one is not doubtful any more: the two are apart."""

_AT_ONCE = 20_000_000  # numbers in the largest array
_ROUNDING = 1e-9  # rad; an angle on its limit is inside


@dataclass(frozen=True, slots=True)
class DoubtfulPair:
    """Two configurations at the ends of a mesh edge that may belong together.

    Attributes:
        i: a vertex.
        a: the number of its configuration.
        j: the other vertex.
        b: the number of its configuration.
        step: how far the joint that moves farthest moves between the two, in rad or m.
        matched: whether they were matched.
    """

    i: int
    a: int
    j: int
    b: int
    step: float
    matched: bool

    def __str__(self) -> str:
        verdict = "matched" if self.matched else "not matched"
        return (
            f"vertex {self.i}, configuration {self.a} and vertex {self.j}, configuration {self.b}, "
            f"{self.step:.3g} apart: {verdict}"
        )


@dataclass(frozen=True, slots=True)
class Matches:
    """The pairs that belong together.

    Attributes:
        pairs: (l, 3) rows of edges, and the configurations at both ends.
        strength: (l,) how much nearer the two are to each other than to others, 2 or more where the
            match is clear; infinite where the caller said so.
        doubtful: the pairs that are not clear and that the caller did not settle.
    """

    pairs: Index
    strength: Array
    doubtful: tuple[DoubtfulPair, ...]


def shorter_way(first: Array, second: Array, periods: Array) -> Array:
    """How far each joint moves between configurations (..., joints), the shorter way around.

    Args:
        periods: (joints,) after which an angle comes back; infinite for a joint that never does.
    """
    way = second - first
    turning = np.isfinite(periods)
    circle = np.where(turning, periods, 1.0)
    around = np.remainder(way + circle / 2, circle) - circle / 2
    return np.asarray(np.where(turning, around, way))


def farthest(first: Array, second: Array, periods: Array) -> Array:
    """The movement of the joint that moves farthest between configurations (..., joints)."""
    return np.asarray(np.abs(shorter_way(first, second, periods)).max(axis=-1))


def stays_within(limits: tuple[Array, Array], start: Array, way: Array, periods: Array) -> Mask:
    """Whether straight joint motions (..., joints) stay within limits, whichever turn they begin
    on.

    Args:
        limits: lower and upper (joints,).
    """
    lower, upper = limits
    circle = np.where(np.isfinite(periods), periods, 1.0)
    lowest, highest = start + np.minimum(way, 0.0), start + np.maximum(way, 0.0)
    turns = np.where(np.isfinite(periods), np.ceil((lower - lowest) / circle - _ROUNDING), 0.0)
    low, high = lowest + turns * circle, highest + turns * circle
    return np.asarray(((low >= lower - _ROUNDING) & (high <= upper + _ROUNDING)).all(axis=-1))


@dataclass(frozen=True)
class Matching:
    """Matches configurations along mesh edges.

    Attributes:
        joints: (n, s, joints) the configurations of n vertices, NaN where a vertex has fewer.
        branch: (n, s) a number for the name of each, equal everywhere without names. Configurations
            of different names never belong together.
        periods: (joints,) see :func:`shorter_way`.
        max_step: a longer step is never clear.
        limits: lower and upper (joints,) that motions between configurations have to keep; None
            without.
        linked: what the caller knows; None for nothing.
    """

    joints: Array
    branch: Index
    periods: Array
    max_step: float
    limits: tuple[Array, Array] | None = None
    linked: Linked | None = None

    def along(self, edges: Index, deadline: Deadline) -> Matches:
        """The matches along mesh edges (k, 2)."""
        slots, joints = self.joints.shape[1:]
        rows = max(1, _AT_ONCE // max(1, slots * slots * joints))
        apart = self._apart(rows)
        pairs, strength = [np.empty((0, 3), dtype=np.int64)], [np.empty(0)]
        doubtful: list[DoubtfulPair] = []
        for first in range(0, len(edges), rows):
            deadline.check()
            part = edges[first : first + rows]
            step, usable = self._steps(part)
            nearest = np.minimum(apart[part[:, 0], :, None], apart[part[:, 1], None, :])
            near: Mask = np.asarray((2 * step < nearest) & (step <= self.max_step))
            clear = near & usable
            found = np.argwhere(clear)
            at = tuple(found.T)
            strength.append(nearest[at] / np.maximum(step[at], _ROUNDING))
            pairs.append(found + np.array([first, 0, 0]))
            # What is near but would leave the limits is settled as well: the two are apart.
            taken = near.any(axis=2, keepdims=True) | near.any(axis=1, keepdims=True)
            left = np.asarray(np.isfinite(step) & usable & ~taken)
            for row in np.flatnonzero(left.any(axis=(1, 2))):
                for a, b, verdict in self._settled(
                    part[row], np.where(left[row], step[row], np.inf)
                ):
                    if verdict is not False:
                        pairs.append(np.array([[first + row, a, b]]))
                        known = verdict is True
                        near_by = nearest[row, a, b] / max(step[row, a, b], _ROUNDING)
                        strength.append(np.array([np.inf if known else near_by]))
                    if self.linked is None and step[row, a, b] <= DOUBTFUL * self.max_step:
                        i, j = part[row].tolist()
                        doubtful.append(
                            DoubtfulPair(i, a, j, b, float(step[row, a, b]), verdict is None)
                        )
        return Matches(np.concatenate(pairs), np.concatenate(strength), tuple(doubtful))

    def _settled(self, edge: Index, step: Array) -> Iterator[tuple[int, int, bool | None]]:
        """What is left over at both ends of an edge: pairs, each with a verdict.

        True if the caller says that they belong together; None if they are the nearest to each
        other and not far apart, so that they are matched; False if they are the nearest, but too
        far apart. Pairs that the caller denies do not appear.
        """
        i, j = edge.tolist()
        while np.isfinite(step).any():
            a, b = (int(place) for place in np.unravel_index(np.argmin(step), step.shape))
            if self.linked is not None:
                if not self.linked(i, a, j, b):
                    step[a, b] = np.inf
                    continue
                yield a, b, True
            else:
                yield a, b, None if step[a, b] <= self.max_step else False
            step[a, :] = step[:, b] = np.inf

    def _steps(self, edges: Index) -> tuple[Array, Mask]:
        """Steps (k, s, s) between configurations at both ends, infinite where there are none, and
        which motions keep the limits."""
        i, j = edges.T
        way = shorter_way(self.joints[i][:, :, None], self.joints[j][:, None], self.periods)
        step = np.abs(way).max(axis=-1)
        step[np.isnan(step)] = np.inf
        step[self.branch[i][:, :, None] != self.branch[j][:, None]] = np.inf
        if self.limits is None:
            return step, np.ones(step.shape, dtype=bool)
        start = np.broadcast_to(self.joints[i][:, :, None], way.shape)
        return step, stays_within(self.limits, start, way, self.periods)

    def _apart(self, rows: int) -> Array:
        """How far (n, s) the nearest other configuration of the vertex is that it could be mistaken
        for."""
        found = np.full(self.joints.shape[:2], np.inf)
        for first in range(0, len(found), rows):
            own = self.joints[first : first + rows]
            branch = self.branch[first : first + rows]
            step = farthest(own[:, :, None], own[:, None], self.periods)
            step[branch[:, :, None] != branch[:, None]] = np.inf
            step[np.isnan(step)] = np.inf
            every = np.arange(step.shape[1])
            step[:, every, every] = np.inf
            found[first : first + rows] = step.min(axis=2, initial=np.inf)
        return found
