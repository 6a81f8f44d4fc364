"""Motions of solutions along mesh edges: smooth, or with a jump?

A step of a motion is measured by the whole change of the tool's pose, its way and its turn. One
that is not clearly smooth is halved, until all its parts are, or a point on the way has no
configuration to go through, or a part too short to matter still holds a jump
(``docs/frontend.md``, "Continuity").

A solution without a name is followed by Newton's method, with steps whose length adapts (numerical
continuation). This finds out which solution at another pose is meant. Whether a motion there is
continuous is tested as of named branches, in much shorter steps.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.matching import CIRCLE, shorter_way
from cellcolor.frontend.arm.kinematics import (
    Conditioning,
    forward,
    manipulability,
    signed_task_determinant,
)
from cellcolor.frontend.arm.newton import polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.parts.surface import Surface, along_edges
from cellcolor.frontend.setup import Continuity
from cellcolor.memory import chunks

_TRUSTED = 0.5  # rad; a step in which a joint moves farther is always looked into
_HALVINGS = 10  # of the probe spacing; what is too fast on the last one is a jump

Probe = Callable[[Array, Array, NDArray[np.intp]], tuple[Array, Array]]
"""Points (k, 3), unit tool directions (k, 3) and branches (k,) to configurations (k, joints) in rad
and task determinants (k,) in m^3, both NaN where there is no well-conditioned configuration."""


@dataclass(frozen=True)
class Measure:
    """How motions are measured.

    Attributes:
        near_singular: steps with a task determinant below this, m^3, are always looked into.
        lever: the way that counts like a turn of the tool by one rad, m.
        periods: (joints,) after which a joint comes back, infinite for a prismatic one.
        units: (joints,) the way of each joint that counts like a turn by one rad, rad or m.
    """

    policy: Continuity
    near_singular: float
    lever: float
    periods: Array | float = CIRCLE
    units: Array | float = 1.0

    def step(self, first: Array, second: Array) -> Array:
        """The largest movement of a joint between configurations (..., joints), in rad."""
        way = np.abs(shorter_way(first, second, self.periods))
        return np.asarray((way / self.units).max(axis=-1))

    def changes(self, lengths: Array, turns: Array, low: Array, high: Array) -> Array:
        """The change of the tool's pose (k,) in m on parts of edges, from where to where (0 to 1).

        Args:
            lengths, turns: (k,) of the whole edges, m and rad.
        """
        angle = _turned(turns, high) - _turned(turns, low)
        return np.asarray(lengths * (high - low) + self.lever * angle)

    def settled(self, step: Array, change: Array, nearest: Array) -> Mask:
        """Which steps are so small that nothing has to be looked at in between, (k,).

        Args:
            step: (k,) how far a joint moves, rad.
            change: (k,) of the tool's pose, m.
            nearest: (k,) the smaller task determinant of both ends, m^3.
        """
        bound = self.policy.base_step_rad + self.policy.step_per_length_rad_per_m * change
        clear = (nearest >= self.near_singular) & (step <= np.minimum(bound / 2, _TRUSTED))
        return np.asarray(clear | ((change <= self.policy.probe_spacing_m) & (step <= bound)))

    @property
    def shortest(self) -> float:
        """A change in m so small that a step with it that is not settled is a jump."""
        return float(self.policy.probe_spacing_m / 2**_HALVINGS)


@dataclass(frozen=True)
class Motions:
    """What became of motions along mesh edges.

    Attributes:
        smooth: (k,) whether there is a continuous motion.
        lowest, highest: (k, joints) how far each joint gets from where it starts, in rad, unwound;
            of smooth motions only.
    """

    smooth: Mask
    lowest: Array
    highest: Array


@dataclass(frozen=True)
class _Steps:
    """Parts of motions along edges: which edge, from where to where (0 to 1), what is there."""

    row: Index
    low: Array
    high: Array
    first: Array
    last: Array
    first_determinant: Array
    last_determinant: Array

    def __len__(self) -> int:
        return len(self.row)

    def take(self, which: Mask | slice) -> _Steps:
        return _Steps(*(getattr(self, field.name)[which] for field in fields(self)))

    def halves(self, middle: Array, joints: Array, determinants: Array) -> _Steps:
        """All first halves, then all second ones."""
        before = replace(self, high=middle, last=joints, last_determinant=determinants)
        after = replace(self, low=middle, first=joints, first_determinant=determinants)
        both = ([getattr(half, field.name) for half in (before, after)] for field in fields(self))
        return _Steps(*map(np.concatenate, both))


def follow_edges(
    surface: Surface,
    edges: Index,
    branches: NDArray[np.intp],
    configurations: tuple[Array, Array],
    determinants: tuple[Array, Array],
    measure: Measure,
    probe: Probe,
) -> Motions:
    """Follow a branch along each edge: straight, the normal turning with it.

    Args:
        edges: (k, 2) vertex indices.
        branches: (k,) one of each edge.
        configurations: (k, joints) at the first ends and at the second ones, rad.
        determinants: (k,) task determinants at both, m^3.
        probe: see :data:`Probe`; called with points in between.
    """
    lengths, turns = surface.lengths(edges), surface.turns(edges)
    smooth = np.ones(len(edges), dtype=bool)
    settled: list[_Steps] = []

    def sort(steps: _Steps) -> list[_Steps]:
        """Keep what is settled, note jumps; what is open comes back in pieces."""
        row = steps.row
        change = measure.changes(lengths[row], turns[row], steps.low, steps.high)
        step = measure.step(steps.first, steps.last)
        nearest = np.fmin(steps.first_determinant, steps.last_determinant)
        done = measure.settled(step, change, nearest)
        settled.append(steps.take(done))
        smooth[row[~done & (change <= measure.shortest)]] = False
        rest = steps.take(~done)
        return [rest.take(part) for part in chunks(len(rest))]

    at_ends = np.zeros(len(edges)), np.ones(len(edges))
    open_ = sort(_Steps(np.arange(len(edges)), *at_ends, *configurations, *determinants))
    while open_:
        steps = open_.pop()
        steps = steps.take(smooth[steps.row])
        middle = (steps.low + steps.high) / 2
        points, directions = along_edges(surface, edges[steps.row], middle)
        joints, at_middle = probe(points, directions, branches[steps.row])
        smooth[steps.row[np.isnan(at_middle)]] = False
        found = smooth[steps.row]
        open_ += sort(steps.take(found).halves(middle[found], joints[found], at_middle[found]))
    return Motions(smooth, *_excursions(len(edges), settled, measure.periods))


def _turned(turns: Array, way: Array) -> Array:
    """How much the interpolated normal has turned at parts of the way, rad."""
    return np.arctan2(way * np.sin(turns), 1 - way + way * np.cos(turns))


def _excursions(count: int, settled: list[_Steps], periods: Array | float) -> tuple[Array, Array]:
    """Lowest and highest angles (count, joints) on motions of settled steps, from 0 at the start.

    Args:
        settled: at first those that are whole motions, then parts of the others.
    """
    whole = settled[0]
    joints = whole.first.shape[1]
    lowest, highest = np.zeros((count, joints)), np.zeros((count, joints))
    moved = shorter_way(whole.first, whole.last, periods)
    lowest[whole.row], highest[whole.row] = np.minimum(moved, 0.0), np.maximum(moved, 0.0)
    if not any(map(len, settled[1:])):
        return lowest, highest
    row, low, first, last = (
        np.concatenate([getattr(steps, name) for steps in settled[1:]])
        for name in ("row", "low", "first", "last")
    )
    order = np.lexsort((low, row))
    row, moved = row[order], shorter_way(first[order], last[order], periods)
    # Where each motion begins; a running total over all of them, less what was there before.
    start = np.flatnonzero(np.diff(row, prepend=-1))
    total = np.cumsum(moved, axis=0)
    place = total - np.repeat((total - moved)[start], np.diff(start, append=len(row)), axis=0)
    lowest[row[start]] = np.minimum(np.minimum.reduceat(place, start), 0.0)
    highest[row[start]] = np.maximum(np.maximum.reduceat(place, start), 0.0)
    return lowest, highest


@dataclass(frozen=True)
class Solutions:
    """All solutions of some poses (n, s), or one of each (n,).

    Attributes:
        joints: (..., joints) in rad, NaN where there is none.
        determinants: (...) task determinant with its sign, m^3, NaN where there is none.
        good: (...) whether the thresholds on conditioning are kept.
    """

    joints: Array
    determinants: Array
    good: Mask

    def take(self, *index: Index | slice | int) -> Solutions:
        """Some of them, as numpy indexes."""
        return Solutions(*(getattr(self, each.name)[index] for each in fields(self)))


_STEPS = 8  # of Newton's method; more are needed only where the step is too long
_NEAR = 0.25  # rad; no joint moves farther on a step
_CHANGE = 4.0  # by this factor at most the determinant changes on it
_SHORTER = 2  # than the spacing of probes: no step is shorter


class Tracker:
    """Follows solutions of one arm.

    Attributes:
        measure: what is a jump between two solutions that are known.
    """

    def __init__(self, robot: Robot, measure: Measure, limits: Conditioning | None = None) -> None:
        """An arm whose tool is on the last axis, and what is asked of its motions.

        Args:
            limits: what counts as well conditioned; everything, without.
        """
        self._robot, self.measure, self._limits = robot, measure, limits

    def described(self, joints: Array) -> Solutions:
        """Solutions (..., joints), and how well conditioned the arm is in them."""
        flat, task = joints.reshape(-1, joints.shape[-1]), self._robot.task
        determinants, good = np.full(len(flat), np.nan), np.zeros(len(flat), dtype=bool)
        for part in chunks(len(flat)):
            rows = part.start + np.flatnonzero(~np.isnan(flat[part, 0]))
            poses = forward(self._robot, flat[rows])
            own = signed_task_determinant(poses, task)
            determinants[rows], good[rows] = own, True
            if self._limits is not None:
                good[rows] = (np.abs(own) >= self._limits.min_task_determinant) & (
                    manipulability(poses, task) >= self._limits.min_manipulability
                )
        shape = joints.shape[:-1]
        return Solutions(joints, determinants.reshape(shape), good.reshape(shape))

    def walk(self, surface: Surface, edges: Index, start: Solutions) -> tuple[Array, Motions]:
        """Follow solutions from the first ends of edges to the second ones.

        Args:
            edges: (k, 2) vertex indices.
            start: (k,) at the first ends.

        Returns:
            Where they end, (k, joints), NaN where a motion is lost since it jumps or passes a point
            that is ill-conditioned; and the motions.
        """
        measure, count = self.measure, len(edges)
        shortest = measure.policy.probe_spacing_m / _SHORTER
        lengths, turns = surface.lengths(edges), surface.turns(edges)
        at, ahead = np.zeros(count), np.ones(count)
        now = Solutions(*(getattr(start, each.name).copy() for each in fields(start)))
        moved, lowest, highest = np.zeros((3, *now.joints.shape))
        smooth = np.ones(count, dtype=bool)
        rows = np.arange(count)
        while len(rows):
            here = now.take(rows)
            goal = along_edges(surface, edges[rows], ahead[rows])
            joints = polished(self._robot, here.joints[:, None], *goal, np.inf, _STEPS)
            there = self.described(joints[:, 0])
            way = shorter_way(here.joints, there.joints)
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = there.determinants / here.determinants
            # Small steps on which the determinant changes little, and so keeps its sign.
            sure = (np.abs(way).max(axis=1) <= _NEAR) & (ratio >= 1 / _CHANGE) & (ratio <= _CHANGE)
            change = measure.changes(lengths[rows], turns[rows], at[rows], ahead[rows])
            # What is lost for good: a jump, or surely a point that no motion may pass.
            smooth[rows[~sure & (change <= shortest)]] = False
            smooth[rows[sure & ~there.good]] = False
            gone, landed = rows[sure], np.flatnonzero(sure)
            for each in fields(now):
                getattr(now, each.name)[gone] = getattr(there, each.name)[landed]
            moved[gone] += way[landed]
            lowest[gone] = np.minimum(lowest[gone], moved[gone])
            highest[gone] = np.maximum(highest[gone], moved[gone])
            # A step that was sure is doubled for the next one, another one halved.
            length = (ahead[rows] - at[rows]) * np.where(sure, 2.0, 0.5)
            at[gone] = ahead[gone]
            ahead[rows] = np.minimum(at[rows] + length, 1.0)
            rows = rows[smooth[rows] & (at[rows] < 1.0)]
        now.joints[~smooth] = np.nan
        return now.joints, Motions(smooth, lowest, highest)
