"""Solutions without names, followed along mesh edges (``docs/frontend.md``, "Continuity").

A step leads from a configuration to the solution at its end that is nearest and has the same sign
of the task determinant, which no motion without singularity changes. It counts only if it is less
than half as long as the way to any other solution of that sign, at either end. Then the solution is
the nearest one seen from both ends, with room to spare; longer steps are halved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.frontend.arm.kinematics import (
    Conditioning,
    bytes_of_poses,
    forward,
    manipulability,
    signed_task_determinant,
    tip_jacobian,
)
from cellcolor.frontend.arm.newton import polished
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.parts.surface import Surface, along_edges
from cellcolor.frontend.reach.smooth import Measure, Motions, joint_step, shorter_way
from cellcolor.memory import chunks


@dataclass(frozen=True)
class Solutions:
    """All solutions of some poses (n, s), or one of each (n,).

    Attributes:
        joints: (..., joints) in rad, NaN where there is none.
        determinants: (...) task determinant with its sign, m^3, NaN where there is none.
        apart: (...) how far the nearest other solution of the pose with the same sign is, the joint
            that moves farthest, rad; infinite if there is no other.
        good: (...) whether the thresholds on conditioning are kept.
    """

    joints: Array
    determinants: Array
    apart: Array
    good: Mask

    def take(self, *index: Index | slice | int) -> Solutions:
        """Some of them, as numpy indexes."""
        return Solutions(*(getattr(self, each.name)[index] for each in fields(self)))


def clearly_nearest(step: Array, first: Array, second: Array) -> Mask:
    """Whether steps in rad are less than half as long as the ways to other solutions at the ends.

    A step to any other solution is longer then, whichever end it begins at.
    """
    return np.asarray(2 * step < np.minimum(first, second))


class Tracker:
    """Follows solutions of one arm along mesh edges.

    Attributes:
        measure: what is a jump.
    """

    def __init__(
        self,
        robot: Robot,
        solve: Callable[[Array, Array], Array],
        measure: Measure,
        limits: Conditioning | None,
        slots: int,
    ) -> None:
        """An arm and what is asked of its motions.

        Args:
            solve: points (n, 3) and directions (n, 3) to all solutions (n, s, joints).
            measure: what is a jump.
            limits: what counts as well conditioned; everything, without.
            slots: how many solutions a pose may have.
        """
        self._robot, self._solve, self.measure, self._limits = robot, solve, measure, limits
        self._pose = slots * bytes_of_poses(robot.joints)  # bytes
        self._shortest = measure.shortest

    def described(self, joints: Array) -> Solutions:
        """Solutions (n, s, joints) of n poses, with what is needed to tell them apart."""
        shape = joints.shape[:2]
        whole = Solutions(
            joints, np.full(shape, np.nan), np.full(shape, np.inf), np.zeros(shape, dtype=bool)
        )
        for rows in chunks(len(joints), joints.shape[1] * bytes_of_poses(self._robot.joints)):
            self._describe(whole.take(rows))
        return whole

    def _describe(self, part: Solutions) -> None:
        """Fill in all but the joints; the arrays are parts of larger ones."""
        there = np.nonzero(~np.isnan(part.joints[:, :, 0]))
        poses = forward(self._robot, part.joints[there])
        linear, angular = tip_jacobian(poses)
        task = self._robot.task
        determinants = signed_task_determinant(linear, angular, poses.tool_axis, task)
        part.determinants[there], part.good[there] = determinants, True
        if self._limits is not None:
            part.good[there] = (np.abs(determinants) >= self._limits.min_task_determinant) & (
                manipulability(linear, task) >= self._limits.min_manipulability
            )
        signs = np.sign(part.determinants)
        for other in range(part.joints.shape[1]):
            step = joint_step(part.joints, part.joints[:, other : other + 1])
            step[:, other] = np.inf
            step[~(signs == signs[:, other : other + 1])] = np.inf  # NaN is equal to nothing
            np.minimum(part.apart, step, out=part.apart)

    def walk(
        self, surface: Surface, edges: Index, start: Solutions, until: Array
    ) -> tuple[Array, Motions]:
        """Follow solutions from the first ends of edges.

        Args:
            edges: (k, 2) vertex indices.
            start: (k,) at the first ends.
            until: (k,) how far, from 0 to 1.

        Returns:
            Where they end, (k, joints), NaN where a motion is lost since it jumps or passes a point
            that is ill-conditioned; and the motions.
        """
        measure, count = self.measure, len(edges)
        lengths, turns = surface.lengths(edges), surface.turns(edges)
        at, ahead = np.zeros(count), until.copy()
        now = Solutions(*(getattr(start, each.name).copy() for each in fields(start)))
        moved, lowest, highest = np.zeros((3, *now.joints.shape))
        smooth = np.ones(count, dtype=bool)
        rows = np.flatnonzero(until > 0)
        while len(rows):
            there = self._nearest(surface, edges[rows], ahead[rows], now.take(rows))
            here = now.take(rows)
            way = shorter_way(here.joints, there.joints)
            step = np.abs(way).max(axis=1)
            change = measure.changes(lengths[rows], turns[rows], at[rows], ahead[rows])
            sure = self._sure(step, change, here, there)
            # What is lost for good: a jump, or surely a point that no motion may pass.
            smooth[rows[~sure & (change <= self._shortest)]] = False
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
            ahead[rows] = np.minimum(at[rows] + length, until[rows])
            rows = rows[smooth[rows] & (at[rows] < until[rows])]
        now.joints[~smooth] = np.nan
        return now.joints, Motions(smooth, lowest, highest)

    def _sure(self, step: Array, change: Array, here: Solutions, there: Solutions) -> Mask:
        """Which steps (k,) lead to the same solution without a jump."""
        nearest = np.fmin(np.abs(here.determinants), np.abs(there.determinants))
        clear = clearly_nearest(step, here.apart, there.apart)
        return clear & self.measure.settled(step, change, nearest)

    def _nearest(self, surface: Surface, edges: Index, way: Array, now: Solutions) -> Solutions:
        """The solutions (k,) at points of edges that are nearest to others of the same sign."""
        parts = []
        for rows in chunks(len(edges), self._pose):
            here = now.take(rows)
            found = self.described(self._solve(*along_edges(surface, edges[rows], way[rows])))
            step = joint_step(found.joints, here.joints[:, None])
            same = np.sign(found.determinants) == np.sign(here.determinants)[:, None]
            step = np.where(same, step, np.inf)
            if step.shape[1] == 0:  # no pose has any
                parts.append(_none(here))
                continue
            best = np.argmin(step, axis=1)
            chosen = found.take(np.arange(len(best)), best)
            chosen.joints[np.isinf(step.min(axis=1))] = np.nan
            parts.append(chosen)
        return Solutions(
            *(np.concatenate([getattr(part, each.name) for part in parts]) for each in fields(now))
        )


_NEAR = 0.25  # rad; no joint moves farther on a step of Newton's method
_CHANGE = 4.0  # by this factor at most the determinant changes on it
_SHORTER = 8  # than the spacing of probes: no step is shorter


class NewtonTracker(Tracker):
    """Follows one solution by Newton's method, without knowing the others of a pose.

    It finds out which solution is meant at a pose. Whether a motion there is continuous is tested
    as of named branches (:mod:`cellcolor.frontend.reach.smooth`), in much shorter steps.
    """

    def __init__(self, robot: Robot, measure: Measure) -> None:
        """An arm whose tool is on the last axis, and what is a jump."""
        super().__init__(robot, lambda points, _: np.empty((len(points), 0, 0)), measure, None, 1)
        self._shortest = measure.policy.probe_spacing_m / _SHORTER

    def _sure(self, step: Array, change: Array, here: Solutions, there: Solutions) -> Mask:  # noqa: ARG002
        """Small steps on which the determinant changes little, and so keeps its sign."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.asarray(there.determinants / here.determinants)
        return np.asarray((step <= _NEAR) & (ratio >= 1 / _CHANGE) & (ratio <= _CHANGE))

    def _nearest(self, surface: Surface, edges: Index, way: Array, now: Solutions) -> Solutions:
        points, directions = along_edges(surface, edges, way)
        joints = polished(self._robot, now.joints[:, None], points, directions, np.inf)
        return self.described(joints).take(slice(None), 0)


def _none(like: Solutions) -> Solutions:
    """As many poses without any solution."""
    count = len(like.joints)
    return Solutions(
        np.full_like(like.joints, np.nan),
        np.full(count, np.nan),
        np.full(count, np.inf),
        np.zeros(count, dtype=bool),
    )
