"""Judges contact: tip on the surface, tool against the normal, one branch, no crack crossed."""

from __future__ import annotations

import numpy as np

from cellcolor.arrays import Array, Index, Mask
from cellcolor.data.trajectory_verdict import FaultKind
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.turned import TurnedKinematics
from cellcolor.frontend.build import BuildResult
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.dense import Dense, angles, joint_steps
from cellcolor.trajectory_checker.fault_list import FaultList, stretches
from cellcolor.trajectory_checker.fine_mesh import FineMesh, Located
from cellcolor.trajectory_checker.tolerances import BRANCH, LEAVING, OFF_SURFACE, TILT
from cellcolor.trajectory_checker.tool_turn import turns_off

_SAME = 1e-6  # rad, m; solutions so near to each other are one
_PARTS = 16  # a step that seems to cross a crack is tested in so many parts: it may pass its end


def judge_contact(
    dense: Dense, rows: Index, located: Located, direction: bool, faults: FaultList
) -> Mask:
    """Note where the tip is off the surface or the tool is tilted.

    Args:
        dense: the trajectory with all configurations that are judged.
        rows: (c,) its rows in contact.
        located: the nearest points of the surface to these.
        direction: whether the task holds the tool against the normal.

    Returns:
        (c,) whether the tip is on the surface.
    """
    apart = np.linalg.norm(dense.tips[rows] - located.points, axis=1)
    _note(
        "off surface",
        dense,
        rows,
        1000 * apart,
        1000 * OFF_SURFACE,
        "the tip is {:.4g} mm off the surface, allowed: {:.4g}",
        faults,
    )
    if direction:
        tilt = angles(dense.outward[rows], located.normals)
        _note(
            "tilted",
            dense,
            rows,
            np.degrees(tilt),
            float(np.degrees(TILT)),
            "the tool is {:.4g} degrees off the surface's normal, allowed: {:.4g}",
            faults,
        )
    return np.asarray(apart <= OFF_SURFACE)


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


def _note(
    kind: FaultKind,
    dense: Dense,
    rows: Index,
    measure: Array,
    most: float,
    text: str,
    faults: FaultList,
) -> None:
    excess = np.zeros(len(dense))
    excess[rows] = measure
    faults.add_stretches(
        kind,
        excess > most,
        excess,
        lambda k: text.format(excess[k], most) + dense.where(k),
        dense.tips,
        sample_of=dense.sample,
    )


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
    for part in chunks(len(rows), 64 * compared * prepared.arm.slots):
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
    kinematics = prepared.kinematics
    if not isinstance(kinematics, TurnedKinematics):
        return prepared.arm.inverse(tips, axes, deadline), np.zeros(len(tips), dtype=np.int64)
    number = np.argmin(turns_off(kinematics.turn, tips, axes, across), axis=1)
    return kinematics.solve_pose(tips, axes, across), number * len(kinematics.own.branches)


def judge_cracks(
    built: BuildResult,
    dense: Dense,
    rows: Index,
    located: Located,
    branches: Index,
    fine: FineMesh,
    faults: FaultList,
) -> None:
    """Note where the branch changes in contact, and where a crack of the color is crossed."""
    together = dense.stroke[rows[1:]] == dense.stroke[rows[:-1]]
    known = together & (branches[1:] >= 0) & (branches[:-1] >= 0)
    changed = known & (branches[1:] != branches[:-1])
    names = built.branches
    for step in np.flatnonzero(changed).tolist():
        k = int(rows[step])
        text = f"changes from {names[branches[step]]!r} to {names[branches[step + 1]]!r}"
        after = int(dense.sample[rows[step + 1]])
        faults.add("branch", text, int(dense.sample[k]), after, place=dense.tips[k])
    torn = _torn(built)
    if not len(torn):
        return
    steps = np.flatnonzero(known & ~changed)
    steps = steps[_crosses(located.owner[steps], located.owner[steps + 1], branches[steps], torn)]
    if not len(steps):
        return
    share = np.linspace(0.0, 1.0, _PARTS + 1)[None, :, None]
    start, end = located.points[steps, None], located.points[steps + 1, None]
    points = (start + share * (end - start)).reshape(-1, 3)
    outward = np.repeat(dense.outward[rows[steps]], _PARTS + 1, axis=0)
    owner = fine.locate(points, outward).owner.reshape(len(steps), -1)
    of = np.repeat(branches[steps][:, None], _PARTS, axis=1)
    for row, step in enumerate(steps.tolist()):
        crossing = _crosses(owner[row, :-1], owner[row, 1:], of[row], torn)
        if not crossing.any():
            continue
        part = int(np.argmax(crossing))
        u, v = int(owner[row, part]), int(owner[row, part + 1])
        k = int(rows[step])
        text = f"crosses the crack between vertices {u} and {v} in {names[branches[step]]!r}"
        after = int(dense.sample[rows[step + 1]])
        faults.add("crack", text, int(dense.sample[k]), after, place=dense.tips[k])


def _torn(built: BuildResult) -> Index:
    """The cracks (t, 3), sorted: both vertices, the smaller first, and the branch.

    Joint limits are judged elsewhere. If they divide a branch into several colors, the cracks
    between these are no faults here: the cracks modulo full circles are taken instead.
    """
    cleaned, limits = built.stages.cleaned, built.limits
    divided = {limits.color[color] for color in limits.positions}
    whole, modulo = built.color_branch, cleaned.coloring.branch
    torn = {
        (min(crack.i, crack.j), max(crack.i, crack.j), branch[color])
        for cracks, branch, colors in (
            (built.surface.cracks, whole, set(range(len(whole))) - limits.positions.keys()),
            (cleaned.cracks, modulo, divided),
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
