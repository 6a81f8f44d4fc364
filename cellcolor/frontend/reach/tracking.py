"""Solutions followed along mesh edges by Newton's method, with steps whose length adapts (numerical
continuation, ``docs/frontend.md``).

This finds out which solution at another pose is meant. Whether a motion there is continuous is
tested as of named branches (:mod:`cellcolor.frontend.reach.smooth`), in much shorter steps.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.configurations.matching import shorter_way
from cellcolor.frontend.arm.kinematics import (
    Conditioning,
    forward,
    manipulability,
    signed_task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.newton import polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.parts.surface import Surface, along_edges
from cellcolor.frontend.reach.smooth import Measure, Motions
from cellcolor.memory import chunks


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
            measure: what is a jump.
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
            linear, angular = tip_jacobian(poses)
            own = signed_task_determinant(linear, angular, poses.tool_axis, task)
            determinants[rows], good[rows] = own, True
            if self._limits is not None:
                good[rows] = (np.abs(own) >= self._limits.min_task_determinant) & (
                    manipulability(linear, task) >= self._limits.min_manipulability
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
