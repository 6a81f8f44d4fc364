"""Files for controllers, read back by readers that have no part in writing them."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
from hypothesis import given
from hypothesis import strategies as st
from read_programs import READERS, Program
from scipy.spatial.transform import Rotation, Slerp
from shipped import ROBOTS
from stand_in import stand_in
from waves import arm, driven, on

from cellcolor.errors import InputError
from cellcolor.exports.interface import PlannedMotion, stretches
from cellcolor.exports.programs import ASIDE, BESIDE, PRESSED, WITHIN
from cellcolor.exports.registry import exported, why_no_program
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Controller, Setup
from examples import examples

PROGRAMS = {
    "cellcolor.script": "ur5",
    "cellcolor.mod": "irb120",
    "cellcolor.src": "kr6",
    "cellcolor.ls": "kr6",
}
FANUC_ON_KR6 = {"cellcolor.ls": {"controller": Controller(language="fanuc")}}


def read(name: str, planned: PlannedMotion) -> Program:
    """A program, read by a grammar that has no part in writing it."""
    return READERS[Path(name).suffix](exported(planned)[name].decode("ascii"))


def judged(planned: PlannedMotion, name: str) -> list[Any]:
    """The samples of each stretch that the program goes by."""
    return stretches(planned.trajectory, 0.008 if name.endswith(".script") else None)


def urdf_joints(planned: PlannedMotion, degrees: np.ndarray) -> np.ndarray:
    """Joints of the URDF, rad, of what a controller shows: the table [controller] backwards."""
    table = planned.controller or Controller(language="urscript")
    own = np.array(degrees, dtype=float)
    own[..., 2] += (table.j23_factor or (table.language == "fanuc")) * own[..., 1]
    return np.radians((own - table.offsets_deg) * np.array(table.signs))


@pytest.mark.parametrize(("name", "robot"), PROGRAMS.items())
def test_between_its_points_a_program_is_the_judged_motion(name: str, robot: str) -> None:
    """Straight for the joints over time, as far off the samples as the program says."""
    planned = driven(robot, seed=3, unplanned=(20,), **FANUC_ON_KR6.get(name, {}))
    found = read(name, planned)
    assert found.called == [1] and len(found.stretches) == 2
    for start, moves, own in zip(found.starts, found.stretches, judged(planned, name), strict=True):
        assert np.allclose(urdf_joints(planned, start), own.joints[0], atol=1e-4)
        places = urdf_joints(planned, np.array([start, *(move.joints for move in moves)]))
        rows = [int(np.abs(own.joints - place).max(axis=1).argmin()) for place in places]
        assert rows == sorted(rows) and rows[-1] == len(own.times) - 1
        assert {0, *(np.flatnonzero(np.diff(own.contact)) + 1).tolist()} <= set(rows)
        assert len(rows) < len(own.times)
        for a, b in pairwise(rows):
            times = own.times[a : b + 1]
            straight = np.array(
                [np.interp(times, times[[0, -1]], own.joints[[a, b], j]) for j in range(6)]
            ).T
            assert np.abs(straight - own.joints[a : b + 1]).max() <= WITHIN + 1e-6
        if moves[0].seconds is not None:  # PTP of KRL has none
            taken, passed = [move.seconds for move in moves], np.diff(own.times[rows])
            assert np.allclose(taken, passed, atol=5e-4)


@pytest.mark.parametrize(("name", "robot"), PROGRAMS.items())
def test_between_linear_moves_the_tip_is_where_it_was_judged(name: str, robot: str) -> None:
    """Position and turn over the length of the line, in the named tool and work object."""
    stem, suffix = name.split(".")
    part = pin.SE3(pin.rpy.rpyToMatrix(0.3, -0.2, 1.0), np.array([0.5, -0.1, 0.2])).homogeneous
    planned = driven(robot, seed=3, part=part, force_n=9.0, **FANUC_ON_KR6.get(name, {}))
    found = read(f"{stem}_linear.{suffix}", planned)
    (own,), (moves,) = judged(planned, name), found.stretches
    assert np.allclose(planned.flange @ found.tool, planned.robot.tip, atol=2e-6)
    # Where the part is seen from: a controller of Universal Robots has its x axis backward.
    base = np.diag([-1.0, -1, 1, 1]) if suffix == "script" else np.eye(4)
    assert np.allclose(base @ found.part, part, atol=2e-5)
    tips = np.array([tip_of(arm(robot), joints) for joints in own.joints])
    stroke = np.cumsum(np.diff(own.contact, prepend=False) & own.contact)
    lines: list[list[np.ndarray]] = []
    for before, move in pairwise([m for m in moves if m.kind in ("joint", "linear")]):
        if move.kind == "linear":
            if before.kind == "joint":
                lines.append([tip_of(arm(robot), urdf_joints(planned, before.joints))])
                assert np.allclose(lines[-1][0], tips[own.contact & (stroke == len(lines))][0])
            lines[-1].append(
                base @ found.part @ move.pose
                if move.pose is not None
                else tip_of(arm(robot), urdf_joints(planned, move.joints))
            )
    assert len(lines) == stroke.max() == 2
    for number, line in enumerate(lines, start=1):
        rows = tips[own.contact & (stroke == number)]
        assert len(line) > 2
        at = [int(np.linalg.norm(rows[:, :3, 3] - p[:3, 3], axis=1).argmin()) for p in line]
        assert at[0] == 0 and at[-1] == len(rows) - 1
        for (a, first), (b, last) in pairwise(zip(at, line, strict=True)):
            steps = np.linalg.norm(np.diff(rows[a : b + 1, :3, 3], axis=0), axis=1)
            share = np.concatenate([[0.0], np.cumsum(steps) / steps.sum()])
            ends = Rotation.from_matrix([first[:3, :3], last[:3, :3]])
            turns = Slerp([0, 1], ends)(np.minimum(share, 1.0))
            places = first[:3, 3] + share[:, None] * (last[:3, 3] - first[:3, 3])
            assert np.abs((places - rows[a : b + 1, :3, 3]) @ part[:3, :3]).max() <= BESIDE + 1e-6
            off = (turns.inv() * Rotation.from_matrix(rows[a : b + 1, :3, :3])).magnitude()
            assert off.max() <= 2 * ASIDE


def tip_of(robot: Robot, joints: np.ndarray) -> np.ndarray:
    """(4, 4), by Pinocchio."""
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, joints)
    return data.oMi[6].homogeneous @ robot.tip


def on_the_wok(**keys: object) -> PlannedMotion:
    """Over the shipped wok, whose normal turns far in a stroke."""
    made = stand_in()
    own = on(made.prepared.robot, made.prepared.setup)
    planned = replace(made.trajectory, unplanned=())
    return PlannedMotion(planned, **own, **{"force_n": 20.0} | keys)


@pytest.mark.parametrize("name", ["cellcolor.script", "cellcolor_linear.script"])
def test_the_force_pulls_against_the_surface_along_the_whole_stroke(name: str) -> None:
    """The interpreter's rule: the task frame of ``force_mode`` stands still until the next call."""
    planned = on_the_wok()
    robot, found = stand_in().prepared.robot, read(name, planned)
    base = np.diag([-1.0, -1, 1, 1]) @ found.part
    pull, here, off, begun, turned = None, None, [], None, []
    for move in found.stretches[0]:
        if move.kind == "press":
            pull = here[:3, 2]  # +z of the actual pose of the tip
            begun = pull if begun is None else begun
        elif move.kind == "release":
            pull = begun = None
        else:
            posed = move.pose is not None
            here = base @ move.pose if posed else tip_of(robot, np.radians(move.joints))
            if pull is not None:
                # The tool's axis, which the judge holds to the normal; this motion cuts corners.
                off.append(np.degrees(np.arccos(np.clip(pull @ here[:3, 2], -1, 1))))
                turned.append(np.degrees(np.arccos(np.clip(begun @ here[:3, 2], -1, 1))))
    assert pull is None  # released at the end
    assert max(turned) > 60  # with one call a stroke it would have pulled that far aside
    assert max(off) <= np.degrees(PRESSED) + 1e-3


def test_a_stretch_that_begins_in_contact_presses_from_there() -> None:
    planned = driven("ur5", unplanned=(10,), force_n=9.0)
    assert planned.trajectory.contact[10:12].all()
    first, second = read("cellcolor.script", planned).stretches
    assert first[-1].kind == "release"
    assert second[0].kind == "press"


def test_krl_is_never_faster_than_planned_by_more_than_its_smallest_speed() -> None:
    planned = driven("kr6", step_s=0.05)
    found, top = read("cellcolor.src", planned), np.array([360, 300, 360, 381, 388, 615])
    before = found.starts[0]
    for move in found.stretches[0]:
        wanted = (np.abs(move.joints - before) / 0.05 / top).max()
        assert move.share <= max(0.01, wanted + 1e-4)
        assert move.share >= min(1.0, wanted) - 0.01 - 1e-4
        before = move.joints


# Points (m) and directions of the axes in the base frame when the controller shows zero degrees on
# all of them. They are the makers', as ros-industrial has them in kuka_kr6_support
# (kr6r900sixx_macro.xacro) and abb_irb120_support (irb120_3_58_macro.xacro).
KR6_R900 = (
    ((0.0, 0.0, 0.4), (0, 0, -1)),
    ((0.025, 0.0, 0.4), (0, 1, 0)),
    ((0.48, 0.0, 0.4), (0, 1, 0)),
    ((0.48, 0.0, 0.435), (-1, 0, 0)),
    ((0.9, 0.0, 0.435), (0, 1, 0)),
    ((0.98, 0.0, 0.435), (-1, 0, 0)),
)
IRB_120 = (
    ((0.0, 0.0, 0.29), (0, 0, 1)),
    ((0.0, 0.0, 0.29), (0, 1, 0)),
    ((0.0, 0.0, 0.56), (0, 1, 0)),
    ((0.0, 0.0, 0.63), (1, 0, 0)),
    ((0.302, 0.0, 0.63), (0, 1, 0)),
    ((0.374, 0.0, 0.63), (1, 0, 0)),
)


@pytest.mark.parametrize(
    ("name", "robot", "table"),
    [("cellcolor.src", "kr6", KR6_R900), ("cellcolor.mod", "irb120", IRB_120)],
)
def test_a_controller_s_degrees_put_the_wrist_where_the_urdf_has_it(
    name: str, robot: str, table: Any
) -> None:
    """The maker's axes turned by the degrees in the program, against Pinocchio on the URDF."""
    planned = driven(robot, seed=7, step_s=0.1)
    moves = read(name, planned).stretches[0]
    model = arm(robot).model
    data = model.createData()
    (own,) = stretches(planned.trajectory, 0.1)
    assert len(moves) == len(own.joints) - 1
    for move, joints in list(zip(moves, own.joints[1:], strict=True))[::5]:
        pin.forwardKinematics(model, data, joints)
        turn, shift = np.eye(3), np.zeros(3)
        for (point, direction), angle in zip(table, np.radians(move.joints), strict=True):
            # The axis, moved by those before it.
            center, axis = turn @ np.array(point) + shift, turn @ np.array(direction)
            turned = Rotation.from_rotvec(angle * axis).as_matrix()
            turn, shift = turned @ turn, center + turned @ (shift - center)
        last = np.array(table[5][0])
        assert np.allclose(turn @ last + shift, data.oMi[6].translation, atol=1e-6)
        assert np.allclose(turn, data.oMi[6].rotation, atol=1e-6)


def test_ur_joints_are_counted_as_the_controller_counts_them() -> None:
    """The maker's Denavit-Hartenberg constants, which its controllers compute with."""
    planned = driven("ur5", step_s=0.1)
    model = arm("ur5").model
    data = model.createData()
    constants = [
        (0, 0.089159, np.pi / 2), (-0.425, 0, 0), (-0.39225, 0, 0),
        (0, 0.10915, np.pi / 2), (0, 0.09465, -np.pi / 2), (0, 0.0823, 0),
    ]  # fmt: skip
    for move in read("cellcolor.script", planned).stretches[0][::5]:
        angles = np.radians(move.joints)
        pin.forwardKinematics(model, data, angles)
        pose = pin.SE3.Identity()
        for (a, d, alpha), angle in zip(constants, angles, strict=True):
            pose = pose * pin.SE3(pin.rpy.rpyToMatrix(0, 0, angle), np.array([0.0, 0.0, d]))
            pose = pose * pin.SE3(pin.rpy.rpyToMatrix(alpha, 0, 0), np.array([a, 0.0, 0.0]))
        # The last DH frame lies d6 along the last axis; the controller's base is turned by pi.
        base = pin.SE3(pin.rpy.rpyToMatrix(0, 0, np.pi), np.zeros(3))
        flange = base * pose
        axis = data.oMi[6].rotation[:, 2]
        assert np.allclose(flange.rotation[:, 2], axis, atol=1e-6)
        off = flange.translation - data.oMi[6].translation
        assert np.linalg.norm(off - (off @ axis) * axis) < 1e-6


@given(
    st.tuples(*[st.sampled_from([-1, 1])] * 6),
    st.tuples(*[st.integers(-180, 180).map(float)] * 6),
    st.sampled_from([-1, 0, 1]),
)
@examples(5)
def test_signs_offsets_and_coupling_are_those_of_the_setup(
    signs: Any, offsets: Any, coupling: Any
) -> None:
    table = Controller(language="fanuc", signs=signs, offsets_deg=offsets, j23_factor=coupling)
    planned = driven("kr6", controller=table, step_s=0.5)
    found = read("cellcolor.ls", planned).stretches[0][-1].joints
    zero = np.degrees(planned.trajectory.joints[-1]) * signs + offsets
    assert np.allclose(np.delete(found, 2), np.delete(zero, 2), atol=1e-4)
    assert found[2] == pytest.approx(zero[2] - coupling * zero[1], abs=1e-4)


@pytest.mark.parametrize("rpy", ["3.14159265358979 0 0", "0 1.5707963267949 0", "0.4 -0.3 2.0"])
def test_joint_angles_do_not_depend_on_the_mounting(rpy: str) -> None:
    """A UR5 that hangs, on a wall, askew: the same angles, and a remark on gravity."""
    (setup,) = ROBOTS.glob("ur5_polishing.toml")
    text = (ROBOTS / "ur5.urdf").read_text()
    mount = (
        '<link name="world"/><joint name="mount" type="fixed"><parent link="world"/>'
        f'<child link="base_link"/><origin xyz="0.1 0.2 1.5" rpy="{rpy}"/></joint></robot>'
    )
    hung = Setup.read(setup).varied(robot={"arm_urdf": text.replace("</robot>", mount)})
    own = on(prepare_arm(hung).robot, hung)
    upright = driven("ur5")
    turned = replace(upright, **own, part=own["base"])
    found, expected = read("cellcolor.script", turned), read("cellcolor.script", upright)
    for one, other in zip(found.stretches[0], expected.stretches[0], strict=True):
        assert np.array_equal(one.joints, other.joints)
    assert np.allclose(found.part, expected.part, atol=1e-6)  # in the base's frame
    roll, pitch, yaw = (float(one) for one in rpy.split())
    # The controller's base is base_link turned by half a circle about z.
    down = np.array([-1, -1, 1]) * (pin.rpy.rpyToMatrix(roll, pitch, yaw).T @ [0, 0, -1.0])
    said = re.findall(
        r"gravity points along \((.*?)\)", exported(turned)["cellcolor.script"].decode()
    )
    assert np.allclose(np.array(said[0].split(", "), dtype=float), down, atol=1e-3)


ARMS = ["ur5", "ur5e_calibrated", "ur3e", "ur10e", "ur16e", "irb120", "kr6", "tx2_60"]
OWN = {"irb120": ".mod", "kr6": ".src"}


@pytest.mark.parametrize("name", [*ARMS, "cobra600", "kr6_r700_z200"])
def test_an_arm_gets_the_program_of_its_controller_and_no_other(name: str) -> None:
    wanted = OWN.get(name, ".script" if name.startswith("ur") else None)
    planned = driven(name)
    names = {f"cellcolor{wanted}", f"cellcolor_linear{wanted}"} if wanted else set()
    assert {one for one in exported(planned) if one.startswith("cellcolor")} == names
    assert (why_no_program(planned) is None) is bool(wanted)


@pytest.mark.parametrize(
    ("robot", "change", "reason"),
    [
        ("ur5", "turned", "does not turn as"),
        ("ur5", "moved", "not stretched out along x"),
        ("irb120", "no table", "the setup names no controller"),
        ("irb120", "urscript", "not named as those of Universal Robots"),
        ("cobra600", "", "six joints that turn"),
        ("ur5", "unknown", "six joints that turn"),
    ],
)
def test_where_there_is_no_program_the_reason_is_said(robot: str, change: str, reason: str) -> None:
    """As for a URDF with another zero or another sense of rotation."""
    planned = driven(robot)
    twisted, folded = planned.robot.axis.copy(), planned.robot.placement.copy()
    twisted[1], folded[2:4, 0, 3] = -twisted[1], -folded[2:4, 0, 3]
    changed = {
        "turned": {"axis": twisted},
        "moved": {"placement": folded},
    }
    table = Controller(language="urscript") if change == "urscript" else planned.controller
    planned = replace(
        planned,
        robot=None if change == "unknown" else replace(planned.robot, **changed.get(change, {})),
        controller=None if change == "no table" else table,
    )
    assert reason in str(why_no_program(planned))
    assert not [name for name in exported(planned) if name.startswith("cellcolor")]


@pytest.mark.parametrize(
    ("keys", "fault"),
    [
        ({"language": "karel"}, "language"),
        ({"language": "krl", "signs": (1, 1, 1, 1, 1, 2)}, "signs"),
        ({"language": "krl", "offsets_deg": (0.0,) * 5}, "offsets_deg"),
        ({"language": "krl", "tool": "my_tool"}, "a number from 1 to 32"),
        ({"language": "rapid", "work_object": "a b"}, "a name of letters"),
    ],
)
def test_a_table_that_cannot_be_used_is_refused(keys: dict[str, Any], fault: str) -> None:
    with pytest.raises(InputError, match=fault):
        Controller(**keys)
