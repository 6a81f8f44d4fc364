"""Which configurations at the two ends of a mesh edge belong together.

A pair is **clear** if the step between the two is small and less than half as long as the way to
any other configuration at either end. Steps are measured by the joint that moves farthest, which is
a metric, so a step to any other configuration is longer. What is left over at both ends of an edge
is **doubtful**, and settled by whoever knows more: the front end follows the arm along the edge
(:mod:`cellcolor.frontend.reach.sheets`); without a robot the caller may know (:class:`Nearest`).

For k edges and s configurations of a vertex there are O(k s^2) comparisons.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from math import pi

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.deadline import Deadline
from cellcolor.memory import chunks

CIRCLE = 2 * pi
"""rad; after which an angle comes back."""

DOUBTFUL = 2
"""A step of so many times the longest clear one is not doubtful any more: the two are apart."""

ROUNDING = 1e-9
"""rad or m; a joint on its limit is inside."""

Linked = Callable[[int, int, int, int], bool]
"""``linked(i, a, j, b)``: whether the arm moves continuously along the mesh edge from configuration
a of vertex i to configuration b of vertex j."""


def shorter_way(first: Array, second: Array, periods: Array | float = CIRCLE) -> Array:
    """How far each joint moves between configurations (..., joints), the shorter way around.

    Args:
        periods: (joints,) after which a joint comes back; infinite for one that never does.
    """
    way, turning = second - first, np.isfinite(periods)
    circle = np.where(turning, periods, 1.0)
    around = np.remainder(way + circle / 2, circle) - circle / 2
    return np.asarray(around if turning.all() else np.where(turning, around, way))


def farthest(first: Array, second: Array, periods: Array | float = CIRCLE) -> Array:
    """The movement of the joint that moves farthest between configurations (..., joints)."""
    return np.asarray(np.abs(shorter_way(first, second, periods)).max(axis=-1))


def stays_within(
    limits: tuple[Array, Array],
    start: Array,
    lowest: Array,
    highest: Array,
    periods: Array | float = CIRCLE,
) -> Mask:
    """Whether motions fit into joint limits, turned by whole periods where need be.

    With limits of -3 and 3 rad there is no way from 2.9 on by 0.48; with limits of -3 and 4 rad
    there is.

    Args:
        limits: lower and upper (joints,).
        start: (..., joints) where the motions begin.
        lowest, highest: (..., joints) how far each joint gets from there, at most and at least 0.
        periods: see :func:`shorter_way`.
    """
    lower, upper = limits
    turning = np.isfinite(periods)
    circle = np.where(turning, periods, 0.0)
    turns = np.ceil((lower - start - lowest) / np.where(turning, periods, 1.0) - ROUNDING)
    fits = start + highest + circle * turns <= upper + ROUNDING
    fits &= turning | (start + lowest >= lower - ROUNDING)
    return np.asarray(fits.all(axis=-1))


@dataclass(frozen=True)
class Matching(ABC):
    """Matches configurations along mesh edges.

    Attributes:
        joints: (n, s, joints) the configurations of n vertices, NaN where a vertex has fewer.
        there: (n, s) which of them may be matched.
        branch: (n, s) a number for the name of each, equal everywhere without names. Configurations
            of different names never belong together.
        periods: (joints,) see :func:`shorter_way`.
        limits: lower and upper (joints,) that motions between configurations have to keep; None
            without.
    """

    joints: Array
    there: Mask
    branch: Index
    periods: Array
    limits: tuple[Array, Array] | None

    @abstractmethod
    def small(self, edges: Index, step: Array) -> Mask:
        """Which steps (k, s, s) between configurations at the ends of mesh edges (k, 2) are small:
        a longer one is never clear."""

    @abstractmethod
    def settle(self, edges: Index, left: Mask, step: Array, nearest: Array) -> tuple[Index, Array]:
        """The matches among what is left over at both ends of mesh edges (k, 2).

        Args:
            left: (k, s, s) which pairs these are.
            step: (k, s, s) between them.
            nearest: (k, s, s) how far other configurations are.

        Returns:
            As :meth:`~cellcolor.configurations.matching.Matching.along`.
        """

    def along(self, edges: Index, deadline: Deadline) -> tuple[Index, Array]:
        """The matches along mesh edges (k, 2).

        Returns:
            Pairs (l, 3), each a row of the edges and the configurations at both ends; and the
            strength (l,) of each, how much nearer the two are to each other than to others. It is 2
            or more where that is clear, infinite where it is known.
        """
        slots, apart = self.there.shape[1], self._apart()
        pairs, strengths = [np.empty((0, 3), dtype=np.int64)], [np.empty(0)]
        for part in chunks(len(edges), slots):
            deadline.check()
            for found, strength in self._matched(edges[part], apart):
                pairs.append(found + np.array([part.start, 0, 0]))
                strengths.append(strength)
        return np.concatenate(pairs), np.concatenate(strengths)

    def _matched(self, edges: Index, apart: Array) -> Iterator[tuple[Index, Array]]:
        i, j = edges.T
        step = farthest(self.joints[i][:, :, None], self.joints[j][:, None], self.periods)
        possible = self.there[i][:, :, None] & self.there[j][:, None]
        possible &= self.branch[i][:, :, None] == self.branch[j][:, None]
        nearest = np.minimum(apart[i][:, :, None], apart[j][:, None])
        near = possible & (2 * step < nearest) & self.small(edges, step)
        pairs = np.argwhere(near)
        pairs = pairs[self.keeps_limits(edges, pairs)]
        at = tuple(pairs.T)
        yield pairs, nearest[at] / np.maximum(step[at], ROUNDING)
        # What is near but would leave the limits is settled as well: the two are apart.
        left = possible & ~(near.any(axis=2, keepdims=True) | near.any(axis=1, keepdims=True))
        if left.any():
            yield self.settle(edges, left, step, nearest)

    def keeps_limits(self, edges: Index, pairs: Index) -> Mask:
        """Whether the direct motions of pairs (l, 3) keep the limits, (l,)."""
        if self.limits is None:
            return np.ones(len(pairs), dtype=bool)
        row, first, second = pairs.T
        start = self.joints[edges[row, 0], first]
        way = shorter_way(start, self.joints[edges[row, 1], second], self.periods)
        lowest, highest = np.minimum(way, 0.0), np.maximum(way, 0.0)
        return stays_within(self.limits, start, lowest, highest, self.periods)

    def _apart(self) -> Array:
        """How far (n, s) the nearest other configuration of the vertex is that it could be mistaken
        for."""
        count, slots = self.there.shape
        found = np.full((count, slots), np.inf)
        for part in chunks(count, slots):
            own, branch = self.joints[part], self.branch[part]
            step = farthest(own[:, :, None], own[:, None], self.periods)
            step[np.isnan(step) | (branch[:, :, None] != branch[:, None])] = np.inf
            step[:, np.arange(slots), np.arange(slots)] = np.inf
            found[part] = step.min(axis=2, initial=np.inf)
        return found


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


@dataclass(frozen=True)
class Nearest(Matching):
    """Settles what is doubtful without a robot.

    The caller is asked about the nearest first. Without one, the two that are nearest to each other
    are matched, unless their step is too long, and noted.

    Attributes:
        max_step: rad or m; a longer step is not small.
        linked: what the caller knows; None for nothing.
        noted: the doubtful pairs.
    """

    max_step: float
    linked: Linked | None
    noted: list[DoubtfulPair] = field(default_factory=list)

    def small(self, edges: Index, step: Array) -> Mask:  # noqa: ARG002
        return step <= self.max_step

    def settle(self, edges: Index, left: Mask, step: Array, nearest: Array) -> tuple[Index, Array]:
        asked = np.argwhere(left)
        rows, first, second = asked[self.keeps_limits(edges, asked)].T
        open_ = np.full(step.shape, np.inf)
        open_[rows, first, second] = step[rows, first, second]
        pairs: list[tuple[int, int, int]] = []
        for row in np.unique(rows).tolist():
            pairs += [(row, a, b) for a, b in self._of_edge(edges[row], open_[row])]
        found = np.array(pairs, dtype=np.int64).reshape(-1, 3)
        if self.linked is not None:
            return found, np.full(len(found), np.inf)
        at = tuple(found.T)
        return found, nearest[at] / np.maximum(step[at], ROUNDING)

    def _of_edge(self, edge: Index, step: Array) -> Iterator[tuple[int, int]]:
        """The pairs of one edge (2,) that are matched; ``step`` (s, s) is used up."""
        i, j = edge.tolist()
        while np.isfinite(least := step.min()):
            a, b = (int(place) for place in np.unravel_index(np.argmin(step), step.shape))
            if self.linked is not None and not self.linked(i, a, j, b):
                step[a, b] = np.inf
                continue
            matched = self.linked is not None or bool(least <= self.max_step)
            if self.linked is None and least <= DOUBTFUL * self.max_step:
                self.noted.append(DoubtfulPair(i, a, j, b, float(least), matched))
            if matched:
                yield a, b
            step[a, :] = step[:, b] = np.inf
