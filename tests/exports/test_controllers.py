"""Files for controllers, read back by readers that have no part in writing them."""

from __future__ import annotations

import csv
import io
import re
import zipfile
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial.transform import Rotation
from shipped import ROBOTS
from stand_in import stand_in

from cellcolor.data.trajectory import Trajectory
from cellcolor.exports.interface import ArmAxes, NotForThisArm, PlannedMotion
from cellcolor.exports.programs import (
    IRB_120,
    KR6_R900,
    WITHIN,
    Axes,
    krl,
    rapid,
    urscript,
)
from cellcolor.exports.registry import EXPORTS, exported
from cellcolor.exports.samples import stretches
from cellcolor.exports.strokes import steady_frames
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup
from examples import examples

NUMBERS = re.compile(r"-?\d+\.\d+")
PROGRAMS = {"cellcolor.script": "ur5", "cellcolor.mod": "irb120", "cellcolor.src": "kr6"}


@cache
def arm(name: str) -> Robot:
    (setup, *_) = sorted(ROBOTS.glob(f"{name}*.toml"), key=lambda path: len(path.name))
    return prepare_arm(Setup.read(setup)).robot


def axes_of(robot: Robot) -> ArmAxes:
    slides = bool(robot.slides.any())
    return ArmAxes.of(robot.joint_names, robot.placement, robot.axis, slides)


def driven(
    name: str, seed: int = 0, unplanned: tuple[int, ...] = (), **keys: object
) -> PlannedMotion:
    """A motion of an arm that nobody planned: waves, the tool on the surface now and then."""
    random, made, robot = np.random.default_rng(seed), stand_in(), arm(name)
    count = 60
    times = np.cumsum(random.uniform(0.005, 0.2, count))
    shape = random.uniform(0.1, 0.6, robot.joints), random.uniform(0.2, 1.0, robot.joints)
    joints = shape[0] * np.sin(times[:, None] * shape[1] + random.uniform(0, 6, robot.joints))
    contact = (np.arange(count) % 30 > 5) & (np.arange(count) % 30 < 26)
    trajectory = Trajectory(
        "waves", robot.joint_names, times, joints, random.normal(size=(count, 3)),
        np.tile([0.0, 0.0, 1.0], (count, 1)), contact, np.where(contact, 0, -1), unplanned,
    )  # fmt: skip
    surface, segment_of = made.painted.surface, made.painted.segment_of
    return PlannedMotion(
        surface, segment_of, ("#77AADD",), made.paths, trajectory, axes_of(robot), **keys
    )


def read_program(name: str, text: str) -> list[np.ndarray]:
    """The joints (k, 6), rad, that each stretch goes to after its start."""
    move = {
        "cellcolor.script": r"servoj\(\[(.*?)\]",
        "cellcolor.mod": r"MoveAbsJ \[\[(.*?)\]",
        "cellcolor.src": r"PTP \{(.*?)\}",
    }[name]
    pieces = re.split(r"(?:def|PROC|DEF) stretch_\d+\(", text)[1:]
    turned = [
        np.array([[float(n) for n in NUMBERS.findall(own)] for own in re.findall(move, piece)])
        for piece in pieces
    ]
    return turned if name == "cellcolor.script" else [np.radians(joints) for joints in turned]


@pytest.mark.parametrize(("name", "robot"), PROGRAMS.items())
def test_a_program_goes_where_the_trajectory_goes(name: str, robot: str) -> None:
    planned = driven(robot, unplanned=(20,))
    text = exported(planned)[name].decode("ascii")
    found = read_program(name, text)
    judged = [slice(0, 21), slice(21, 60)]
    assert len(found) == len(judged)
    for joints, own in zip(found, judged, strict=True):
        expected = planned.trajectory.joints[own]
        assert np.allclose(joints[-1], expected[-1], atol=1e-6)
        # Every point of a program lies on the judged motion, or as near as the program says.
        near = float(re.findall(r"at most ([\d.e-]+) rad", text)[0])
        dense = np.concatenate([np.linspace(a, b, 200) for a, b in pairwise(expected)])
        for point in joints[:: max(1, len(joints) // 40)]:
            assert np.abs(dense - point).max(axis=1).min() <= near + 5e-3
    assert "stretch_2" in text and not re.search(r"^ *(stretch_2\(\)|stretch_2;)$", text, re.M)


@pytest.mark.parametrize("name", ["cellcolor.mod", "cellcolor.src"])
def test_between_via_points_the_motion_is_the_judged_one(name: str) -> None:
    planned = driven(PROGRAMS[name], seed=3)
    (joints,) = read_program(name, exported(planned)[name].decode())
    trajectory = planned.trajectory
    rows = [
        int(np.abs(trajectory.joints - point).max(axis=1).argmin())
        for point in (trajectory.joints[0], *joints)
    ]
    assert rows == sorted(rows) and len(rows) < len(trajectory.times)
    for a, b in pairwise(rows):
        times = trajectory.times[a : b + 1]
        straight = np.array(
            [np.interp(times, times[[0, -1]], trajectory.joints[[a, b], j]) for j in range(6)]
        ).T
        assert np.abs(straight - trajectory.joints[a : b + 1]).max() <= WITHIN + 1e-6
    assert {0, *(np.flatnonzero(np.diff(trajectory.contact)) + 1).tolist()} <= set(rows)


def test_rapid_says_how_long_each_move_takes() -> None:
    planned = driven("irb120")
    seconds = [float(t) for t in re.findall(r"\\T:=([\d.]+)", rapid(planned).decode())]
    trajectory = planned.trajectory
    assert sum(seconds) == pytest.approx(trajectory.times[-1] - trajectory.times[0], abs=1e-3)


def test_krl_is_never_faster_than_planned_by_more_than_its_smallest_speed() -> None:
    planned = driven("kr6", step_s=0.05)
    text, top = krl(planned).decode(), np.array([360, 300, 360, 381, 388, 615])
    percent, before = 0, np.degrees(planned.trajectory.joints[0])
    for line in text.splitlines():
        if found := re.fullmatch(r" +speed_of_axes\((\d+)\)", line):
            percent = int(found[1])
        elif "PTP {" in line:
            angles = np.array([float(n) for n in NUMBERS.findall(line)])
            wanted = 100 * (np.abs(angles - before) / 0.05 / top).max()
            assert percent == max(1, min(100, int(wanted + 1e-3))) or percent == int(wanted)
            before = angles


@pytest.mark.parametrize(
    ("name", "robot", "table"),
    [("cellcolor.src", "kr6", KR6_R900), ("cellcolor.mod", "irb120", IRB_120)],
)
def test_a_controller_s_degrees_put_the_wrist_where_the_urdf_has_it(
    name: str, robot: str, table: Axes
) -> None:
    """The maker's axes turned by the degrees in the program, against Pinocchio on the URDF."""
    planned = driven(robot, seed=7, step_s=0.1)
    (joints,) = read_program(name, exported(planned)[name].decode())
    model = arm(robot).model
    data = model.createData()
    for angles in joints[::5]:
        pin.forwardKinematics(model, data, angles)
        turn, shift = np.eye(3), np.zeros(3)
        for (point, direction), angle in zip(table, angles, strict=True):
            # The axis, moved by those before it.
            center, axis = turn @ np.array(point) + shift, turn @ np.array(direction)
            own = Rotation.from_rotvec(angle * axis).as_matrix()
            turn, shift = own @ turn, center + own @ (shift - center)
        last = np.array(table[5][0])
        assert np.allclose(turn @ last + shift, data.oMi[6].translation, atol=1e-6)
        assert np.allclose(turn, data.oMi[6].rotation, atol=1e-6)


def test_ur_joints_are_counted_as_the_controller_counts_them() -> None:
    """The maker's Denavit-Hartenberg constants, which its controllers compute with."""
    planned = driven("ur5", step_s=0.1)
    (joints,) = read_program("cellcolor.script", urscript(planned).decode())
    model = arm("ur5").model
    data = model.createData()
    constants = [
        (0, 0.089159, np.pi / 2), (-0.425, 0, 0), (-0.39225, 0, 0),
        (0, 0.10915, np.pi / 2), (0, 0.09465, -np.pi / 2), (0, 0.0823, 0),
    ]  # fmt: skip
    for angles in joints[::5]:
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


ARMS = ["ur5", "ur5e_calibrated", "ur3e", "ur10e", "ur16e", "irb120", "kr6", "tx2_60"]
OWN = {"irb120": "cellcolor.mod", "kr6": "cellcolor.src"}


@pytest.mark.parametrize("name", [*ARMS, "cobra600", "kr6_r700_z200"])
def test_an_arm_gets_the_program_of_its_controller_and_no_other(name: str) -> None:
    wanted = OWN.get(name, "cellcolor.script" if name.startswith("ur") else None)
    planned = driven(name)
    assert {program for program in PROGRAMS if program in exported(planned)} == {wanted} - {None}


@pytest.mark.parametrize(
    ("make", "robot", "change", "reason"),
    [
        (krl, "kr6", "turned", "axis 2 does not turn about"),
        (krl, "kr6", "moved", "axis 3 is 20 mm from that of the KUKA KR 6 R900"),
        (rapid, "irb120", "turned", "axis 2 does not turn about"),
        (rapid, "kr6", "", "axis 1"),
        (urscript, "ur5", "turned", "axis 2 does not turn about"),
        (urscript, "irb120", "", "not named as those of Universal Robots"),
        (krl, "kr6", "unknown", "its axes are not known"),
        (krl, "cobra600", "", "six joints that turn"),
    ],
)
def test_another_arm_is_refused_with_the_reason(
    make: Any, robot: str, change: str, reason: str
) -> None:
    """As a URDF with another zero or another sense of rotation would be."""
    axes = axes_of(arm(robot))
    if change == "turned":
        axes = replace(axes, directions=axes.directions * np.array([1, -1, 1, 1, 1, 1])[:, None])
    if change == "moved":
        axes = replace(axes, points=axes.points + np.outer(np.arange(6) == 2, [0.0, 0.0, 0.02]))
    planned = replace(driven("ur5"), axes=None if change == "unknown" else axes)
    with pytest.raises(NotForThisArm, match=reason):
        make(planned)


@given(st.integers(0, 10**6), st.sampled_from([0.004, 0.0133, 0.1]))
@examples(20)
def test_a_fixed_step_follows_the_cubic_between_samples(seed: int, step: float) -> None:
    planned = driven("ur5", seed)
    trajectory = planned.trajectory
    (own,), (judged,) = stretches(trajectory, step), stretches(trajectory)
    assert np.allclose(np.diff(own.times), step)
    assert 0 <= own.times[-1] - judged.times[-1] < step
    cubic = CubicHermiteSpline(judged.times, judged.joints, judged.velocities)
    inside = np.minimum(own.times, judged.times[-1])
    assert np.allclose(own.joints, cubic(inside), atol=1e-9)
    assert np.allclose(own.velocities, cubic.derivative()(inside), atol=1e-7)
    straight = np.array([np.interp(inside, judged.times, j) for j in judged.joints.T]).T
    assert own.beside == pytest.approx(np.abs(own.joints - straight).max(), abs=1e-9)
    expected = np.interp(inside, judged.times, trajectory.contact) == 1
    assert np.array_equal(own.contact, expected)


def test_messages_have_the_fixed_step_and_accelerations() -> None:
    planned = driven("ur5", step_s=0.01)
    (message,) = yaml.safe_load_all(exported(planned)["joint_trajectory.yaml"])
    times = [
        point["time_from_start"]["sec"] * 10**9 + point["time_from_start"]["nanosec"]
        for point in message["points"]
    ]
    assert set(np.diff(times)) == {10_000_000}
    speeds = np.array([point["velocities"] for point in message["points"]])
    faster = np.array([point["accelerations"] for point in message["points"]])
    assert np.allclose(faster[1:-1], (speeds[2:] - speeds[:-2]) / 0.02, atol=1e-6)
    assert not faster[[0, -1]].any()


def test_strokes_follow_each_other_and_are_the_trajectory() -> None:
    planned = driven("ur5", unplanned=(40,), force_n=20.0)
    trajectory = planned.trajectory
    archive = zipfile.ZipFile(io.BytesIO(exported(planned)["strokes.zip"]))
    names = archive.namelist()
    assert [name[4:].split("_")[0].split(".")[0] for name in names] == [
        "move", "stroke", "move", "stroke", "stroke", "move",
    ]  # fmt: skip
    rows: dict[float, list[str]] = {}
    begun = [0.0] * 4 + [trajectory.times[41] - trajectory.times[0]] * 2
    for name, start in zip(names, begun, strict=True):
        head, *own = csv.reader(io.StringIO(archive.read(name).decode()))
        assert head[:4] == ["time_s", "contact", "feed_m_per_s", "force_n"]
        assert all(row[1] == "1" for row in own) is ("stroke" in name)
        rows |= {round(float(row[0]) + start, 6): row for row in own}
    found = np.array([rows[key] for key in sorted(rows)], dtype=float)
    assert len(found) == len(trajectory.times)
    assert np.allclose(found[:, 4:7], trajectory.points, atol=1e-8)
    assert np.allclose(found[:, 11:17], trajectory.joints, atol=1e-8)
    assert np.array_equal(found[:, 1] == 1, trajectory.contact)
    assert np.array_equal(found[:, 3], 20.0 * trajectory.contact)
    inner = found[1:40]  # of the first stretch
    assert np.allclose(
        inner[:, 17:23], np.gradient(trajectory.joints[:41], trajectory.times[:41], axis=0)[1:40],
        atol=1e-6,
    )  # fmt: skip


@given(st.integers(0, 10**6))
@examples(30)
def test_tool_frames_neither_flip_nor_swing(seed: int) -> None:
    """A frame turns no more than the normal does, and quaternions of neighbors point alike."""
    random = np.random.default_rng(seed)
    normals = np.cumsum(random.normal(size=(60, 3)) * 0.2, axis=0) + np.eye(3)[2]
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    found = steady_frames(normals)
    assert (np.sum(found[1:] * found[:-1], axis=1) >= 0).all()
    turns = Rotation.from_quat(found)
    assert np.allclose(turns.as_matrix()[:, :, 2], normals, atol=1e-9)
    angles = (turns[1:] * turns[:-1].inv()).magnitude()
    between = np.arccos(np.clip(np.sum(normals[1:] * normals[:-1], axis=1), -1, 1))
    assert np.allclose(angles, between, atol=1e-6)


@pytest.mark.parametrize("name", EXPORTS)
def test_only_own_files_are_overwritten(name: str, tmp_path: Path) -> None:
    from cellcolor.errors import InputError
    from cellcolor.files.writing import Output, check_output, write

    robot = PROGRAMS.get(name, "ur5")
    path = tmp_path / name
    made = exported(driven(robot))[name]
    assert made == exported(driven(robot))[name]
    write([Output(path, EXPORTS[name].kind, [made])])
    check_output(path, EXPORTS[name].kind)
    for export in EXPORTS.values():
        if export.kind.name != EXPORTS[name].kind.name:
            with pytest.raises(InputError, match="not overwritten"):
                check_output(path, export.kind)


@pytest.mark.parametrize("robot", ["ur5", "kr6"])
def test_a_recording_is_read_back_by_another_reader(robot: str, tmp_path: Path) -> None:
    rosbags = pytest.importorskip("rosbags.highlevel")
    planned = driven(robot, unplanned=(40,))
    (tmp_path / "motion.mcap").write_bytes(exported(planned)["motion.mcap"])
    model, trajectory = arm(robot).model, planned.trajectory
    data, topics, states = model.createData(), set(), []
    with rosbags.AnyReader([tmp_path / "motion.mcap"]) as reader:
        for connection, moment, raw in reader.messages():
            topics.add(connection.topic)
            message = reader.deserialize(raw, connection.msgtype)
            if connection.topic == "/markers":
                triangles = np.array([[p.x, p.y, p.z] for p in message.markers[0].points])
                assert np.allclose(
                    triangles, planned.surface.vertices[planned.surface.faces.ravel()]
                )
                assert len(message.markers) == 1 + len(planned.paths.paths)
                assert len(message.markers[0].colors) == len(triangles)
            elif connection.topic == "/joint_states":
                states.append((moment * 1e-9, np.array(message.position)))
                assert tuple(message.name) == trajectory.joint_names
            else:
                pin.forwardKinematics(model, data, states[-1][1])
                *links, tip = message.transforms
                assert moment * 1e-9 == states[-1][0] and tip.child_frame_id == "tool_tip"
                for number, link in enumerate(links, start=1):
                    place = link.transform.translation
                    found = np.array([place.x, place.y, place.z])
                    assert np.allclose(found, data.oMi[number].translation, atol=1e-9)
    assert topics == {"/markers", "/joint_states", "/tf"}
    times, joints = np.array([t for t, _ in states]), np.array([q for _, q in states])
    own = stretches(trajectory, 0.1)
    assert np.allclose(joints, np.concatenate([part.joints for part in own]))
    assert np.allclose(times[0], 0) and (np.diff(times) > 0).all()
