"""Configurations in contact: where on the surface, in which branch, and how the tool is held."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cellcolor.arrays import Array, Index, Mask, stretches
from cellcolor.data.trajectory import Trajectory
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.dense import Dense, across_of, angles, joints_off, turns_off
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.fine_mesh import FineMesh, Located
from cellcolor.trajectory_checker.tolerances import BRANCH, LEAVING, OFF_SURFACE, TILT, TURN

_SAME = 1e-6  # rad, m; solutions so near to each other are one


@dataclass(frozen=True)
class Contact:
    """Configurations in contact.

    Attributes:
        dense: the trajectory with all configurations that are judged.
        rows: (c,) those of them in contact.
        at: the nearest points of the surface.
        segment: (c,) of the painting, as the trajectory has it.
        branches: (c,) of the arm, -1 for a configuration that is near no solution.
    """

    dense: Dense
    rows: Index
    at: Located
    segment: Index
    branches: Index

    def __len__(self) -> int:
        return len(self.rows)

    def take(self, which: Mask) -> Contact:
        """Some of them."""
        at, segment, branches = self.at.take(which), self.segment[which], self.branches[which]
        return Contact(self.dense, self.rows[which], at, segment, branches)

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
    branches = branches_of(prepared, dense, rows, deadline)
    return Contact(dense, rows, at, trajectory.segment[dense.sample[rows]], branches)


def branches_of(prepared: PreparedScene, dense: Dense, rows: Index, deadline: Deadline) -> Index:
    """The branch (c,) of each configuration, -1 if it is near no solution of a known branch.

    Joints are compared modulo full circles. A last joint that only turns the tool is ignored. Where
    branches of an arm without names have one configuration in common, as off the vertices at which
    they are told apart, the stroke stays in one of them as long as it can.

    Args:
        dense: the trajectory with all configurations that are judged.
        rows: (c,) the configurations.
    """
    found, compared = np.full(len(rows), -1), prepared.robot.task.joints
    several: dict[int, set[int]] = {}  # of rows with more than one branch
    for part in chunks(len(rows)):
        own = rows[part]
        solutions, before = _solutions(prepared, dense, own, deadline)
        asked, slides = dense.joints[own, :compared], prepared.robot.slides[:compared]
        off = joints_off(slides, asked, solutions[..., :compared])
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
    prepared: PreparedScene, dense: Dense, rows: Index, deadline: Deadline
) -> tuple[Array, Index]:
    """All solutions (k, branches, joints) of the poses that some configurations (k,) have.

    And the number (k,) of their first branch.

    If the setup gives turns of the tool, branches are numbered turn by turn. Then a pose is solved
    with its own turn, and its branches are those of the nearest given turn.
    """
    kinematics, tips, axes = prepared.arm.kinematics, dense.tips[rows], dense.axes[rows]
    if not isinstance(kinematics, TurnedKinematics):
        return prepared.arm.inverse(tips, axes, deadline), np.zeros(len(tips), dtype=np.int64)
    across = across_of(prepared.robot, dense.joints[rows], deadline)
    number = np.argmin(turns_off(kinematics.turn, tips, axes, across), axis=1)
    return kinematics.solve_pose(tips, axes, across), number * len(kinematics.own.branches)


_PARTS = 16  # a step that seems to cross a crack is tested in so many parts: it may pass its end


def judge_contact(contact: Contact, direction: bool, faults: FaultList) -> Mask:
    """Note where the tip is off the surface or the tool is tilted.

    Args:
        direction: whether the task holds the tool against the normal.

    Returns:
        (c,) whether the tip is on the surface.
    """
    dense, rows = contact.dense, contact.rows
    apart = np.linalg.norm(contact.tips - contact.at.points, axis=1)

    def off(row: int) -> str:
        most = f"{1000 * OFF_SURFACE:.4g}"
        return f"the tip is {1000 * apart[row]:.4g} mm off the surface, allowed: {most}"

    faults.add_rows("off surface", dense, rows, apart, OFF_SURFACE, off)
    if direction:
        tilt = angles(dense.outward[rows], contact.at.normals)

        def tilted(row: int) -> str:
            by, most = np.degrees(tilt[row]), np.degrees(TILT)
            return f"the tool is {by:.4g} degrees off the surface's normal, allowed: {most:.4g}"

        faults.add_rows("tilted", dense, rows, tilt, TILT, tilted)
    return np.asarray(apart <= OFF_SURFACE)


def judge_turn(
    prepared: PreparedScene, contact: Contact, deadline: Deadline, faults: FaultList
) -> None:
    """Note where the tool has none of the turns that the setup gives, if it gives any."""
    robot, turn, dense = prepared.robot, prepared.setup.task.turn, contact.dense
    if turn is None:
        return
    wanted = -contact.at.normals if robot.task.direction else dense.axes[contact.rows]
    across = across_of(robot, dense.joints[contact.rows], deadline)
    off = turns_off(turn, contact.tips, wanted, across).min(axis=1, initial=np.inf)

    def text(row: int) -> str:
        if np.isinf(off[row]):
            return "the setup's rule for the tool's turn is undefined here"
        by, most = np.degrees(off[row]), np.degrees(TURN)
        return (
            f"the tool is {by:.4g} degrees off the turn that the setup gives it, "
            f"allowed: {most:.4g}"
        )

    faults.add_rows("turned", contact.dense, contact.rows, off, TURN, text)


def judge_dragged(dense: Dense, fine: FineMesh, deadline: Deadline, faults: FaultList) -> None:
    """Note where the tip touches the surface although the trajectory says that it does not.

    It touches where it is at most ``OFF_SURFACE`` off. Just before and after a stroke the tool has
    to come and go: there it may stay that near for a way of ``LEAVING``.
    """
    away = np.flatnonzero(~dense.contact)
    away = away[fine.may_be_near(dense.tips[away], OFF_SURFACE)]
    if not len(away):
        return
    touches = np.zeros(len(dense), dtype=bool)
    at = fine.locate(dense.tips[away], dense.outward[away], deadline).points
    touches[away] = np.linalg.norm(dense.tips[away] - at, axis=1) <= OFF_SURFACE
    steps = np.linalg.norm(np.diff(dense.tips, axis=0), axis=1)
    for first, after in stretches(touches):
        # From the contact before, or to the one after it, if there is one.
        begin = max(first - 1, 0) if dense.contact[max(first - 1, 0)] else first
        end = min(after, len(dense) - 1) if dense.contact[min(after, len(dense) - 1)] else after - 1
        beside = begin < first or end >= after
        way = float(steps[begin:end].sum())
        if beside and way <= LEAVING:
            continue
        text = (
            f"touches the surface for {1000 * way:.3g} mm where the trajectory says that it does "
            f"not{dense.where(first)}"
        )
        faults.add(
            "dragged", text, int(dense.sample[first]), int(dense.sample[after - 1]),
            place=dense.tips[first],
        )  # fmt: skip


def judge_cracks(built: BuildResult, contact: Contact, fine: FineMesh, faults: FaultList) -> None:
    """Note where the branch changes in contact, and where a crack of the color is crossed."""
    branches, at, names = contact.branches, contact.at, built.branches

    def note(kind: FaultKind, text: str, step: int) -> None:
        sample, after = (int(contact.sample[row]) for row in (step, step + 1))
        faults.add(kind, text, sample, after, place=contact.tips[step])

    known = contact.together & (branches[1:] >= 0) & (branches[:-1] >= 0)
    changed = known & (branches[1:] != branches[:-1])
    for step in np.flatnonzero(changed).tolist():
        text = f"changes from {names[branches[step]]!r} to {names[branches[step + 1]]!r}"
        note("branch", text, step)
    torn = _torn(built)
    if not len(torn):
        return
    steps = np.flatnonzero(known & ~changed)
    steps = steps[_crosses(at.owner[steps], at.owner[steps + 1], branches[steps], torn)]
    if not len(steps):
        return
    share = np.linspace(0.0, 1.0, _PARTS + 1)[None, :, None]
    start, end = at.points[steps, None], at.points[steps + 1, None]
    points = (start + share * (end - start)).reshape(-1, 3)
    outward = np.repeat(contact.dense.outward[contact.rows[steps]], _PARTS + 1, axis=0)
    owner = fine.locate(points, outward).owner.reshape(len(steps), -1)
    of = np.repeat(branches[steps][:, None], _PARTS, axis=1)
    crossing = _crosses(owner[:, :-1], owner[:, 1:], of, torn)
    for row in np.flatnonzero(crossing.any(axis=1)).tolist():
        u, v = owner[row, (part := int(np.argmax(crossing[row]))) : part + 2].tolist()
        name = names[branches[steps[row]]]
        note("crack", f"crosses the crack between vertices {u} and {v} in {name!r}", steps[row])


def _torn(built: BuildResult) -> Index:
    """The cracks (t, 3), sorted: both vertices, the smaller first, and the branch.

    Joint limits are judged elsewhere. If they divide a branch into several colors, the cracks
    between these are no faults here: the cracks modulo full circles are taken instead.
    """
    coloring, limits = built.coloring, built.limits
    divided = {limits.color[color] for color in limits.positions}
    whole, modulo = built.color_branch, coloring.branch
    torn = {
        (min(crack.i, crack.j), max(crack.i, crack.j), branch[color])
        for cracks, branch, colors in (
            (built.surface.cracks, whole, set(range(len(whole))) - limits.positions.keys()),
            (coloring.cracks, modulo, divided),
        )
        for crack in cracks
        for color in crack.colors
        if color in colors
    }
    return np.array(sorted(torn), dtype=np.int64).reshape(-1, 3)


def _crosses(one: Index, other: Index, branches: Index, torn: Index) -> Mask:
    """Whether steps (s,), each from one vertex's part to another's, cross a crack of the branch."""
    vertices = int(max(torn[:, 1].max(), one.max(initial=0), other.max(initial=0))) + 1
    low, high = np.minimum(one, other), np.maximum(one, other)
    most = int(max(torn[:, 2].max(), branches.max(initial=0))) + 1
    keys = (low * vertices + high) * most + branches
    return np.isin(keys, (torn[:, 0] * vertices + torn[:, 1]) * most + torn[:, 2])
