"""Whether every configuration passes the scene's tests: all in contact, contacts on the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.body import Body
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.validity import Judge
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.dense import Dense
from cellcolor.trajectory_checker.fault_list import FaultList
from cellcolor.trajectory_checker.tolerances import OFF_SURFACE

_THIN = 1e-4  # m; radius of the axis of the tool's tip, which must not pass through the object


def judge_validity(
    prepared: PreparedScene,
    trajectory: Trajectory,
    dense: Dense,
    deadline: Deadline,
    faults: FaultList,
) -> None:
    """Note configurations that fail a test, and moves that were not planned.

    In contact all tests of the scene are asked. On the way between strokes only contacts are, of
    the arm and of the tool's tip; there the tip may not pass through the object either.
    """
    unplanned = np.zeros(len(trajectory.times), dtype=bool)
    unplanned[list(trajectory.unplanned)] = True
    at_samples = dense.tips[dense.way == 0]
    for sample in trajectory.unplanned:
        text = "the move to the next sample was not planned"
        faults.add("unplanned", text, sample, place=at_samples[sample])
    contact = np.flatnonzero(dense.contact)
    names = prepared.judge.reason_names
    _note(dense, contact, _reasons(prepared.judge, dense.joints[contact], deadline), names, faults)
    # What lies between two samples with no planned move is known to be nothing.
    on_the_way = np.flatnonzero(~dense.contact & ~(unplanned[dense.sample] & (dense.way > 0)))
    setup = prepared.setup.varied(constraints={"force": False, "conditioning": False})
    judge = Judge(replace(prepared.workplace, arm=replace(prepared.arm, setup=setup)))
    reasons = _reasons(judge, dense.joints[on_the_way], deadline)
    if setup.constraints.collision:
        through = np.flatnonzero(reasons == VALID)
        rows = on_the_way[through]
        hit = _through_object(prepared, dense.tips[rows], dense.axes[rows])
        reasons[through[hit]] = judge.reason_names.index("object collision")
    _note(dense, on_the_way, reasons, judge.reason_names, faults)


def _reasons(judge: Judge, joints: Array, deadline: Deadline) -> NDArray[np.uint8]:
    """The code (k,) of the first test that each configuration fails."""
    reasons = np.zeros(len(joints), dtype=np.uint8)
    for rows in chunks(len(joints), judge.bytes_kept(joints.shape[1])):
        reasons[rows] = judge(joints[rows], deadline).reasons
    return reasons


def _through_object(prepared: PreparedScene, tips: Array, axes: Array) -> NDArray[np.bool_]:
    """Whether the tool's axis meets the object between the tip and the tool's body, (k,).

    The first millimeter from the tip is left out: the tip may lie on the object.
    """
    length = prepared.workplace.tip.body.length
    if length <= OFF_SURFACE:
        return np.zeros(len(tips), dtype=bool)
    body = Body("tool tip", 0, np.zeros(3), np.array([0, 0, length - OFF_SURFACE]), _THIN, False)
    ends = np.stack([tips - OFF_SURFACE * axes, tips - length * axes])
    return prepared.workplace.target.touched_by(body, ends)


def _note(
    dense: Dense,
    rows: Index,
    reasons: NDArray[np.uint8],
    names: tuple[str, ...],
    faults: FaultList,
) -> None:
    for code in sorted(set(reasons.tolist()) - {VALID}):
        name, failing = names[code], (reasons == code).astype(np.float64)

        def text(row: int, name: str = name) -> str:
            doing = "in contact" if dense.contact[rows[row]] else "on the way"
            return f"fails the test {name!r} {doing}"

        faults.add_rows("invalid", dense, rows, failing, 0.0, text, name)
