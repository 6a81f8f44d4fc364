"""The configurations of a trajectory that are in contact: where on the surface, in which branch."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.dense import Dense, across_of, joint_steps, turns_off
from cellcolor.trajectory_checker.fine_mesh import FineMesh, Located
from cellcolor.trajectory_checker.tolerances import BRANCH

_SAME = 1e-6  # rad, m; solutions so near to each other are one


@dataclass(frozen=True)
class Contact:
    """Configurations in contact.

    Attributes:
        dense: the trajectory with all configurations that are judged.
        rows: (c,) those of them in contact.
        at: the nearest points of the surface.
        segment: (c,) of the painting, as the trajectory has it.
        across: (c, 3) the tool's x axis; zero where the setup does not give the tool's turn.
        branches: (c,) of the arm, -1 for a configuration that is near no solution.
    """

    dense: Dense
    rows: Index
    at: Located
    segment: Index
    across: Array
    branches: Index

    def __len__(self) -> int:
        return len(self.rows)

    def take(self, which: Mask) -> Contact:
        """Some of them."""
        _, _, at, *others = (getattr(self, field.name) for field in fields(self))
        kept = (values[which] for values in others)
        return Contact(self.dense, self.rows[which], at.take(which), *kept)

    @property
    def tips(self) -> Array:
        """(c, 3) where the tool's tip is, m."""
        return self.dense.tips[self.rows]

    @property
    def sample(self) -> Index:
        """(c,) the sample, or the one before."""
        return self.dense.sample[self.rows]

    @property
    def stroke(self) -> Index:
        """(c,) the number of the stroke."""
        return self.dense.stroke[self.rows]

    @cached_property
    def together(self) -> Mask:
        """(c - 1,) whether one and the next are on one stroke."""
        return np.asarray(self.stroke[1:] == self.stroke[:-1])

    @cached_property
    def steps(self) -> Array:
        """(c - 1,) how far the tip goes from one to the next, m."""
        return np.asarray(np.linalg.norm(np.diff(self.tips, axis=0), axis=1))

    def length(self, first: int = 0, last: int | None = None) -> float:
        """How far the tip goes in contact, m, or on its way between two rows."""
        part = slice(first, last)
        return float(self.steps[part][self.together[part]].sum())


def contact_of(
    prepared: PreparedScene,
    trajectory: Trajectory,
    dense: Dense,
    fine: FineMesh,
    deadline: Deadline,
) -> Contact:
    """Where and in which branch a trajectory is in contact."""
    rows = np.flatnonzero(dense.contact)
    at = fine.locate(dense.tips[rows], dense.outward[rows], deadline)
    across = np.zeros((len(rows), 3))
    if prepared.setup.task.turn is not None:
        across = across_of(prepared.robot, dense.joints[rows], deadline)
    branches = branches_of(prepared, dense, rows, across, deadline)
    return Contact(dense, rows, at, trajectory.segment[dense.sample[rows]], across, branches)


def branches_of(
    prepared: PreparedScene, dense: Dense, rows: Index, across: Array, deadline: Deadline
) -> Index:
    """The branch (c,) of each configuration, -1 if it is near no solution of a known branch.

    Joints are compared modulo full circles. A last joint that only turns the tool is ignored. Where
    branches of an arm without names have one configuration in common, as off the vertices at which
    they are told apart, the stroke stays in one of them as long as it can.

    Args:
        dense: the trajectory with all configurations that are judged.
        rows: (c,) the configurations.
        across: (c, 3) the tool's x axis, which matters if the setup gives the tool's turn.
    """
    found, compared = np.full(len(rows), -1), prepared.robot.task.joints
    several: dict[int, set[int]] = {}  # of rows with more than one branch
    for part in chunks(len(rows)):
        own = rows[part]
        solutions, before = _solutions(
            prepared, dense.tips[own], dense.axes[own], across[part], deadline
        )
        off = joint_steps(
            prepared.robot.slides[:compared],
            dense.joints[own, None, :compared],
            solutions[..., :compared],
        ).max(axis=2)
        off = np.where(np.isnan(off), np.inf, off)
        nearest = np.argmin(off, axis=1)
        least = off[np.arange(len(own)), nearest]
        known = least <= BRANCH
        found[part][known] = (before + nearest)[known]
        same = known[:, None] & (off <= least[:, None] + _SAME)
        for row in np.flatnonzero(same.sum(axis=1) > 1).tolist():
            several[part.start + row] = set((before[row] + np.flatnonzero(same[row])).tolist())
    return _steady(found, several, dense.stroke[rows]) if several else found


def _steady(found: Index, several: dict[int, set[int]], stroke: Index) -> Index:
    """The branch of each row of strokes, with as few changes as rows in several branches allow."""
    chosen, begin, common = found.copy(), 0, set[int]()
    for row in range(len(found) + 1):
        own = several.get(row, set(found[row : row + 1].tolist()))
        if row > begin and row < len(found) and stroke[row] == stroke[begin] and common & own:
            common &= own
            continue
        if row > begin:
            chosen[begin:row] = found[begin] if found[begin] in common else min(common)
        begin, common = row, set(own)
    return chosen


def _solutions(
    prepared: PreparedScene, tips: Array, axes: Array, across: Array, deadline: Deadline
) -> tuple[Array, Index]:
    """All solutions (k, branches, joints) of poses, and the number (k,) of their first branch.

    If the setup gives turns of the tool, branches are numbered turn by turn. Then a pose is solved
    with its own turn, and its branches are those of the nearest given turn.
    """
    kinematics = prepared.arm.kinematics
    if not isinstance(kinematics, TurnedKinematics):
        return prepared.arm.inverse(tips, axes, deadline), np.zeros(len(tips), dtype=np.int64)
    number = np.argmin(turns_off(kinematics.turn, tips, axes, across), axis=1)
    return kinematics.solve_pose(tips, axes, across), number * len(kinematics.own.branches)
