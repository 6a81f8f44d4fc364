"""Programs for controllers: one order of moves, written in four languages (``languages``).

The setup's table ``[controller]`` says how the controller counts angles. An arm of Universal Robots
is known by its axes, and needs no table. Each program refuses to start unless the arm stands where
the motion begins, and ends where a move was not planned.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from cellcolor.arrays import Array, Index
from cellcolor.exports.interface import (
    Export,
    NotForThisArm,
    PlannedMotion,
    Samples,
    slopes,
    stretches,
    via_points,
)
from cellcolor.exports.languages import LANGUAGES, Job, Language, Move
from cellcolor.frontend.setup import Controller

if TYPE_CHECKING:
    from cellcolor.frontend.arm.robot import Robot

UR_STEP = 0.008  # s; the rate at which a UR controller is fed unless another is asked for
WITHIN = 5e-4  # rad from the samples between via points
BESIDE, ASIDE = 1e-4, 1e-3  # m and rad; the same of the tip between the points of linear moves
PRESSED = np.radians(3.0)  # so far the tool's axis turns until the force is given a new direction
_UR_JOINTS = (
    "shoulder_pan_joint",
    "shoulder_lift_joint",
    "elbow_joint",
    "wrist_1_joint",
    "wrist_2_joint",
    "wrist_3_joint",
)


def _program(planned: PlannedMotion, name: str, linear: bool) -> bytes:
    if controller_of(planned).language != name:
        raise NotForThisArm(f"its controller does not speak {name}")
    return "\n".join([*_lines(planned, LANGUAGES[name], linear), ""]).encode("ascii")


PROGRAMS = {
    stem + language.suffix: Export(language.kind, partial(_program, name=name, linear=linear))
    for name, language in LANGUAGES.items()
    for linear, stem in ((False, "cellcolor"), (True, "cellcolor_linear"))
}
"""The programs in each language by the names of their files: joint moves, and linear ones."""


def controller_of(planned: PlannedMotion) -> Controller:
    """The controller that the setup names, or that of an arm of Universal Robots.

    Raises:
        NotForThisArm: there is no program for any controller of this arm; the text says why.
    """
    robot, given = planned.robot, planned.controller
    if robot is None or len(robot.turning) != 6 or robot.joints != 6:
        raise NotForThisArm("the arm does not have six joints that turn")
    if given is None and not _named_as_ur(robot):
        raise NotForThisArm("the setup names no controller (table [controller], key language)")
    controller = given or Controller(language="urscript")
    if _is_ur(controller):
        _check_ur(robot)
    return controller


def _is_ur(controller: Controller) -> bool:
    """Whether the arm has to be one of Universal Robots: angles are theirs, none is changed."""
    return controller.language == "urscript" and controller.counts_as_urdf


def shown(controller: Controller, joints: Array) -> Array:
    """What the controller shows, (k, 6) in degrees, for joints (k, 6) of the URDF in rad."""
    degrees = np.degrees(joints) * controller.signs + controller.offsets_deg
    degrees[:, 2] -= controller.coupling * degrees[:, 1]
    return np.asarray(degrees)


def _lines(planned: PlannedMotion, language: Language, linear: bool) -> Iterator[str]:
    controller, robot = controller_of(planned), planned.robot
    assert robot is not None
    step = planned.step_s or (UR_STEP if language.stepped else None)
    found = stretches(planned.trajectory, step)
    base = _ur_base(planned.base, robot) if _is_ur(controller) else planned.base
    tool, work_object = controller.frames
    job = Job(
        name="cellcolor_linear" if linear else "cellcolor",
        remarks=_remarks(
            planned, controller, base, linear, max((own.beside for own in found), default=0)
        ),
        tool=str(tool),
        tip=np.linalg.inv(planned.flange) @ robot.tip,
        work_object=str(work_object),
        part=np.linalg.inv(base) @ planned.part,
        stretches=len(found),
        step_s=step or 0.0,
        force_n=planned.force_n,
    )
    yield from language.head(job)
    for number, own in enumerate(found, start=1):
        moves = _moves(planned, controller, robot, own, linear)
        start = next(moves)
        yield from language.begin(number, start)
        yield from language.press(job) if start.presses else ()
        pressing = start.contact
        for move in moves:
            if move.begins or (not move.contact and pressing):
                yield language.remark(f"contact {'begins' if move.contact else 'ends'}")
            if planned.force_n and pressing and not move.contact:
                yield from language.release
            pressing = move.contact
            yield language.linear(job, move) if move.feed else language.joint(job, move)
            if move.presses:
                yield from language.press(job)
        if planned.force_n and pressing:
            yield from language.release
        yield from language.end
    yield from language.tail(job)


def _remarks(
    planned: PlannedMotion, controller: Controller, base: Array, linear: bool, beside: float
) -> list[str]:
    """What a reader of the program has to know, whatever its language.

    Args:
        base: (4, 4) pose of the controller's base in the world.
    """
    down = (np.linalg.inv(base)[:3, :3] @ [0.0, 0.0, -1.0]).round(3) + 0.0
    remarks = [
        "No parser of the maker has read this program: run it in simulation first.",
        f"In the controller's frame, gravity points along ({down[0]:g}, {down[1]:g}, {down[2]:g}):"
        " set the mounting, and the load.",
        f"Signs {list(controller.signs)}, offsets {list(controller.offsets_deg)} degrees, "
        f"coupling of axes 2 and 3 {controller.coupling}.",
    ]
    if planned.step_s is not None:
        remarks.append(f"A point every {planned.step_s:g} s.")
    else:
        remarks.append(f"Between two joint moves no joint is more than {WITHIN:g} rad off the way.")
    if beside:
        remarks.append(
            "The time step is fixed, which rounds off the corners of the judged motion: joints are "
            f"up to {beside:.2g} rad off it there."
        )
    if linear:
        remarks.append(
            f"Linear moves: x, y and z at most {1e3 * BESIDE:g} mm from the judged samples, the "
            f"tool {np.degrees(ASIDE):.2g} degrees; the judge has not judged linear moves."
        )
    return remarks


def _moves(
    planned: PlannedMotion,
    controller: Controller,
    robot: Robot,
    own: Samples,
    linear: bool,
) -> Iterator[Move]:
    """The places that a stretch leads to, the first one where it begins."""
    from cellcolor.frontend.arm.kinematics import forward, turned

    poses, seen = forward(robot, own.joints), np.linalg.inv(planned.part)
    turns = _quaternions(seen[:3, :3] @ turned(poses.rotation[:, -1], robot.tip[:3, :3]))
    tips = poses.tip @ seen[:3, :3].T + seen[:3, 3]
    presses = _presses(own, -poses.tool_axis) if planned.force_n else np.zeros(0, dtype=np.int64)
    edges = np.flatnonzero(np.diff(own.contact))
    kept = np.concatenate([edges, edges + 1, presses])
    rows = via_points(own.times, own.joints / WITHIN, kept)
    if planned.step_s is not None:
        rows = np.arange(len(own.times))
    straight = own.contact[1:] & own.contact[:-1] & linear  # of each step
    if linear:
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))])
        asked = np.concatenate([tips / BESIDE, turns / (ASIDE / 2)], axis=1)
        touching = via_points(way, asked, kept)
        rows = np.union1d(rows[~own.contact[rows]], touching[own.contact[touching]])
    degrees = shown(controller, own.joints)
    feeds = np.linalg.norm(slopes(own.times, tips), axis=1)
    stroke = np.cumsum(np.diff(own.contact, prepend=False) & own.contact)
    feed_of = [float(feeds[own.contact & (stroke == number)].max(initial=0)) for number in
               range(int(stroke[-1]) + 1)]  # fmt: skip
    pressing = set(presses.tolist())
    resting = {n for n in (*edges.tolist(), *(edges + 1).tolist()) if own.contact[n]}
    if planned.led and not linear:
        resting = set()
    before = 0
    for place, row in enumerate(rows.tolist()):
        after = int(rows[min(place + 1, len(rows) - 1)])
        contact = bool(own.contact[row])
        yield Move(
            degrees=degrees[row],
            at=tips[row],
            turn=turns[row],
            seconds=float(own.times[row] - own.times[before]),
            contact=contact,
            begins=contact and not own.contact[before],
            presses=row in pressing,
            stops=place == len(rows) - 1 or row in resting,
            feed=feed_of[stroke[row]] if place and straight[before:row].all() and contact else 0.0,
            room=float(min(np.linalg.norm(tips[row] - tips[n]) for n in (before, after))),
            share=_share(robot, own, before, row),
        )
        before = row


def _quaternions(turns: Array) -> Array:
    """Quaternions (k, 4) x, y, z, w of rotations (k, 3, 3), neighbors never of opposite signs."""
    found = Rotation.from_matrix(turns).as_quat(canonical=True)
    opposite = np.sum(found[1:] * found[:-1], axis=1) < 0
    return np.asarray(found * np.cumprod(np.where([False, *opposite], -1.0, 1.0))[:, None])


def _share(robot: Robot, own: Samples, before: int, row: int) -> float:
    """What share of a joint's fastest speed a move takes, at most."""
    passed = max(own.times[row] - own.times[before], 1e-9)
    speeds = np.abs(own.joints[row] - own.joints[before]) / passed
    return float(np.nan_to_num(speeds / robot.velocity).max())


def _presses(own: Samples, outward: Array) -> Index:
    """Where the force is given its direction: as contact begins, and as the tool's axis turns."""
    found: list[int] = []
    for row in np.flatnonzero(own.contact).tolist():
        begins = row == 0 or not own.contact[row - 1]
        after = min(row + 1, len(outward) - 1)  # turned further there than is allowed
        if begins or outward[after] @ outward[found[-1]] < np.cos(PRESSED):
            found.append(row)
    return np.array(found, dtype=np.int64)


def _named_as_ur(robot: Robot) -> bool:
    names = zip(robot.joint_names, _UR_JOINTS, strict=True)
    return all(name.endswith(usual) for name, usual in names)


def _at_zero(robot: Robot) -> tuple[Array, Array]:
    """A point (joints, 3) on each axis, m, and the axes (joints, 3), with all joints at zero."""
    from cellcolor.frontend.arm.kinematics import forward

    poses = forward(robot, np.zeros((1, robot.joints)))
    return poses.origin[0, 1:], poses.axis[0]


def _ur_base(base: Array, robot: Robot) -> Array:
    """(4, 4) pose of the controller's base: at zero the arm is stretched out along its -x."""
    base, (_, (up, across, *_)) = base.copy(), _at_zero(robot)
    out = np.cross(across, up)
    base[:3, :3] = np.stack([-out, -np.cross(up, out), up], axis=1)
    return base


def _check_ur(robot: Robot) -> None:
    """Refuse an arm unless its axes, however it is mounted, are those of Universal Robots."""
    if not _named_as_ur(robot):
        raise NotForThisArm("its joints are not named as those of Universal Robots are")
    points, axes = _at_zero(robot)
    up, across = axes[:2]
    wanted = (up, across, across, across, -up, across)
    off = np.linalg.norm(axes - wanted, axis=1)
    if abs(up @ across) > 0.02 or (off > 0.02).any():
        number = int(np.argmax(off)) + 1
        raise NotForThisArm(
            f"at zero its axis {number} does not turn as that of arms of Universal Robots; give "
            "signs or offsets in the table [controller]"
        )
    steps = np.diff(points[1:4], axis=0)
    if (steps @ np.cross(across, up) <= 0.05).any() or (np.abs(steps @ up) > 0.02).any():
        raise NotForThisArm("at zero it is not stretched out along x, as a UR controller has it")
