"""Whether every configuration passes the scene's tests: all in contact, contacts on the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cellcolor.arrays import Array, Index
from cellcolor.data.candidate_table import VALID
from cellcolor.data.trajectory import Trajectory
from cellcolor.deadline import Deadline
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.prepared import PreparedScene
from cellcolor.frontend.reach.validity import Judge
from cellcolor.frontend.reach.validity_tests import Workplace
from cellcolor.memory import chunks
from cellcolor.trajectory_checker.contacts import Pair, pairs_of, touching
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
    reasons = _reasons(prepared, prepared.judge, dense.joints[contact], deadline)
    _note(dense, contact, reasons, names, faults)
    # What lies between two samples with no planned move is known to be nothing.
    on_the_way = np.flatnonzero(~dense.contact & ~(unplanned[dense.sample] & (dense.way > 0)))
    setup = prepared.setup.varied(constraints={"force": False, "conditioning": False})
    judge = Judge(replace(prepared, arm=replace(prepared.arm, setup=setup)))
    joints = dense.joints[on_the_way]
    reasons = _reasons(prepared, judge, joints, deadline, on_the_way=True)
    _note(dense, on_the_way, reasons, judge.reason_names, faults)


def _reasons(
    prepared: PreparedScene,
    judge: Judge,
    joints: Array,
    deadline: Deadline,
    *,
    on_the_way: bool = False,
) -> NDArray[np.uint8]:
    """The code (k,) of the first test that each configuration fails; contacts by an own engine."""
    names = judge.reason_names
    tests: dict[str, list[Pair]] = {}
    if prepared.setup.constraints.collision:
        tests = pairs_of(prepared)
        if on_the_way:
            tests["object collision"] += _through_object(prepared)
    others = judge.only(frozenset(names) - tests.keys())
    reasons = np.zeros(len(joints), dtype=np.uint8)
    for rows in chunks(len(joints)):
        found = others(joints[rows], deadline).reasons
        poses = forward(prepared.robot, joints[rows])
        for name in sorted(tests, key=names.index):
            deadline.check()
            code = names.index(name)
            asked = np.flatnonzero((found == VALID) | (found > code))
            found[asked[touching(tests[name], poses.take(asked))]] = code
        reasons[rows] = found
    return reasons


def _through_object(place: Workplace) -> list[Pair]:
    """The tool's axis between the tip and the tool's body, which must not meet the object.

    The first millimeter from the tip is left out: the tip may lie on the object.
    """
    tip = place.tip.body
    if tip.length <= OFF_SURFACE:
        return []
    start = tip.start + OFF_SURFACE / tip.length * (tip.end - tip.start)
    return [(replace(tip, start=start, radius=_THIN), place.target, 0.0)]


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
