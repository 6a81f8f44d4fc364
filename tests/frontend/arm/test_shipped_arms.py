"""The arms of models/robots: files as their tables have them, and tables as makers have them."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pinocchio as pin
import pytest
from pinocchio_reading import readable
from shipped import ROBOTS

from cellcolor.arrays import Array
from cellcolor.frontend.arm.kinematics import forward
from cellcolor.frontend.arm.loading import pinocchio_model
from cellcolor.frontend.arm.robot import Robot
from cellcolor.frontend.arm.urdf import load_urdf
from cellcolor.frontend.contact.engine import Contacts, pairs_of
from cellcolor.frontend.reach.prepared_arm import prepare_arm
from cellcolor.frontend.setup import Setup

UR = ("ur3e", "ur5e", "ur10e", "ur16e")
# From axis 1 to the center of the wrist, arm stretched out sideways: the reach of the maker's
# sheet. Staubli's, 0.67 m, is to the flange.
REACH = {"kr6": 0.9015, "irb120": 0.58, "tx2_60": 0.6}
CALIBRATED = "ur5e_calibrated"


def module(name: str) -> ModuleType:
    """A script beside the arms."""
    sys.path.insert(0, str(ROBOTS))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(ROBOTS))


TABLES, MAKE = module("tables"), module("make")


def setup_of(name: str) -> Setup:
    return Setup.read(ROBOTS / f"{name}_polishing.toml")


def robot(name: str) -> Robot:
    return prepare_arm(setup_of(name)).robot


def test_files_are_what_the_tables_give() -> None:
    written = MAKE.written()
    assert set(TABLES.ARMS) == {*UR, *REACH, CALIBRATED, "cobra600"}
    for name, text in written.items():
        assert (ROBOTS / name).read_text(encoding="utf-8") == text, "run models/robots/make.py"
    handmade = {"ur5.urdf", "polishing_tool.urdf", "camera.urdf", "kr6_r700_z200.urdf"}
    assert handmade | set(written) >= {file.name for file in ROBOTS.glob("*.urdf")}


@pytest.mark.parametrize("file", sorted(ROBOTS.glob("*.urdf")), ids=lambda file: file.stem)
def test_pinocchio_reads_the_same(file: Path) -> None:
    """Where each link is, and what holds all of them against gravity."""
    ours, theirs = pinocchio_model(load_urdf(file)), pin.buildModelFromXML(readable(file))
    assert list(ours.names[1:]) == list(theirs.names[1:])
    data, other = ours.createData(), theirs.createData()
    for q in np.random.default_rng(1).uniform(-1, 1, (5, ours.nq)):
        pin.framesForwardKinematics(ours, data, q)
        pin.framesForwardKinematics(theirs, other, q)
        links = [frame.name for frame in theirs.frames if frame.type == pin.FrameType.BODY]
        for link in links:
            there = other.oMf[theirs.getFrameId(link, pin.FrameType.BODY)].homogeneous
            here = data.oMf[ours.getFrameId(link, pin.FrameType.BODY)].homogeneous
            assert np.allclose(here, there, atol=1e-12)
        torques = pin.computeGeneralizedGravity(theirs, other, q)
        assert np.allclose(pin.computeGeneralizedGravity(ours, data, q), torques, atol=1e-10)


def denavit_hartenberg(constants: tuple[float, ...], q: Array) -> list[Array]:
    """Frames 0 to 6 of a UR-type arm, by the definition of the constants."""
    d1, a2, a3, d4, d5, d6 = constants
    frames = [np.diag([-1.0, -1.0, 1.0, 1.0])]  # the maker's base, turned by pi about z
    table = zip(
        (d1, 0, 0, d4, d5, d6), (0, a2, a3, 0, 0, 0), (90, 0, 0, 90, -90, 0), q, strict=True
    )
    for d, a, alpha, theta in table:
        c, s = np.cos(theta), np.sin(theta)
        ca, sa = np.cos(np.radians(alpha)), np.sin(np.radians(alpha))
        turn = np.array([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0, sa, ca]])
        step = np.eye(4)
        step[:3, :3], step[:3, 3] = turn, (a * c, a * s, d)
        frames.append(frames[-1] @ step)
    return frames


@pytest.mark.parametrize("name", UR)
def test_ur_arms_are_those_of_the_published_constants(name: str) -> None:
    """Flange and centers of mass, by Denavit-Hartenberg frames instead of the URDF's."""
    arm, table = robot(name), TABLES.UR[name]
    model, data = arm.model, arm.model.createData()
    flange = model.getFrameId("tool0")
    tool = np.array([0, 0, 0.045]), 0.5  # of polishing_tool.urdf, in the flange's frame
    for q in np.random.default_rng(1).uniform(-np.pi, np.pi, (20, 6)):
        frames = denavit_hartenberg(table.constants, q)
        pin.framesForwardKinematics(model, data, q)
        assert np.allclose(data.oMf[flange].homogeneous, frames[6], atol=1e-12)
        pin.computeGeneralizedGravity(model, data, q)
        for joint, (mass, center) in enumerate(zip(table.masses, table.centers, strict=True), 1):
            expected = frames[joint] @ [*center, 1]
            if joint == 6:
                with_tool = expected[:3] * mass + (frames[6] @ [*tool[0], 1])[:3] * tool[1]
                mass, expected = mass + tool[1], with_tool / (mass + tool[1])
            found = data.oMi[joint].act(model.inertias[joint].lever)
            assert np.allclose(found, expected[:3], atol=1e-12)
            assert model.inertias[joint].mass == pytest.approx(mass)


@pytest.mark.parametrize("name", [*UR, *REACH, CALIBRATED])
def test_at_home_nothing_is_hit_and_the_tool_looks_down(name: str) -> None:
    setup, arm = setup_of(name), robot(name)
    assert setup.motion is not None and setup.motion.home_rad is not None
    home = np.array([setup.motion.home_rad])
    assert ((arm.lower <= home) & (home <= arm.upper)).all()
    poses = forward(arm, home)
    assert not Contacts(pairs_of(arm), arm)(home).any()
    assert np.allclose(poses.tool_axis, [0, 0, -1], atol=0.01)
    assert np.hypot(*poses.tip[0, :2]) > 0.2  # away from the base
    assert arm.warnings == ()


def test_the_scara_is_that_of_the_published_constants() -> None:
    """By Denavit-Hartenberg: d1 387, a1 325, a2 275 mm; down from joint 3 on, 210 of stroke."""
    arm = prepare_arm(Setup.read(ROBOTS / "cobra600_dispensing.toml")).robot
    model, data = arm.model, arm.model.createData()
    flange = model.getFrameId("flange")
    for q in np.random.default_rng(1).uniform([-3, -3, 0, -3], [3, 3, 0.21, 3], (20, 4)):
        pin.framesForwardKinematics(model, data, q)
        place, around = data.oMf[flange].translation, q[0] + q[1]
        x, y = (0.325 * f(q[0]) + 0.275 * f(around) for f in (np.cos, np.sin))
        assert np.allclose(place, [x, y, 0.387 - q[2]], atol=1e-12)
        turn = data.oMf[flange].rotation
        assert np.allclose(turn[:, 2], [0, 0, -1])
        ahead = around - q[3]  # down is the axis of joint 4
        assert np.allclose(turn[:, 0], [np.cos(ahead), np.sin(ahead), 0])
    degrees = np.degrees(arm.upper[:2])
    assert degrees == pytest.approx([50, 88]) and arm.upper[2] == 0.21 and arm.lower[2] == 0.0
    assert (arm.lower[:2] == -arm.upper[:2]).all() and arm.warnings == ()


def test_the_calibrated_arm_differs_as_a_calibrated_arm_does() -> None:
    plain, off = robot("ur5e"), robot(CALIBRATED)
    turned = np.abs(off.placement[:, :3, :3] - plain.placement[:, :3, :3]).max(axis=(1, 2))
    moved = np.abs(off.placement[:, :3, 3] - plain.placement[:, :3, 3]).max(axis=1)
    assert (turned[1:] > 1e-4).all() and turned.max() < 2e-3
    assert (moved[1:] > 1e-4).all() and moved.max() < 1e-3
